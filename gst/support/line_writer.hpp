// SPDX-License-Identifier: LGPL-2.1-or-later
// Lines on their way from a streaming thread to a file that may be slow, full, or stand still.
#pragma once

#include "gst/support/line_file.hpp"

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string_view>
#include <thread>

namespace rg {

/// What waits to be written at most, in bytes; a single text may be longer.
inline constexpr size_t kMostQueuedBytes = size_t{4} << 20;
/// For how long the end waits for a reader that does not read.
inline constexpr std::chrono::milliseconds kEndPatience{2000};

/// What to do with a text for which there is no room, or that can't be written.
enum class Crowded : uint8_t { Wait, Drop };

/// A queue of texts and the thread that writes them. A thread that hangs in a write for ever is
/// left behind with all that it uses.
///
/// A text is written as a whole or it counts as dropped, exactly once. All but stop() is safe
/// on any thread.
class LineWriter {
 public:
  /// Starts the thread, which writes the sink's head first. An error of that, or that there is no
  /// thread.
  [[nodiscard]] static Result<std::unique_ptr<LineWriter>> start(
      std::unique_ptr<LineSink> sink, std::chrono::milliseconds patience = kEndPatience);
  ~LineWriter();
  LineWriter(const LineWriter&) = delete;
  LineWriter& operator=(const LineWriter&) = delete;

  /// Takes a text. With Wait it returns when the text is written, can't be, or isCancelled(); a
  /// text that was taken is written even so. With Drop it never waits.
  void push(std::string_view text, int64_t timeNs, Crowded crowded, const IsCancelled& isCancelled);
  /// Opens the file again behind the texts that wait.
  void reopen();
  /// Waits until all is written, or can't be, or the patience is at its end, or isCancelled().
  void drain(const IsCancelled& isCancelled);
  /// The same; then what is still there is dropped and the sink closed. Nothing may be pushed
  /// later.
  void stop();

  /// Of texts.
  [[nodiscard]] uint64_t dropped() const;
  /// Why the latest text that could not be written was not, since this was asked; each is told
  /// once.
  [[nodiscard]] std::optional<Error> takeFailure();
  /// What went wrong without a loss, likewise.
  [[nodiscard]] std::optional<Error> takeComplaint();
  /// Whether a text found no room, or was left at the end.
  [[nodiscard]] bool wasCrowded() const;

 private:
  struct State;
  LineWriter(std::shared_ptr<State> state, std::chrono::milliseconds patience);

  const std::shared_ptr<State> state_;
  const std::chrono::milliseconds patience_;
  std::thread thread_;
};

}  // namespace rg
