// SPDX-License-Identifier: LGPL-2.1-or-later
// One object's history, and where it is expected.
//
// Determinism: integers.
#pragma once

#include "core/base/camera/camera_motion.hpp"
#include "core/base/geometry.hpp"
#include "core/objects/object.hpp"
#include "core/objects/tracking/looks/appearance.hpp"
#include "core/objects/tracking/looks/portrait.hpp"
#include "core/objects/tracking/scene_scale.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>
#include <vector>

namespace rg::objects {

/// What positions and lengths are kept within, so that a few can be added.
constexpr int32_t toInt(int64_t value) {
  return static_cast<int32_t>(std::clamp<int64_t>(value, INT32_MIN / 4, INT32_MAX / 4));
}

/// An edge of a track's box that stays where it is, and where the opposite one was at first, in px.
struct StandingEdge {
  int place = -1000, opposite = -1000;
};

/// One object's history. Positions in 1/16 px, of the middle of the box's lower edge (the foot).
struct Track {
  uint64_t id = 0;
  ObjectState state = ObjectState::New;
  int32_t x = 0, foot = 0;
  int32_t speedX = 0, speedY = 0;  ///< Over the ground, in 1/16 px per second.
  std::optional<Point> stepSpeed;  ///< The same of the step to this frame, where regions tell it.
  Extent size;
  Look look;
  Look recent;  ///< Since it came out of a crowd, while it is in doubt.
  Portrait portrait;
  graph::Colour colour;
  std::vector<uint64_t> parents;
  uint64_t partOf = 0;   ///< The track whose portrait showed it when it came out of that; 0 = none.
  int64_t unseenNs = 0;  ///< Since it was last seen.
  int64_t ageNs = 0;
  int64_t seenNs = 0;                 ///< Of its age.
  int64_t stillNs = 0;                ///< Since it last left its place.
  int32_t stillX = 0, stillFoot = 0;  ///< That place.
  Extent stillSize;                   ///< Its size there.
  uint32_t ageFrames = 0;
  uint32_t hits = 0;                    ///< Frames in which it was seen.
  uint32_t sizeSamples = 0;             ///< Frames in which all of it was seen.
  int32_t originX = 0, originFoot = 0;  ///< Where it was first seen.
  int32_t learntX = 0, learntFoot = 0;  ///< Where the scene's scale last learnt from it.
  int32_t centreX = 0, centreY = 0;     ///< From its box's middle to the mean of its pixels.
  uint32_t centreSamples = 0;           ///< Frames from which that was learnt.
  int32_t steadyX = 0, steadyY = 0;     ///< Its speed over the last half second or so.
  bool isWhole = false;                 ///< All of it is seen in this frame.
  StandingEdge leftEdge, rightEdge;
  uint16_t sway = 64;    ///< By how much its box changes, in 1/256 of its size.
  uint16_t fill = 150;   ///< Share of its box that is foreground, in 1/256.
  bool isSeen = false;   ///< In this frame.
  uint64_t company = 0;  ///< Smallest id of those that it is in a crowd with.
  uint64_t nextCompany = 0;
  int64_t companyNs = 0;           ///< Since nextCompany holds.
  int64_t apartNs = 0;             ///< For how long it was seen in a crowd of its own.
  int64_t doubleNs = 0;            ///< Since it looks like a part of another track.
  int32_t partOffset = INT32_MIN;  ///< Between the middles of its blob and of another part, when
                                   ///< they were first seen, in half pixels.
  int32_t partGap = INT32_MIN;     ///< The middle of the gap between the two, likewise.
  bool isStanding = false;         ///< Its regions show that it doesn't move in this frame.
  bool isOver = false;
  bool hasMoved = false;
  bool isFromBorder = false;  ///< First seen where things come into the picture, or moving.
  bool isConfirmed = false;
  bool hasTravelled = false;  ///< It was half its width away from where it was first seen.
  bool isInDoubt = false;     ///< It may have taken another's place.

  [[nodiscard]] Box box() const;  ///< In pixels.
  /// How far it goes in the picture until this frame, in 1/16 px, while the camera moves so.
  void setStep(Point step, const CameraMotion& camera, int64_t stepNs);
  /// Where the portrait lies, in pixels, once the picture has moved by `camera` (1/16 px).
  [[nodiscard]] Point portraitCorner(Point camera = {}) const;
};

/// Middle of a box's lower edge, in 1/16 px.
struct Place {
  int64_t x = 0, foot = 0;
};

/// Where a track is of which `part` is seen, in pixels: as near to its expected place as the part's
/// edges inside the frame allow.
[[nodiscard]] Place placeOfPart(const Track& track, const Box& part, Size frame);

/// How far a track will move over the ground in the next `stepNs`, in 1/16 px.
[[nodiscard]] Point expectedStep(const Track& track, int64_t stepNs);
/// The same in the picture, in pixels, while the camera moves so.
[[nodiscard]] Point expectedShift(const Track& track, const CameraMotion& camera, int64_t stepNs);

/// All of a track's places, speeds and lengths are those in the picture, which moves over the
/// ground, turns and zooms.
void moveWithCamera(Track& track, const CameraMotion& camera);

}  // namespace rg::objects
