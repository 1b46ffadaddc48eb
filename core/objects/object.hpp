// SPDX-License-Identifier: LGPL-2.1-or-later
// What is told of the objects in one frame.
#pragma once

#include "core/base/geometry.hpp"
#include "core/base/memory/result_plane.hpp"
#include "core/base/stage.hpp"
#include "core/motion/motion.hpp"
#include "core/objects/indices.hpp"
#include "core/objects/merge/arc_energy.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace rg::objects {

enum class ObjectState : uint8_t {
  New,       ///< Seen too briefly to be trusted; not written by default.
  Tracked,   ///< Seen and moving.
  Stopped,   ///< Seen and standing.
  Occluded,  ///< Hidden by another object or by the scene; its box is predicted.
  Lost,      ///< Not seen for a while; may come back within max-lost-time.
};

/// Whether an object in this state is told to readers: what is seen, and what is known to stand
/// behind something. New ones are not yet trusted, lost ones are no longer anywhere.
[[nodiscard]] constexpr bool isListed(ObjectState state) {
  return state == ObjectState::Tracked || state == ObjectState::Stopped ||
         state == ObjectState::Occluded;
}

inline constexpr int kPositionUnit = 16;  ///< Positions and speeds are in 1/16 px.

struct Object {
  uint64_t id = 0;
  ObjectState state = ObjectState::New;
  Box box;                ///< Full extent, hidden parts included; may leave the frame.
  uint32_t areaPx = 0;    ///< Pixels that belong to it in this frame; 0 while it is hidden.
  int32_t centroidX = 0;  ///< Of all of it, hidden parts included, in 1/16 px.
  int32_t centroidY = 0;
  int32_t speedX = 0;  ///< Over the ground, in 1/16 px per second; 0 unless hasSpeed.
  int32_t speedY = 0;
  bool hasSpeed = false;          ///< False where the stream has no time.
  uint32_t ageFrames = 0;         ///< Frames since it was first seen, this one included.
  graph::Colour colour;           ///< Mean over its pixels, the last known while it is hidden.
  std::vector<uint64_t> parents;  ///< Objects that it came from by a split or a merge, sorted.
  std::vector<Point> contour;     ///< Outer border of its largest part, clockwise; may be empty.
};

enum class EventKind : uint8_t { ObjectNew, ObjectEnd, Merge, Split, SceneChanged };

/// Something that happened in this frame. New and End: `ids` holds the object. Merge: the objects
/// that now share one blob. Split: those that came out of one.
struct Event {
  EventKind kind = EventKind::ObjectNew;
  std::vector<uint64_t> ids;
};

/// What mrfmerge says of one frame. Immutable once published.
struct Objects {
  Size size;
  Status status = Status::Skipped;
  std::shared_ptr<const motion::Motion> motion;
  std::vector<Object> objects;
  ResultPlane<uint16_t> slots;           ///< For each pixel the number of its Slot.
  std::vector<uint64_t> regionObject;    ///< For each region the id of its object, 0 = none.
  std::vector<uint64_t> regionExpected;  ///< For each region the object that it was predicted to
                                         ///< belong to, 0 = none.
  std::vector<GroupIndex> regionGroup;   ///< For each region the group that it was merged into.
  std::vector<ArcEnergy> arcs;  ///< Parallel to the graph's arcs; kept where both ends are in one
                                ///< group, broken elsewhere.
  GroupIndex groundGroup;       ///< What is background under a moving camera.
  std::vector<GroundEnergy> ground;  ///< Of each region's arc to the ground, under a moving camera;
                                     ///< empty otherwise. Kept where the region is background.
  bool isCutShort = false;  ///< So many regions touch one that the search for the best groups was
                            ///< ended early (core/objects/merge/mrf_merge.hpp).
  CameraMotion camera;      ///< How the picture of the background moved since the previous frame,
  int32_t cameraDx = 0;     ///< and by how much at the frame's middle, in 1/16 px.
  int32_t cameraDy = 0;
  std::vector<Event> events;

  /// `size` is set.
  void setCamera(const CameraMotion& moved) {
    camera = moved;
    const Point middle = moved.at(size.width / 2, size.height / 2);
    cameraDx = middle.x;
    cameraDy = middle.y;
  }
  void dropSources() { motion.reset(); }
  /// The source is shared, all else is copied.
  void copyFrom(const Objects& other) {
    copyTables(other);
    motion = other.motion;
    slots.copyFrom(other.slots);
  }
  void copyTables(const Objects& other) {
    size = other.size;
    status = other.status;
    objects = other.objects;
    regionObject = other.regionObject;
    regionExpected = other.regionExpected;
    regionGroup = other.regionGroup;
    arcs = other.arcs;
    groundGroup = other.groundGroup;
    ground = other.ground;
    isCutShort = other.isCutShort;
    camera = other.camera;
    cameraDx = other.cameraDx;
    cameraDy = other.cameraDy;
    events = other.events;
  }
};

}  // namespace rg::objects
