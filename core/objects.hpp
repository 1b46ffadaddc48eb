// SPDX-License-Identifier: LGPL-2.1-or-later
// Stage 5, element mrfmerge: regions merged by motion become objects that keep their identity
// (paper, section 2.3 phases 2.2 to 2.5).
//
// Determinism: integers in state and decisions. Objects sorted by id, ids count from 1 and are
// never used again within a stream.
#pragma once

#include "core/arc_energy.hpp"
#include "core/geometry.hpp"
#include "core/region_motion.hpp"
#include "core/result.hpp"
#include "core/result_plane.hpp"
#include "core/stage.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace rg {

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
  Colour colour;                  ///< Mean over its pixels, the last known while it is hidden.
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
  std::shared_ptr<const Motion> motion;
  std::vector<Object> objects;
  ResultPlane<uint16_t> slots;           ///< For each pixel: 1 + index into `objects`, 0 = none.
  std::vector<uint64_t> regionObject;    ///< For each region the id of its object, 0 = none.
  std::vector<uint64_t> regionExpected;  ///< For each region the object that it was predicted to
                                         ///< belong to, 0 = none.
  std::vector<uint32_t> regionGroup;     ///< For each region the group that it was merged into.
  std::vector<ArcEnergy> arcs;  ///< Parallel to the graph's arcs; kept where both ends are in one
                                ///< group, broken elsewhere.
  static constexpr uint32_t kNoGroup = UINT32_MAX;
  uint32_t groundGroup = kNoGroup;   ///< What is background under a moving camera.
  std::vector<GroundEnergy> ground;  ///< Of each region's arc to the ground, under a moving camera;
                                     ///< empty otherwise. Kept where the region is background.
  bool isCutShort = false;  ///< So many regions touch one that the search for the best groups was
                            ///< ended early (core/mrf_merge.hpp).
  int32_t cameraDx = 0;     ///< Motion of the background since the previous frame, in 1/16 px.
  int32_t cameraDy = 0;
  std::vector<Event> events;

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
    cameraDx = other.cameraDx;
    cameraDy = other.cameraDy;
    events = other.events;
  }
};

/// Weights of the energy U = U1 + U2 + U3 + prediction (core/mrf_merge.hpp), and the tracker's
/// times.
struct ObjectParams {
  double motionWeight = 1.0;       ///< Of U1: what keeping regions together costs that move apart.
  double borderWeight = 2.0;       ///< Of U2: what a pixel of border between two groups costs where
                                   ///< it shows no edge.
  double arcWeight = 1.0;          ///< Of U3: what a broken arc between like colours costs, in
                                   ///< sixteenths of the root of the frame's area.
  double predictionWeight = 2.0;   ///< What it costs to part regions that were expected to be one
                                   ///< object.
  double motionThresholdPx = 1.0;  ///< Speeds that differ by less per frame count as alike.
  double maxLostTimeS = 2.0;       ///< An object that is not seen for longer ends.
  double minObjectArea = 0.0;      ///< Share of the frame, in percent; 0 = learnt from the scene.
};

class ObjectStage {
 public:
  virtual ~ObjectStage() = default;
  [[nodiscard]] virtual Result<std::shared_ptr<const Objects>> process(
      std::shared_ptr<const Motion> motion, const ObjectParams& params, FrameTime time) = 0;
  /// Ends of tracks that this causes are told by the next frame's events.
  virtual void reset(Reset what) = 0;
};

[[nodiscard]] std::unique_ptr<ObjectStage> makeObjectStage(Context context);

}  // namespace rg
