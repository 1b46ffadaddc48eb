// SPDX-License-Identifier: LGPL-2.1-or-later
// Reads the objects of a video as DL Streamer does, knowing nothing of regiongraph: where there is
// GstAnalytics, of each detection the region of interest with the detection's id and the number in
// the tracking that it relates to; elsewhere each region of interest with the number in its param.
//
// usage: read_by_rule VIDEO         Exits with 1 where the metas contradict each other.
#include <gst/app/gstappsink.h>
#include <gst/gst.h>
#include <gst/video/gstvideometa.h>
#include <gst/video/video.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#if __has_include(<gst/analytics/analytics.h>)
#include <gst/analytics/analytics.h>
#define HAS_ANALYTICS 1
#else
#define HAS_ANALYTICS 0
#endif

namespace {

constexpr char kPipeline[] =
    "filesrc name=file ! decodebin ! videoconvert ! regiontrack ! appsink name=sink sync=false";

struct Frame {
  int number;
  GstBuffer* buffer;
  GstVideoInfo info;
};

[[noreturn]] void fail(const Frame& frame, const char* what) {
  std::fprintf(stderr, "read_by_rule: frame %d: %s\n", frame.number, what);
  std::exit(1);
}

double field(const Frame& frame, const GstStructure* structure, const char* name) {
  double value = 0;
  if (!gst_structure_get_double(structure, name, &value)) fail(frame, "a field is missing");
  return value;
}

/// The number in the param "object_id"; the box in the param "detection" is that of the meta.
guint64 numberOf(const Frame& frame, GstVideoRegionOfInterestMeta* roi) {
  const GstStructure* detection = gst_video_region_of_interest_meta_get_param(roi, "detection");
  const GstStructure* object = gst_video_region_of_interest_meta_get_param(roi, "object_id");
  int number = 0;
  if (!detection || !object || !gst_structure_get_int(object, "id", &number))
    fail(frame, "a region of interest lacks its params");
  const double left = field(frame, detection, "x_min") * frame.info.width,
               right = field(frame, detection, "x_max") * frame.info.width,
               top = field(frame, detection, "y_min") * frame.info.height,
               bottom = field(frame, detection, "y_max") * frame.info.height;
  if (std::lround(left) != roi->x || std::lround(right) != roi->x + roi->w ||
      std::lround(top) != roi->y || std::lround(bottom) != roi->y + roi->h)
    fail(frame, "the param has another box than the meta");
  return static_cast<guint64>(number);
}

void print(const Frame& frame, guint64 number, const GstVideoRegionOfInterestMeta* roi) {
  std::printf("frame %d  object %" G_GUINT64_FORMAT "  %ux%u at %u,%u\n", frame.number, number,
              roi->w, roi->h, roi->x, roi->y);
}

#if HAS_ANALYTICS
guint64 trackedNumber(const Frame& frame, GstAnalyticsODMtd& detection) {
  GstAnalyticsTrackingMtd tracking;
  gpointer state = nullptr;
  if (!gst_analytics_relation_meta_get_direct_related(
          detection.meta, detection.id, GST_ANALYTICS_REL_TYPE_RELATE_TO,
          gst_analytics_tracking_mtd_get_mtd_type(), &state, &tracking))
    fail(frame, "a detection relates to no tracking");
  guint64 number = 0;
  GstClockTime first = 0, last = 0;
  gboolean isLost = TRUE;
  gst_analytics_tracking_mtd_get_info(&tracking, &number, &first, &last, &isLost);
  if (isLost || first > last) fail(frame, "the times of a tracking");
  return number;
}

void read(const Frame& frame) {
  GstAnalyticsRelationMeta* meta = gst_buffer_get_analytics_relation_meta(frame.buffer);
  if (!meta) return;
  gpointer state = nullptr;
  GstAnalyticsODMtd detection;
  while (gst_analytics_relation_meta_iterate(meta, &state, gst_analytics_od_mtd_get_mtd_type(),
                                             &detection)) {
    auto* roi = gst_buffer_get_video_region_of_interest_meta_id(frame.buffer,
                                                                static_cast<gint>(detection.id));
    if (!roi) fail(frame, "no region of interest has a detection's id");
    int x = 0, y = 0, width = 0, height = 0;
    float confidence = 0;
    gst_analytics_od_mtd_get_location(&detection, &x, &y, &width, &height, &confidence);
    if (gst_analytics_od_mtd_get_obj_type(&detection) != roi->roi_type ||
        static_cast<guint>(x) != roi->x || static_cast<guint>(y) != roi->y ||
        static_cast<guint>(width) != roi->w || static_cast<guint>(height) != roi->h)
      fail(frame, "a detection and its region of interest differ");
    const guint64 number = trackedNumber(frame, detection);
    if (number != numberOf(frame, roi)) fail(frame, "the tracking has another number");
    print(frame, number, roi);
  }
}
#else
void read(const Frame& frame) {
  gpointer state = nullptr;
  while (GstMeta* meta = gst_buffer_iterate_meta_filtered(
             frame.buffer, &state, GST_VIDEO_REGION_OF_INTEREST_META_API_TYPE)) {
    auto* roi = reinterpret_cast<GstVideoRegionOfInterestMeta*>(meta);
    const guint64 number = numberOf(frame, roi);
    if (number != static_cast<guint64>(roi->id)) fail(frame, "the id is not the number");
    print(frame, number, roi);
  }
}
#endif

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  gst_init(nullptr, nullptr);
  GstElement* pipeline = gst_parse_launch(kPipeline, nullptr);
  if (!pipeline) return 1;
  GstElement* file = gst_bin_get_by_name(GST_BIN(pipeline), "file");
  g_object_set(file, "location", argv[1], nullptr);
  gst_object_unref(file);
  GstElement* sink = gst_bin_get_by_name(GST_BIN(pipeline), "sink");
  gst_element_set_state(pipeline, GST_STATE_PLAYING);
  Frame frame{};
  while (GstSample* sample = gst_app_sink_pull_sample(GST_APP_SINK(sink))) {
    frame.buffer = gst_sample_get_buffer(sample);
    ++frame.number;
    if (!gst_video_info_from_caps(&frame.info, gst_sample_get_caps(sample))) return 1;
    read(frame);
    gst_sample_unref(sample);
  }
  gst_object_unref(sink);
  gst_element_set_state(pipeline, GST_STATE_NULL);
  gst_object_unref(pipeline);
  return 0;
}
