// SPDX-License-Identifier: LGPL-2.1-or-later
// The file that an element writes lines to.
#pragma once

#include "core/base/result.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>

namespace rg {

using IsCancelled = std::function<bool()>;

/// What became of a text: an error where it was not written, and one with which it was.
struct Writing {
  bool isWritten = true;
  std::optional<Error> error;
};

/// What lines are written to, by one thread at a time.
class LineSink {
 public:
  LineSink() = default;
  virtual ~LineSink() = default;
  LineSink(const LineSink&) = delete;
  LineSink& operator=(const LineSink&) = delete;

  /// Writes what stands before the first line.
  virtual std::optional<Error> begin(const IsCancelled& isCancelled) = 0;
  /// Writes all of the text or reports an error. A reader that does not read is waited for until
  /// isCancelled() says otherwise; the rest of the text is lost then.
  virtual Writing write(std::string_view text, int64_t timeNs, const IsCancelled& isCancelled) = 0;
  /// Goes on at the same location, should another program have moved the file away.
  virtual std::optional<Error> reopen() = 0;
  virtual std::optional<Error> close() = 0;
};

struct LineFileOptions {
  std::string location = "-";  ///< "-" is standard output.
  std::string header;          ///< Of each file, should there be one.
  bool isAppending = false;    ///< Else a file that is there is emptied.
  uint64_t mostBytes = 0;      ///< Of a file; 0: any number.
  int64_t mostNs = 0;          ///< Of the frames in a file; 0: any time.
  int mostOldFiles = 10;       ///< Kept beside the one that is written, at least 1.
};

/// A file, a pipe or standard output. Nothing is buffered: a reader sees a line as soon as write()
/// has returned. Errors name the reason, not the file. Must be used with SIGPIPE and SIGXFSZ
/// blocked: a reader that goes away and the limit of a file's size are errors.
///
/// A line that could not be written leaves no part of it in a file; the next one is tried again, in
/// a pipe as soon as it has a reader.
class LineFile final : public LineSink {
 public:
  ~LineFile() override { close(); }

  /// Makes or empties the file, which is not handed on to child processes. A pipe must have a
  /// reader, and nobody else of us may write there.
  [[nodiscard]] static Result<std::unique_ptr<LineSink>> open(LineFileOptions options);

  std::optional<Error> begin(const IsCancelled& isCancelled) override;
  Writing write(std::string_view text, int64_t timeNs, const IsCancelled& isCancelled) override;
  std::optional<Error> reopen() override;
  std::optional<Error> close() override;

 private:
  static constexpr int kNone = -1;

  explicit LineFile(LineFileOptions options) : options_(std::move(options)) {}

  enum class Content : uint8_t { Drop, Keep };
  std::optional<Error> openAnew(Content content);
  std::optional<Error> adopt(int fd, Content content);
  void release();
  [[nodiscard]] bool isStillThere() const;
  [[nodiscard]] bool isRotationDue(size_t bytes, int64_t timeNs) const;
  std::optional<Error> rotate();
  std::optional<Error> put(std::string_view text, const IsCancelled& isCancelled);
  void takeBack(size_t bytes) const;

  const LineFileOptions options_;
  int fd_ = kNone;
  bool isRegular_ = false;
  bool hasStandardOutput_ = false;
  bool needsHeader_ = false;
  uint64_t bytes_ = 0;              ///< In the file since it was opened or, failing that, was due.
  std::optional<int64_t> firstNs_;  ///< Of the first line in the file.
};

}  // namespace rg
