// SPDX-License-Identifier: LGPL-2.1-or-later
// What GStreamer 1.28 declares for metas of frames that were cropped or turned, for building with
// an earlier one. Included in front of all else.
#pragma once

#include <gst/gst.h>
#include <gst/video/video.h>

#undef GST_CHECK_VERSION
/// What the GStreamer that is there has, and what came with 1.28.
#define GST_CHECK_VERSION(major, minor, micro) \
  ((major) == 1 && ((minor) == 28 || (minor) <= GST_VERSION_MINOR))

#define GST_VIDEO_META_TRANSFORM_IS_MATRIX(type) \
  ((type) == gst_video_meta_transform_matrix_get_quark())

// NOLINTNEXTLINE(readability-identifier-naming): as GStreamer calls it.
inline GQuark gst_video_meta_transform_matrix_get_quark() {
  return g_quark_from_static_string("gst-video-matrix");
}

struct GstVideoMetaTransformMatrix {
  const GstVideoInfo* in_info;
  GstVideoRectangle in_rectangle;
  const GstVideoInfo* out_info;
  GstVideoRectangle out_rectangle;
  gfloat matrix[3][3];
};
