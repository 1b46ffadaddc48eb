// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/support/object_messages.hpp"

#include "gst/support/timed_message.hpp"

#include <algorithm>
#include <cstdlib>

namespace rg {
namespace {

/// The background counts as moving from half a pixel a frame, and as still again below a quarter.
constexpr int kMovingFrom = motion::kMotionUnit / 2;
constexpr int kStillBelow = motion::kMotionUnit / 4;

}  // namespace

void ObjectMessages::tell(const objects::Objects& objects, GstClockTime pts) {
  pts_ = pts;
  for (const objects::Event& event : objects.events) {
    switch (event.kind) {
      case objects::EventKind::ObjectNew:
        for (const uint64_t id : event.ids)
          if (alive_.insert(id).second) tellObject("regiongraph-object-new", id);
        break;
      case objects::EventKind::ObjectEnd:
        for (const uint64_t id : event.ids)
          if (alive_.erase(id) != 0) tellObject("regiongraph-object-end", id);
        break;
      case objects::EventKind::Merge:
        tellGroup("regiongraph-merge", event);
        break;
      case objects::EventKind::Split:
        tellGroup("regiongraph-split", event);
        break;
      case objects::EventKind::SceneChanged:
        post(gst_structure_new_empty("regiongraph-scene-changed"));
        break;
    }
  }
  if (objects.status == Status::Ok) tellCamera(objects);
}

void ObjectMessages::endAll() {
  for (const uint64_t id : alive_) tellObject("regiongraph-object-end", id);
  alive_.clear();
}

void ObjectMessages::post(GstStructure* fields) const {
  postTimedMessage(element_, category_, pts_, fields);
}

void ObjectMessages::tellObject(const char* name, uint64_t id) const {
  post(gst_structure_new(name, "id", G_TYPE_UINT64, static_cast<guint64>(id), nullptr));
}

void ObjectMessages::tellGroup(const char* name, const objects::Event& event) const {
  GValue ids = G_VALUE_INIT;
  g_value_init(&ids, GST_TYPE_ARRAY);
  for (const uint64_t id : event.ids) {
    GValue value = G_VALUE_INIT;
    g_value_init(&value, G_TYPE_UINT64);
    g_value_set_uint64(&value, id);
    gst_value_array_append_and_take_value(&ids, &value);
  }
  GstStructure* fields = gst_structure_new_empty(name);
  gst_structure_take_value(fields, "ids", &ids);
  post(fields);
}

void ObjectMessages::tellCamera(const objects::Objects& objects) {
  const int speed = std::max(std::abs(objects.cameraDx), std::abs(objects.cameraDy));
  const bool isMoving = isCameraMoving_ ? speed >= kStillBelow : speed >= kMovingFrom;
  if (isMoving == isCameraMoving_) return;
  isCameraMoving_ = isMoving;
  constexpr double kUnit = motion::kMotionUnit;
  constexpr const char* kName = "regiongraph-background-motion";
  post(gst_structure_new(kName, "moving", G_TYPE_BOOLEAN, isMoving, "dx", G_TYPE_DOUBLE,
                         objects.cameraDx / kUnit, "dy", G_TYPE_DOUBLE, objects.cameraDy / kUnit,
                         nullptr));
}

}  // namespace rg
