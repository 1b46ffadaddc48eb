// SPDX-License-Identifier: LGPL-2.1-or-later
// The pixels of a buffer, mapped for reading and checked.
#pragma once

#include "core/base/frame.hpp"
#include "core/base/result.hpp"

#include <gst/video/video.h>

#include <array>
#include <optional>

namespace rg {

/// The layout that caps describe; none for formats that the stages don't read.
[[nodiscard]] std::optional<FrameLayout> layoutOf(const GstVideoInfo& info);

/// Maps a buffer for as long as it lives. A GstVideoMeta is believed only as far as the memory
/// goes: frame() is an error where it points outside, or contradicts the caps.
class MappedFrame {
 public:
  /// `flags`, of GstMapFlags and of the memory's own: reading. With the latter the frame's planes
  /// may not be the host's.
  MappedFrame(GstBuffer* buffer, const GstVideoInfo& info, guint flags = GST_MAP_READ);
  ~MappedFrame();
  MappedFrame(const MappedFrame&) = delete;
  MappedFrame& operator=(const MappedFrame&) = delete;

  [[nodiscard]] const Result<Frame>& frame() const { return frame_; }

 private:
  [[nodiscard]] Result<Frame> check(const GstVideoInfo& info);
  [[nodiscard]] Result<PlaneMemory> find(uint64_t offset, int64_t strideBytes, Size bytes);
  [[nodiscard]] bool map(guint first, int count);

  GstBuffer* buffer_;
  guint flags_;
  std::array<GstMapInfo, Frame::kMaxPlanes> maps_;
  size_t mapCount_ = 0;
  Result<Frame> frame_;  ///< Made last: it needs the maps.
};

}  // namespace rg
