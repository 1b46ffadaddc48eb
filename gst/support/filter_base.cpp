// SPDX-License-Identifier: LGPL-2.1-or-later
// What elements ask of their base; the shell is in filter.cpp.
#include "gst/support/filter.hpp"
#include "gst/support/frame_hold.hpp"

namespace rg {
namespace {

/// Larger frames are refused: labels and sums are sized for this many pixels (8K: 8192x4320).
constexpr int64_t kMaxPixels = int64_t{8192} * 4320;

}  // namespace

bool acceptsSize(gpointer element, const GstVideoInfo& info) {
  const int width = GST_VIDEO_INFO_WIDTH(&info), height = GST_VIDEO_INFO_HEIGHT(&info);
  const int64_t pixels = int64_t{width} * height;
  if (pixels > 0 && pixels <= kMaxPixels) return true;
  GST_ELEMENT_ERROR(element, STREAM, FORMAT, ("Frames of %dx%d are too large.", width, height),
                    ("At most %" G_GINT64_FORMAT " pixels; put videoscale in front.", kMaxPixels));
  return false;
}

void Filter::setRunning(bool isRunning) {
  const std::lock_guard lock(settingsMutex_);
  isRunning_ = isRunning;
}

guint64 Filter::mostHeld() const {
  return mostHeldFrames(info_);
}

void Filter::sendHeld() {
  while (GstBuffer* buffer = release(true))
    gst_pad_push(GST_BASE_TRANSFORM_SRC_PAD(element_), buffer);
}

void Filter::postWarning(const std::string& text) const {
  GST_ELEMENT_WARNING(element_, STREAM, FAILED, ("%s", text.c_str()), (nullptr));
}

GstFlowReturn Filter::postError(const std::string& text) const {
  GST_ELEMENT_ERROR(element_, STREAM, FAILED, ("%s", text.c_str()), (nullptr));
  return GST_FLOW_ERROR;
}

}  // namespace rg
