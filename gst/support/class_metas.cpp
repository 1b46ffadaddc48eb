// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/support/class_metas.hpp"

#include "gst/support/detections.hpp"

#include <gst/video/gstvideometa.h>

#include <algorithm>
#include <vector>

namespace rg {
namespace {

struct Object {
  GstVideoRegionOfInterestMeta* roi;
  Box box;
  const detection::Detection* is = nullptr;
};

std::vector<Object> objectsOn(GstBuffer* buffer) {
  const GQuark type = g_quark_from_static_string("object");
  std::vector<Object> objects;
  gpointer state = nullptr;
  while (GstMeta* meta = gst_buffer_iterate_meta_filtered(
             buffer, &state, GST_VIDEO_REGION_OF_INTEREST_META_API_TYPE)) {
    auto* roi = reinterpret_cast<GstVideoRegionOfInterestMeta*>(meta);
    if (roi->roi_type == type)
      objects.push_back({roi,
                         {static_cast<int>(roi->x), static_cast<int>(roi->y),
                          static_cast<int>(roi->w), static_cast<int>(roi->h)}});
  }
  return objects;
}

Object* ownerOf(std::vector<Object>& objects, const Box& box) {
  const Point centre{box.x + box.width / 2, box.y + box.height / 2};
  Object* best = nullptr;
  for (Object& object : objects) {
    if (!object.box.contains(centre)) continue;
    const auto share = [&](const Object& of) { return intersect(of.box, box).area(); };
    if (!best || share(object) > share(*best)) best = &object;
  }
  return best;
}

GstStructure* structureOf(const char* name, const detection::Detection& detection, Size frame,
                          const DetectorNames& names) {
  const double width = frame.width, height = frame.height;
  const Box& box = detection.box;
  return gst_structure_new(
      name, "label", G_TYPE_STRING, names.label.c_str(), "label_id", G_TYPE_INT, 0, "confidence",
      G_TYPE_DOUBLE, 1.0, "model_name", G_TYPE_STRING, names.model.c_str(), "x_min", G_TYPE_DOUBLE,
      box.x / width, "x_max", G_TYPE_DOUBLE, box.right() / width, "y_min", G_TYPE_DOUBLE,
      box.y / height, "y_max", G_TYPE_DOUBLE, box.bottom() / height, "windows", G_TYPE_INT,
      detection.windows, nullptr);
}

void addRegion(GstBuffer* buffer, const detection::Detection& detection, Size frame,
               const DetectorNames& names) {
  const Box& box = detection.box;
  auto* roi = gst_buffer_add_video_region_of_interest_meta(
      buffer, names.label.c_str(), static_cast<guint>(box.x), static_cast<guint>(box.y),
      static_cast<guint>(box.width), static_cast<guint>(box.height));
  roi->id = addDetection(buffer, roi->roi_type, box);
  gst_video_region_of_interest_meta_add_param(roi,
                                              structureOf("detection", detection, frame, names));
}

}  // namespace

size_t addClasses(GstBuffer* buffer, const GstVideoInfo& info,
                  const detection::Detections& detections, const DetectorNames& names,
                  Unmatched unmatched) {
  const Size frame{GST_VIDEO_INFO_WIDTH(&info), GST_VIDEO_INFO_HEIGHT(&info)};
  std::vector<Object> objects = objectsOn(buffer);
  for (const detection::Detection& found : detections.found) {
    Object* owner = ownerOf(objects, found.box);
    if (owner && (!owner->is || found.windows > owner->is->windows)) owner->is = &found;
    if (!owner && unmatched == Unmatched::Added) addRegion(buffer, found, frame, names);
  }
  size_t count = 0;
  for (const Object& object : objects) {
    if (!object.is) continue;
    ++count;
    gst_video_region_of_interest_meta_add_param(
        object.roi, structureOf("classification", *object.is, frame, names));
    addClassification(buffer, object.roi->id, names.label.c_str());
  }
  return count;
}

}  // namespace rg
