// SPDX-License-Identifier: LGPL-2.1-or-later
// Scenes with objects in view for tests of what may go wrong, the chances that say when it does,
// and what the elements said of a frame as text that can be compared between streams.
#pragma once

#include "tests/support/harness.hpp"

#include <cstddef>
#include <cstdint>
#include <map>
#include <random>
#include <string>

namespace rg::testing {

/// The stages in a row, with a background that is learnt within a few frames.
inline constexpr const char* kQuickStages =
    "bgremove training-frames=2 ! hsvsegment ! srg ! prmmotion ! mrfmerge";
/// Under frame scope, as for a moving camera.
inline constexpr const char* kFrameScopeStages = "hsvsegment ! srg ! prmmotion ! mrfmerge";
inline constexpr const char* kDifferenceStages =
    "bgremove method=frame-difference ! hsvsegment scope=areas ! srg ! prmmotion ! mrfmerge";
inline constexpr const char* kPaperStages =
    "bgremove method=paper training-frames=3 ! hsvsegment ! srg connectivity=8 ! prmmotion ! "
    "mrfmerge";

/// How often something is done: `count`, times the environment variable RG_CAMPAIGN for long forms;
/// a quarter of it under AddressSanitizer, which makes all of it slow.
[[nodiscard]] int campaign(int count);

/// Random numbers; RG_SEED (1 where it is not set) decides which, and is printed. Several in one
/// test are told apart by `salt`.
class Chance {
 public:
  explicit Chance(uint32_t salt = 0);
  /// 0 … n - 1.
  int below(int n) { return static_cast<int>(numbers_() % static_cast<uint32_t>(n)); }
  /// least … most, ends included.
  int between(int least, int most) { return least + below(most - least + 1); }
  bool isOneIn(int n) { return below(n) == 0; }
  template <class Range>
  const auto& pick(const Range& range) {
    return std::data(range)[below(static_cast<int>(std::size(range)))];
  }

 private:
  std::mt19937 numbers_;
};

/// Ends the process with a message when it is not gone after so many seconds: a hang is a failure.
class Watchdog {
 public:
  explicit Watchdog(int seconds);
  ~Watchdog();
  Watchdog(const Watchdog&) = delete;
  Watchdog& operator=(const Watchdog&) = delete;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Three textured squares that move over a textured background, in proportion to the frame; from
/// the first frame `kFirstBusy` on.
inline constexpr int kFirstBusy = 3;
[[nodiscard]] BufferPtr busyFrame(const Caps& caps, int index);

/// Objects that are told on a frame.
[[nodiscard]] int objectsOn(GstBuffer* buffer);

/// Pushes busy frames from `index` on until objects are in view. False where none came.
[[nodiscard]] bool showObjects(Chain& chain, int& index);

/// Tells what the stages said of frames. Objects are named in the order in which they come, as the
/// numbers of a stream go on where a new chain begins with 1.
class Story {
 public:
  [[nodiscard]] std::string tell(GstBuffer* buffer);

 private:
  std::map<uint64_t, size_t> names_;
};

/// Bytes on the heap; 0 where the allocator does not tell, as under AddressSanitizer.
[[nodiscard]] size_t heapBytes();
/// Expects of bytes that were measured in turn that the last are hardly more than the first third.
void expectPlateau(const std::vector<size_t>& levels, size_t slackBytes);

/// Sends a caps event, which may be refused: false. Caps that can't be sent at all are, too.
bool sendCaps(Chain& chain, const std::string& text);
/// Sends stream-start, caps and a segment, as after a restart from NULL.
void beginStream(Chain& chain, const char* streamId = "again");
/// Sends flush-start, flush-stop and a segment that begins at 0.
void flush(Chain& chain);

}  // namespace rg::testing
