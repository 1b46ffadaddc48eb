// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/support/object_messages.hpp"

#include "core/base/camera/camera_place.hpp"
#include "core/base/mapping.hpp"
#include "core/text/text.hpp"

#include <algorithm>
#include <cstdlib>
#include <new>

namespace rg {
namespace {

/// The background counts as moving from half a pixel a frame, and as still again below a quarter.
constexpr int kMovingFrom = motion::kMotionUnit / 2;
constexpr int kStillBelow = motion::kMotionUnit / 4;

void setBox(GstStructure* fields, const Box& box) {
  gst_structure_set(fields, "x", G_TYPE_INT, box.x, "y", G_TYPE_INT, box.y, "w", G_TYPE_INT,
                    box.width, "h", G_TYPE_INT, box.height, nullptr);
}

template <class Set>
void append(GValue& array, GType type, Set set) {
  GValue value = G_VALUE_INIT;
  g_value_init(&value, type);
  set(&value);
  gst_value_array_append_and_take_value(&array, &value);
}

}  // namespace

void ObjectMessages::tell(const objects::Objects& objects, Size frame, const FrameMoment& moment) {
  moment_ = moment;
  see(objects, frame);
  for (const objects::Event& event : objects.events) tellEvent(event);
  for (const Contact& contact : contacts_.take(timeNs())) tellContact(contact);
  if (objects.status == Status::Ok) tellCamera(objects, frame);
  std::erase_if(seen_, [&](const auto& entry) {
    return entry.second.frame != frames_ && !alive_.contains(entry.first);
  });
}

void ObjectMessages::endAll() {
  for (const uint64_t id : alive_) tellObject("regiongraph-object-end", id);
  alive_.clear();
  seen_.clear();
  contacts_.clear();
}

void ObjectMessages::see(const objects::Objects& objects, Size frame) {
  ++frames_;
  const FrameMap map = mapBetween(objects.size, frame);
  try {
    for (const objects::Object& object : objects.objects)
      seen_[object.id] = {map.box(object.box), object.state, frames_};
  } catch (const std::bad_alloc&) {  // Messages without boxes are better than none.
  }
}

void ObjectMessages::tellEvent(const objects::Event& event) {
  switch (event.kind) {
    case objects::EventKind::ObjectNew:
      for (const uint64_t id : event.ids)
        if (alive_.insert(id).second) tellObject("regiongraph-object-new", id);
      break;
    case objects::EventKind::ObjectEnd:
      for (const uint64_t id : event.ids) {
        if (alive_.erase(id) != 0) tellObject("regiongraph-object-end", id);
        contacts_.forget(id);
      }
      break;
    case objects::EventKind::Merge:
    case objects::EventKind::Split:
      contacts_.note({event.ids, event.kind == objects::EventKind::Merge}, timeNs());
      break;
    case objects::EventKind::SceneChanged:
      post(gst_structure_new_empty("regiongraph-scene-changed"));
      break;
  }
}

std::optional<int64_t> ObjectMessages::timeNs() const {
  if (!GST_CLOCK_TIME_IS_VALID(moment_.pts) || moment_.pts > G_MAXINT64) return std::nullopt;
  return static_cast<int64_t>(moment_.pts);
}

void ObjectMessages::post(GstStructure* fields) const {
  postTimedMessage(element_, category_, moment_, fields);
}

void ObjectMessages::tellObject(const char* name, uint64_t id) const {
  GstStructure* fields =
      gst_structure_new(name, "id", G_TYPE_UINT64, static_cast<guint64>(id), nullptr);
  if (const auto seen = seen_.find(id); seen != seen_.end()) {
    gst_structure_set(fields, "state", G_TYPE_STRING, text::name(seen->second.state).data(),
                      nullptr);
    setBox(fields, seen->second.box);
  }
  post(fields);
}

void ObjectMessages::tellContact(const Contact& contact) const {
  static constexpr Seen kGone{{}, objects::ObjectState::Lost, 0};
  GValue ids = G_VALUE_INIT, states = G_VALUE_INIT;
  g_value_init(&ids, GST_TYPE_ARRAY);
  g_value_init(&states, GST_TYPE_ARRAY);
  Box all;
  for (const uint64_t id : contact.ids) {
    const auto found = seen_.find(id);
    const Seen& seen = found != seen_.end() ? found->second : kGone;
    append(ids, G_TYPE_UINT64, [&](GValue* value) { g_value_set_uint64(value, id); });
    append(states, G_TYPE_STRING,
           [&](GValue* value) { g_value_set_static_string(value, text::name(seen.state).data()); });
    all = unite(all, seen.box);
  }
  GstStructure* fields =
      gst_structure_new_empty(contact.isMerged ? "regiongraph-merge" : "regiongraph-split");
  gst_structure_take_value(fields, "ids", &ids);
  gst_structure_take_value(fields, "states", &states);
  if (!all.isEmpty()) setBox(fields, all);
  post(fields);
}

void ObjectMessages::tellCamera(const objects::Objects& objects, Size frame) {
  const int speed = std::max(std::abs(objects.cameraDx), std::abs(objects.cameraDy));
  const bool isMoving = isCameraMoving_ ? speed >= kStillBelow : speed >= kMovingFrom;
  if (isMoving == isCameraMoving_) return;
  isCameraMoving_ = isMoving;
  constexpr double kUnit = motion::kMotionUnit;
  constexpr const char* kName = "regiongraph-background-motion";
  GstStructure* fields = gst_structure_new(kName, "moving", G_TYPE_BOOLEAN, isMoving, "dx",
                                           G_TYPE_DOUBLE, objects.cameraDx / kUnit, "dy",
                                           G_TYPE_DOUBLE, objects.cameraDy / kUnit, nullptr);
  GValue matrix = G_VALUE_INIT;
  g_value_init(&matrix, GST_TYPE_ARRAY);
  const CameraMotion shown = moved(objects.camera, wayAlong(mapBetween(objects.size, frame)));
  for (const double number : matrixOf(shown))
    append(matrix, G_TYPE_DOUBLE, [&](GValue* value) { g_value_set_double(value, number); });
  gst_structure_take_value(fields, "matrix", &matrix);
  post(fields);
}

}  // namespace rg
