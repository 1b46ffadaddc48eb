// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/support/roi_metas.hpp"

#include "core/base/mapping.hpp"

#include <gst/video/gstvideometa.h>

namespace rg {
namespace {

void addParams(GstVideoRegionOfInterestMeta* roi, const objects::Object& object, const Box& box,
               Size size) {
  const double width = size.width, height = size.height;
  gst_video_region_of_interest_meta_add_param(
      roi,
      gst_structure_new("detection", "x_min", G_TYPE_DOUBLE, box.x / width, "x_max", G_TYPE_DOUBLE,
                        box.right() / width, "y_min", G_TYPE_DOUBLE, box.y / height, "y_max",
                        G_TYPE_DOUBLE, box.bottom() / height, "confidence", G_TYPE_DOUBLE, 1.0,
                        "label_id", G_TYPE_INT, 0, "label", G_TYPE_STRING, "object", nullptr));
  gst_video_region_of_interest_meta_add_param(
      roi, gst_structure_new("object_id", "id", G_TYPE_INT, static_cast<int>(object.id), nullptr));
}

}  // namespace

void RoiMetas::add(GstBuffer* buffer, const GstVideoInfo& info, const objects::Objects& objects) {
  const GQuark type = g_quark_from_static_string("object");
  const Size frame{GST_VIDEO_INFO_WIDTH(&info), GST_VIDEO_INFO_HEIGHT(&info)};
  const FrameMap map = mapBetween(objects.size, frame);
  detections_.begin(buffer, objects);
  for (const objects::Object& object : objects.objects) {
    const Box box = intersect(map.box(object.box), boundsOf(frame));
    if (!objects::isListed(object.state) || box.isEmpty()) continue;
    detections_.add(object, type, box);
    auto* roi = gst_buffer_add_video_region_of_interest_meta_id(
        buffer, type, static_cast<guint>(box.x), static_cast<guint>(box.y),
        static_cast<guint>(box.width), static_cast<guint>(box.height));
    roi->id = detections_.idOf(object.id);
    if (!object.parents.empty()) roi->parent_id = detections_.idOf(object.parents.front());
    addParams(roi, object, box, frame);
  }
}

}  // namespace rg
