// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/support/stage_stats.hpp"

namespace rg {
namespace {

constexpr GstClockTime kEvery = GST_SECOND;

double msOf(guint64 ns) {
  return static_cast<double>(ns) / 1e6;
}

double meanMs(guint64 totalNs, guint64 frames) {
  return frames > 0 ? msOf(totalNs) / static_cast<double>(frames) : 0;
}

}  // namespace

GstStructure* structureOf(const StageStats& stats) {
  return gst_structure_new("regiongraph-stats", "frames", G_TYPE_UINT64, stats.frames, "dropped",
                           G_TYPE_UINT64, stats.dropped, "ms-mean", G_TYPE_DOUBLE,
                           meanMs(stats.totalNs, stats.frames), "ms-worst", G_TYPE_DOUBLE,
                           msOf(stats.worstNs), nullptr);
}

void ProgressLog::tell(GstElement* element, GstDebugCategory* category, const Progress& progress,
                       GstClockTime pts, const StageStats& stats) {
  const GstClockTime now = gst_util_get_timestamp();
  if (progress.state == state_ && now - toldAt_ < kEvery) return;
  state_ = progress.state;
  toldAt_ = now;
  GST_CAT_DEBUG_OBJECT(
      category, element,
      "frame %" G_GUINT64_FORMAT " at %" GST_TIME_FORMAT
      ": %s; %.2f ms a frame since the last line, at worst %.2f; %" G_GUINT64_FORMAT
      " frames without a result",
      stats.frames, GST_TIME_ARGS(pts), progress.text.c_str(),
      meanMs(stats.totalNs - toldStats_.totalNs, stats.frames - toldStats_.frames),
      msOf(stats.worstNs), stats.dropped);
  toldStats_ = stats;
}

}  // namespace rg
