// SPDX-License-Identifier: LGPL-2.1-or-later
// When each frame was taken, and what a jump in time means for the history (design rule 5).
#pragma once

#include "core/base/stage.hpp"

#include <gst/gst.h>

#include <optional>

namespace rg {

struct Tick {
  FrameTime time;
  std::optional<Reset> reset;  ///< What has to be forgotten before this frame is looked at.
};

/// Follows the PTS of a stream. Each element has its own and comes to the same conclusions, since
/// all see the same buffers.
class StreamClock {
 public:
  /// The distance of frames that have no PTS; 0/1 = unknown.
  void setFramerate(int numerator, int denominator);
  [[nodiscard]] Tick advance(GstBuffer* buffer);
  /// The next frame has no predecessor.
  void restart() { last_.reset(); }

 private:
  int64_t frameNs_ = 0;  ///< 0 = unknown.
  std::optional<int64_t> last_;
};

}  // namespace rg
