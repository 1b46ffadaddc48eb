// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/support/frame_hold.hpp"

#include <algorithm>

namespace rg {
namespace {

// Packed results of all five stages, measured; those of noise and of a moving camera included.
constexpr guint64 kResultBytesPerPixel = 2;

guint add(guint a, guint b) {
  return a > G_MAXUINT - b ? G_MAXUINT : a + b;
}

}  // namespace

guint64 framesIn(GstClockTime time, const GstVideoInfo& info) {
  if (GST_VIDEO_INFO_FPS_N(&info) <= 0 || GST_VIDEO_INFO_FPS_D(&info) <= 0) return 0;
  return gst_util_uint64_scale_ceil(time, static_cast<guint64>(GST_VIDEO_INFO_FPS_N(&info)),
                                    static_cast<guint64>(GST_VIDEO_INFO_FPS_D(&info)) * GST_SECOND);
}

guint64 bytesOfFrame(const GstVideoInfo& info) {
  const guint64 pixels = static_cast<guint64>(GST_VIDEO_INFO_WIDTH(&info)) *
                         static_cast<guint64>(GST_VIDEO_INFO_HEIGHT(&info));
  return GST_VIDEO_INFO_SIZE(&info) + kResultBytesPerPixel * pixels;
}

guint64 mostHeldFrames(const GstVideoInfo& info) {
  return std::clamp<guint64>(kMostHeldBytes / std::max<guint64>(bytesOfFrame(info), 1), 1,
                             kMostHeldFrames);
}

GstClockTime latencyInFrames(GstClockTime latency, const GstVideoInfo& info) {
  const guint64 frames = framesIn(latency, info);
  if (frames == 0) return latency;
  return gst_util_uint64_scale_ceil(frames,
                                    static_cast<guint64>(GST_VIDEO_INFO_FPS_D(&info)) * GST_SECOND,
                                    static_cast<guint64>(GST_VIDEO_INFO_FPS_N(&info)));
}

void raisePools(GstQuery* allocation, guint frames) {
  for (guint i = 0; i < gst_query_get_n_allocation_pools(allocation); ++i) {
    GstBufferPool* pool = nullptr;
    guint size = 0, least = 0, most = 0;
    gst_query_parse_nth_allocation_pool(allocation, i, &pool, &size, &least, &most);
    gst_query_set_nth_allocation_pool(allocation, i, pool, size, add(least, frames),
                                      most == 0 ? 0 : add(most, frames));
    if (pool) gst_object_unref(pool);
  }
}

}  // namespace rg
