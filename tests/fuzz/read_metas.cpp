// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/fuzz/read_metas.hpp"

#include "gst/meta/gstregiongraph.h"

#include <gst/video/gstvideometa.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>

namespace rg::fuzz {
namespace {

void demand(bool holds, const char* what) {
  if (holds) return;
  std::fprintf(stderr, "what the metas say does not fit together: %s\n", what);
  std::abort();
}

/// The largest value of a plane, all of which is read.
template <class T>
guint largestOf(const GstRegionPlane& plane) {
  guint largest = 0;
  for (gint y = 0; y < plane.height; ++y) {
    const auto* row =
        reinterpret_cast<const T*>(static_cast<const guint8*>(plane.data) +
                                   static_cast<gsize>(y) * static_cast<gsize>(plane.stride));
    for (gint x = 0; x < plane.width; ++x) largest = MAX(largest, guint{row[x]});
  }
  return largest;
}

/// Maps a meta's plane with its own function; 0 where there is none.
template <class Meta, class Map>
guint mapAndRead(Meta* meta, const Map& map) {
  GstRegionPlane plane;
  GError* error = nullptr;
  if (!map(meta, &plane, &error)) {
    demand(error != nullptr, "a failed map tells why");
    g_error_free(error);
    return 0;
  }
  const guint largest =
      plane.pixel_bytes == 2 ? largestOf<guint16>(plane) : largestOf<guint8>(plane);
  GBytes* bytes = gst_region_plane_get_bytes(&plane);
  demand(bytes && g_bytes_get_size(bytes) == static_cast<gsize>(plane.width) *
                                                 static_cast<gsize>(plane.height) *
                                                 plane.pixel_bytes,
         "bytes are as many as the plane has");
  gst_region_plane_unmap(&plane);
  g_bytes_unref(bytes);
  return largest;
}

void readForeground(GstBuffer* buffer) {
  auto* meta = gst_buffer_get_region_foreground_meta(buffer);
  if (!meta) return;
  gint width = 0, height = 0, shiftX = 0, shiftY = 0;
  gst_region_foreground_meta_get_status(meta, &width, &height);
  gst_region_foreground_meta_get_scene_event(meta, &shiftX, &shiftY);
  GstRegionBox box;
  for (guint i = 0; i < gst_region_foreground_meta_get_n_areas(meta); ++i) {
    demand(gst_region_foreground_meta_get_area(meta, i, &box), "an area that is counted is there");
    demand(box.x >= 0 && box.y >= 0 && box.width > 0 && box.height > 0 &&
               box.x + box.width <= width && box.y + box.height <= height,
           "areas lie within the frame");
  }
  mapAndRead(meta, gst_region_foreground_meta_map);
}

void readLabels(GstBuffer* buffer) {
  auto* meta = gst_buffer_get_region_labels_meta(buffer);
  if (!meta) return;
  demand(mapAndRead(meta, gst_region_labels_meta_map) <= gst_region_labels_meta_get_n_regions(meta),
         "labels are at most the number of regions");
  gst_region_labels_meta_get_scope(meta);
}

void readGraph(GstBuffer* buffer) {
  auto* meta = gst_buffer_get_region_graph_meta(buffer);
  if (!meta) return;
  const guint regions = gst_region_graph_meta_get_n_regions(meta);
  GstRegion region;
  for (guint i = 0; i < regions; ++i)
    demand(gst_region_graph_meta_get_region(meta, i, &region) && region.area > 0,
           "a region has pixels");
  GstRegionArc arc;
  for (guint i = 0; i < gst_region_graph_meta_get_n_arcs(meta); ++i)
    demand(gst_region_graph_meta_get_arc(meta, i, &arc) && arc.a < arc.b && arc.b <= regions,
           "an arc joins two regions");
  demand(!gst_region_graph_meta_get_region(meta, regions, &region), "there are no more regions");
}

void readMotion(GstBuffer* buffer) {
  auto* meta = gst_buffer_get_region_motion_meta(buffer);
  if (!meta) return;
  GstRegionVector vector;
  for (guint i = 0; i < gst_region_motion_meta_get_n_regions(meta); ++i)
    demand(gst_region_motion_meta_get_vector(meta, i, &vector) && vector.reliability >= 0 &&
               vector.reliability <= 1,
           "a reliability is a share");
}

void readObjects(GstBuffer* buffer) {
  auto* meta = gst_buffer_get_region_objects_meta(buffer);
  if (!meta) return;
  const guint objects = gst_region_objects_meta_get_n_objects(meta);
  guint64 last = 0;
  for (guint i = 0; i < objects; ++i) {
    GstRegionObject object;
    demand(gst_region_objects_meta_get_object(meta, i, &object),
           "an object that is counted is there");
    demand(object.id > last, "objects are sorted by their numbers");
    last = object.id;
    for (guint p = 0; p < object.n_parents; ++p) gst_region_objects_meta_get_parent(meta, i, p);
    gint x = 0, y = 0;
    for (guint p = 0; p < object.n_contour; ++p)
      gst_region_objects_meta_get_contour_point(meta, i, p, &x, &y);
  }
  gst_region_objects_meta_get_region_object(meta, 0);
  gdouble dx = 0, dy = 0;
  gst_region_objects_meta_get_camera_motion(meta, &dx, &dy);
  gdouble* matrix = gst_region_objects_meta_get_camera_matrix(meta);
  for (int i = 0; i < 9; ++i) demand(std::isfinite(matrix[i]), "a camera's numbers are finite");
  demand(matrix[8] == 1, "a camera's last number is 1");
  g_free(matrix);
  demand(mapAndRead(meta, gst_region_objects_meta_map) <= objects,
         "slots are at most the number of objects");
}

}  // namespace

void readMetas(GstBuffer* buffer) {
  readForeground(buffer);
  readLabels(buffer);
  readGraph(buffer);
  readMotion(buffer);
  readObjects(buffer);
}

void addRandomRois(GstBuffer* buffer, Bytes& bytes) {
  const int count = bytes.between(1, 40);
  for (int i = 0; i < count; ++i) {
    auto* roi = gst_buffer_add_video_region_of_interest_meta(
        buffer, bytes.flip() ? "object" : "face", bytes.take<guint32>(), bytes.take<guint32>(),
        bytes.take<guint32>(), bytes.take<guint32>());
    roi->id = bytes.take<gint32>();
    roi->parent_id = bytes.take<gint32>();
    if (bytes.flip())
      gst_video_region_of_interest_meta_add_param(
          roi, gst_structure_new("detection", "x_min", G_TYPE_STRING, "far left", "confidence",
                                 G_TYPE_DOUBLE, bytes.take<double>(), nullptr));
  }
}

}  // namespace rg::fuzz
