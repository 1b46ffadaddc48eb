// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/support/detections.hpp"

#include <gst/analytics/analytics.h>

#include <algorithm>
#include <new>
#include <utility>

namespace rg {
namespace {

template <class List>
auto find(List& list, uint64_t number) {
  const auto at = std::lower_bound(list.begin(), list.end(), number,
                                   [](const auto& seen, uint64_t id) { return seen.number < id; });
  return at != list.end() && at->number == number ? &*at : nullptr;
}

}  // namespace

/// Numbers begin anew with a stream, and then times may too. Where there is no memory, a frame goes
/// on without detections: its objects are tracked already.
void Detections::begin(GstBuffer* buffer, const objects::Objects& objects) {
  const GstClockTime now = GST_BUFFER_PTS(buffer);
  buffer_ = nullptr;
  next_.clear();
  try {
    next_.reserve(objects.objects.size());
  } catch (const std::bad_alloc&) {
    for (Seen& seen : seen_) seen.detection = 0;
    return;
  }
  for (const objects::Object& object : objects.objects) {
    const Seen* before = find(seen_, object.id);
    const bool isKnown = before && object.ageFrames > 1 && before->first <= now;
    next_.push_back({object.id, isKnown ? before->first : now, 0});
  }
  std::swap(seen_, next_);
  buffer_ = buffer;
}

void Detections::add(const objects::Object& object, GQuark type, const Box& box) {
  Seen* seen = find(seen_, object.id);
  if (!buffer_ || !seen) return;
  GstAnalyticsRelationMeta* meta = gst_buffer_get_analytics_relation_meta(buffer_);
  if (!meta) meta = gst_buffer_add_analytics_relation_meta(buffer_);
  GstAnalyticsODMtd detection;
  GstAnalyticsTrackingMtd tracking;
  // Numbers on a frame begin with 0, which as that of a region's parent means none: what comes
  // first is no detection.
  if (!gst_analytics_relation_meta_add_tracking_mtd(meta, object.id, seen->first, &tracking) ||
      !gst_analytics_relation_meta_add_od_mtd(meta, type, box.x, box.y, box.width, box.height, 1.0F,
                                              &detection))
    return;
  gst_analytics_tracking_mtd_update_last_seen(&tracking, GST_BUFFER_PTS(buffer_));
  gst_analytics_relation_meta_set_relation(meta, GST_ANALYTICS_REL_TYPE_RELATE_TO, detection.id,
                                           tracking.id);
  seen->detection = static_cast<gint>(detection.id);
}

gint Detections::idOf(uint64_t number) const {
  const Seen* seen = find(seen_, number);
  return seen ? seen->detection : 0;
}

gint addDetection(GstBuffer* buffer, GQuark type, const Box& box) {
  GstAnalyticsRelationMeta* meta = gst_buffer_get_analytics_relation_meta(buffer);
  if (!meta) meta = gst_buffer_add_analytics_relation_meta(buffer);
  GstAnalyticsODMtd detection;
  const bool isAdded = gst_analytics_relation_meta_add_od_mtd(meta, type, box.x, box.y, box.width,
                                                              box.height, 1.0F, &detection);
  return isAdded ? static_cast<gint>(detection.id) : 0;
}

void addClassification(GstBuffer* buffer, gint detection, const char* label) {
  GstAnalyticsRelationMeta* meta = gst_buffer_get_analytics_relation_meta(buffer);
  GstAnalyticsODMtd object;
  GstAnalyticsClsMtd classification;
  if (!meta ||
      !gst_analytics_relation_meta_get_od_mtd(meta, static_cast<guint>(detection), &object))
    return;
  if (!gst_analytics_relation_meta_add_one_cls_mtd(meta, 1.0F, g_quark_from_string(label),
                                                   &classification))
    return;
  gst_analytics_relation_meta_set_relation(meta, GST_ANALYTICS_REL_TYPE_CONTAIN, object.id,
                                           classification.id);
  gst_analytics_relation_meta_set_relation(meta, GST_ANALYTICS_REL_TYPE_IS_PART_OF,
                                           classification.id, object.id);
}

}  // namespace rg
