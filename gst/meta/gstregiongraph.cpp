// SPDX-License-Identifier: LGPL-2.1-or-later
// The public functions: results as plain C values.
#include "gst/meta/gstregiongraph.h"

#include "core/base/camera/camera_place.hpp"
#include "gst/meta/result_meta.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <new>
#include <utility>

namespace {

using rg::Box;
using rg::graph::Colour;

template <class Payload, class Meta>
const std::shared_ptr<const Payload>& sharedResultOf(Meta* meta) {
  return reinterpret_cast<const rg::ResultMeta<Payload>*>(meta)->result;
}

/// A meta that was added by its name only, not by an element, says what a skipped frame's says.
template <class Payload, class Meta>
const Payload& resultOf(Meta* meta) {
  static const Payload kSkipped;
  const auto& result = sharedResultOf<Payload>(meta);
  return result ? *result : kSkipped;
}

GstRegionStatus publicStatus(rg::Status status) {
  switch (status) {
    case rg::Status::Ok:
      return GST_REGION_STATUS_OK;
    case rg::Status::Training:
      return GST_REGION_STATUS_TRAINING;
    case rg::Status::Skipped:
      break;
  }
  return GST_REGION_STATUS_SKIPPED;
}

GstRegionObjectState publicState(rg::objects::ObjectState state) {
  switch (state) {
    case rg::objects::ObjectState::New:
      return GST_REGION_OBJECT_STATE_NEW;
    case rg::objects::ObjectState::Tracked:
      return GST_REGION_OBJECT_STATE_TRACKED;
    case rg::objects::ObjectState::Stopped:
      return GST_REGION_OBJECT_STATE_STOPPED;
    case rg::objects::ObjectState::Occluded:
      return GST_REGION_OBJECT_STATE_OCCLUDED;
    case rg::objects::ObjectState::Lost:
      break;
  }
  return GST_REGION_OBJECT_STATE_LOST;
}

GstRegionBox publicBox(const Box& box) {
  return {box.x, box.y, box.width, box.height};
}

GstRegionColour publicColour(Colour colour) {
  return {colour.red, colour.green, colour.blue};
}

template <class Payload>
GstRegionStatus statusAndSize(const Payload& result, gint* width, gint* height) {
  if (width) *width = result.size.width;
  if (height) *height = result.size.height;
  return publicStatus(result.status);
}

/// What a mapped plane and the bytes of it live on. The plane's own fields are not looked at again:
/// whoever reads it may have written into them.
struct Hold {
  virtual ~Hold() = default;
  rg::ImageView<const std::byte> rows;  ///< One element a byte.
};
template <class Payload, class T>
struct HoldOf final : Hold {
  std::shared_ptr<const Payload> owner;
  rg::Image<T> unpacked;
};
using Held = std::shared_ptr<const Hold>;

/// Keeps the pixels alive for as long as the plane is mapped.
template <class Payload, class T>
gboolean mapPlane(const std::shared_ptr<const Payload>& owner, rg::ResultPlane<T> Payload::*member,
                  GstRegionPlane* plane, GError** error) {
  if (!owner || owner->status == rg::Status::Skipped ||
      (owner.get()->*member).pixelSize().isEmpty()) {
    g_set_error_literal(error, GST_STREAM_ERROR, GST_STREAM_ERROR_FAILED,
                        "this frame was skipped, there are no pixels to map");
    return FALSE;
  }
  try {
    auto hold = std::make_shared<HoldOf<Payload, T>>();
    hold->owner = owner;
    const rg::ImageView<const T> pixels = (owner.get()->*member).unpacked(hold->unpacked);
    hold->rows = {reinterpret_cast<const std::byte*>(pixels.data),
                  {pixels.width() * static_cast<int>(sizeof(T)), pixels.height()},
                  pixels.strideBytes};
    auto held = std::make_unique<Held>(std::move(hold));
    *plane = {pixels.data,     pixels.width(),
              pixels.height(), static_cast<gint>(pixels.strideBytes),
              sizeof(T),       {}};
    plane->_private[0] = held.release();
    return TRUE;
  } catch (const std::bad_alloc&) {
    g_set_error_literal(error, GST_CORE_ERROR, GST_CORE_ERROR_FAILED, "out of memory");
    return FALSE;
  }
}

Held* heldBy(const GstRegionPlane* plane) {
  return static_cast<Held*>(plane->_private[0]);
}

/// The rows where they are, when none is padded. Null when out of memory.
GBytes* sharedBytes(const Held& held) {
  auto* mine = new (std::nothrow) Held(held);
  if (!mine) return nullptr;
  const auto& rows = held->rows;
  const auto size = static_cast<gsize>(rows.width()) * static_cast<gsize>(rows.height());
  return g_bytes_new_with_free_func(
      rows.data, size, [](gpointer taken) { delete static_cast<Held*>(taken); }, mine);
}

/// A copy of the rows without their padding. Null when out of memory.
GBytes* copiedBytes(rg::ImageView<const std::byte> rows) {
  const auto width = static_cast<gsize>(rows.width());
  const gsize size = width * static_cast<gsize>(rows.height());
  auto* copy = static_cast<std::byte*>(g_try_malloc(size));
  if (!copy) return nullptr;
  for (int y = 0; y < rows.height(); ++y)
    std::memcpy(copy + static_cast<gsize>(y) * width, rows.row(y), width);
  return g_bytes_new_take(copy, size);
}

const rg::objects::Object* objectAt(GstRegionObjectsMeta* meta, guint index) {
  const auto& objects = resultOf<rg::objects::Objects>(meta).objects;
  return index < objects.size() ? &objects[index] : nullptr;
}

}  // namespace

GstRegionStatus gst_region_foreground_meta_get_status(GstRegionForegroundMeta* meta, gint* width,
                                                      gint* height) {
  g_return_val_if_fail(meta, GST_REGION_STATUS_SKIPPED);
  return statusAndSize(resultOf<rg::background::Foreground>(meta), width, height);
}

GstRegionSceneEvent gst_region_foreground_meta_get_scene_event(GstRegionForegroundMeta* meta,
                                                               gint* shift_x, gint* shift_y) {
  g_return_val_if_fail(meta, GST_REGION_SCENE_EVENT_NONE);
  const rg::background::Scene& scene = resultOf<rg::background::Foreground>(meta).scene;
  if (shift_x) *shift_x = scene.shift.x;
  if (shift_y) *shift_y = scene.shift.y;
  return static_cast<GstRegionSceneEvent>(scene.event);  // In the same order.
}

gboolean gst_region_foreground_meta_is_camera_moving(GstRegionForegroundMeta* meta) {
  g_return_val_if_fail(meta, FALSE);
  return resultOf<rg::background::Foreground>(meta).scene.isCameraMoving;
}

guint gst_region_foreground_meta_get_n_areas(GstRegionForegroundMeta* meta) {
  g_return_val_if_fail(meta, 0);
  return static_cast<guint>(resultOf<rg::background::Foreground>(meta).areas.size());
}

gboolean gst_region_foreground_meta_get_area(GstRegionForegroundMeta* meta, guint index,
                                             GstRegionBox* box) {
  g_return_val_if_fail(meta && box, FALSE);
  const auto& areas = resultOf<rg::background::Foreground>(meta).areas;
  if (index >= areas.size()) return FALSE;
  *box = publicBox(areas[index]);
  return TRUE;
}

gboolean gst_region_foreground_meta_map(GstRegionForegroundMeta* meta, GstRegionPlane* plane,
                                        GError** error) {
  g_return_val_if_fail(meta && plane, FALSE);
  return mapPlane(sharedResultOf<rg::background::Foreground>(meta),
                  &rg::background::Foreground::mask, plane, error);
}

GstRegionStatus gst_region_labels_meta_get_status(GstRegionLabelsMeta* meta, gint* width,
                                                  gint* height) {
  g_return_val_if_fail(meta, GST_REGION_STATUS_SKIPPED);
  return statusAndSize(resultOf<rg::segmentation::Labels>(meta), width, height);
}

GstRegionScope gst_region_labels_meta_get_scope(GstRegionLabelsMeta* meta) {
  g_return_val_if_fail(meta, GST_REGION_SCOPE_FRAME);
  switch (resultOf<rg::segmentation::Labels>(meta).scope) {
    case rg::segmentation::Scope::Foreground:
      return GST_REGION_SCOPE_FOREGROUND;
    case rg::segmentation::Scope::Areas:
      return GST_REGION_SCOPE_AREAS;
    case rg::segmentation::Scope::Frame:
      break;
  }
  return GST_REGION_SCOPE_FRAME;
}

guint gst_region_labels_meta_get_n_regions(GstRegionLabelsMeta* meta) {
  g_return_val_if_fail(meta, 0);
  return resultOf<rg::segmentation::Labels>(meta).count;
}

gboolean gst_region_labels_meta_map(GstRegionLabelsMeta* meta, GstRegionPlane* plane,
                                    GError** error) {
  g_return_val_if_fail(meta && plane, FALSE);
  return mapPlane(sharedResultOf<rg::segmentation::Labels>(meta), &rg::segmentation::Labels::ids,
                  plane, error);
}

GstRegionStatus gst_region_graph_meta_get_status(GstRegionGraphMeta* meta, gint* width,
                                                 gint* height) {
  g_return_val_if_fail(meta, GST_REGION_STATUS_SKIPPED);
  return statusAndSize(resultOf<rg::graph::Graph>(meta), width, height);
}

guint gst_region_graph_meta_get_n_regions(GstRegionGraphMeta* meta) {
  g_return_val_if_fail(meta, 0);
  return static_cast<guint>(resultOf<rg::graph::Graph>(meta).regions.size());
}

gboolean gst_region_graph_meta_get_region(GstRegionGraphMeta* meta, guint index,
                                          GstRegion* region) {
  g_return_val_if_fail(meta && region, FALSE);
  const auto& regions = resultOf<rg::graph::Graph>(meta).regions;
  if (index >= regions.size()) return FALSE;
  const rg::graph::Region& from = regions[index];
  *region = {rg::segmentation::RegionLabel::ofIndex(index).number(),
             from.areaPx,
             publicBox(from.box),
             from.centroidX / 256.0,
             from.centroidY / 256.0,
             publicColour(from.colour),
             {}};
  return TRUE;
}

guint gst_region_graph_meta_get_n_arcs(GstRegionGraphMeta* meta) {
  g_return_val_if_fail(meta, 0);
  return static_cast<guint>(resultOf<rg::graph::Graph>(meta).arcs.size());
}

gboolean gst_region_graph_meta_get_arc(GstRegionGraphMeta* meta, guint index, GstRegionArc* arc) {
  g_return_val_if_fail(meta && arc, FALSE);
  const auto& arcs = resultOf<rg::graph::Graph>(meta).arcs;
  if (index >= arcs.size()) return FALSE;
  const rg::graph::Arc& from = arcs[index];
  const double contrast = from.borderPx ? static_cast<double>(from.contrast) / from.borderPx : 0.0;
  *arc = {from.a.number(), from.b.number(), from.borderPx, contrast, {}};
  return TRUE;
}

GstRegionStatus gst_region_motion_meta_get_status(GstRegionMotionMeta* meta, gint* width,
                                                  gint* height) {
  g_return_val_if_fail(meta, GST_REGION_STATUS_SKIPPED);
  return statusAndSize(resultOf<rg::motion::Motion>(meta), width, height);
}

guint gst_region_motion_meta_get_n_regions(GstRegionMotionMeta* meta) {
  g_return_val_if_fail(meta, 0);
  return static_cast<guint>(resultOf<rg::motion::Motion>(meta).regions.size());
}

gboolean gst_region_motion_meta_get_vector(GstRegionMotionMeta* meta, guint index,
                                           GstRegionVector* vector) {
  g_return_val_if_fail(meta && vector, FALSE);
  const auto& regions = resultOf<rg::motion::Motion>(meta).regions;
  if (index >= regions.size()) return FALSE;
  const rg::motion::RegionMotion& from = regions[index];
  constexpr double kUnit = rg::motion::kMotionUnit;
  *vector = {from.dx / kUnit,
             from.dy / kUnit,
             from.sad,
             from.reliability / double{rg::motion::kFullReliability},
             {}};
  return TRUE;
}

GstRegionStatus gst_region_objects_meta_get_status(GstRegionObjectsMeta* meta, gint* width,
                                                   gint* height) {
  g_return_val_if_fail(meta, GST_REGION_STATUS_SKIPPED);
  return statusAndSize(resultOf<rg::objects::Objects>(meta), width, height);
}

guint gst_region_objects_meta_get_n_objects(GstRegionObjectsMeta* meta) {
  g_return_val_if_fail(meta, 0);
  return static_cast<guint>(resultOf<rg::objects::Objects>(meta).objects.size());
}

gboolean gst_region_objects_meta_get_object(GstRegionObjectsMeta* meta, guint index,
                                            GstRegionObject* object) {
  g_return_val_if_fail(meta && object, FALSE);
  const rg::objects::Object* from = objectAt(meta, index);
  if (!from) return FALSE;
  constexpr double kUnit = rg::objects::kPositionUnit;
  *object = {};
  object->id = from->id;
  object->state = publicState(from->state);
  object->box = publicBox(from->box);
  object->area = from->areaPx;
  object->centroid_x = from->centroidX / kUnit;
  object->centroid_y = from->centroidY / kUnit;
  object->has_velocity = from->hasSpeed;
  object->velocity_x = from->speedX / kUnit;
  object->velocity_y = from->speedY / kUnit;
  object->age = from->ageFrames;
  object->colour = publicColour(from->colour);
  object->n_parents = static_cast<guint>(from->parents.size());
  object->n_contour = static_cast<guint>(from->contour.size());
  return TRUE;
}

guint64 gst_region_objects_meta_get_parent(GstRegionObjectsMeta* meta, guint index, guint parent) {
  g_return_val_if_fail(meta, 0);
  const rg::objects::Object* object = objectAt(meta, index);
  return object && parent < object->parents.size() ? object->parents[parent] : 0;
}

gboolean gst_region_objects_meta_get_contour_point(GstRegionObjectsMeta* meta, guint index,
                                                   guint point, gint* x, gint* y) {
  g_return_val_if_fail(meta && x && y, FALSE);
  const rg::objects::Object* object = objectAt(meta, index);
  if (!object || point >= object->contour.size()) return FALSE;
  *x = object->contour[point].x;
  *y = object->contour[point].y;
  return TRUE;
}

guint64 gst_region_objects_meta_get_region_object(GstRegionObjectsMeta* meta, guint region) {
  g_return_val_if_fail(meta, 0);
  const auto& owners = resultOf<rg::objects::Objects>(meta).regionObject;
  return region >= 1 && region <= owners.size() ? owners[region - 1] : 0;
}

void gst_region_objects_meta_get_camera_motion(GstRegionObjectsMeta* meta, gdouble* dx,
                                               gdouble* dy) {
  g_return_if_fail(meta && dx && dy);
  constexpr double kUnit = rg::motion::kMotionUnit;
  *dx = resultOf<rg::objects::Objects>(meta).cameraDx / kUnit;
  *dy = resultOf<rg::objects::Objects>(meta).cameraDy / kUnit;
}

gdouble* gst_region_objects_meta_get_camera_matrix(GstRegionObjectsMeta* meta) {
  g_return_val_if_fail(meta, nullptr);
  const rg::CameraMatrix matrix = rg::matrixOf(resultOf<rg::objects::Objects>(meta).camera);
  auto* numbers = g_new(gdouble, matrix.size());
  std::copy(matrix.begin(), matrix.end(), numbers);
  return numbers;
}

gboolean gst_region_objects_meta_map(GstRegionObjectsMeta* meta, GstRegionPlane* plane,
                                     GError** error) {
  g_return_val_if_fail(meta && plane, FALSE);
  return mapPlane(sharedResultOf<rg::objects::Objects>(meta), &rg::objects::Objects::slots, plane,
                  error);
}

GBytes* gst_region_plane_get_bytes(const GstRegionPlane* plane) {
  g_return_val_if_fail(plane, nullptr);
  const Held* held = heldBy(plane);
  if (!held) return nullptr;
  const auto& rows = (*held)->rows;
  return rows.strideBytes == rows.width() ? sharedBytes(*held) : copiedBytes(rows);
}

void gst_region_plane_unmap(GstRegionPlane* plane) {
  g_return_if_fail(plane);
  delete heldBy(plane);
  *plane = {};
}
