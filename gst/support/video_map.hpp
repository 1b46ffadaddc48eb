// SPDX-License-Identifier: LGPL-2.1-or-later
// A buffer's pixels mapped for as long as this lives, whichever way the scope is left.
#pragma once

#include <gst/video/video.h>

namespace rg {

class VideoMap {
 public:
  VideoMap(GstBuffer* buffer, const GstVideoInfo& info, GstMapFlags flags)
      : isMapped_(gst_video_frame_map(&frame_, &info, buffer, flags) != FALSE) {}
  ~VideoMap() {
    if (isMapped_) gst_video_frame_unmap(&frame_);
  }
  VideoMap(const VideoMap&) = delete;
  VideoMap& operator=(const VideoMap&) = delete;

  /// Null where it could not be mapped.
  [[nodiscard]] GstVideoFrame* frame() { return isMapped_ ? &frame_ : nullptr; }

 private:
  GstVideoFrame frame_{};
  const bool isMapped_;
};

}  // namespace rg
