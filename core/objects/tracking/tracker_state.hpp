// SPDX-License-Identifier: LGPL-2.1-or-later
// What the steps of tracking work on (core/objects/tracking/tracker.hpp). What only one of them
// needs it keeps itself.
#pragma once

#include "core/objects/tracking/blobs.hpp"
#include "core/objects/tracking/clutter.hpp"
#include "core/objects/tracking/track.hpp"

#include <cstdint>
#include <vector>

namespace rg::objects {

/// What the fit says of a track in this frame.
struct Sighting {
  int task = -1;               ///< −1: it was not looked for.
  uint32_t cells = 0;          ///< That it owns.
  uint32_t boxCells = 0;       ///< Of its fitted box within the frame.
  uint32_t othersCells = 0;    ///< Of its fitted box that other tracks own.
  bool isCutOff = false;       ///< `box` lacks an end of what is expected there.
  bool isStanding = false;     ///< Its regions show that it doesn't move.
  bool isSole = false;         ///< Nobody else is in its crowd.
  bool isWhole = false;        ///< `box` shows all of it.
  bool isMatched = false;      ///< Its portrait was found.
  uint32_t share = 0;          ///< Of the portrait that was found, in 1/256.
  Box box;                     ///< Pixels, around all that it owns.
  uint64_t areaPx = 0;         ///< Of that.
  int64_t sumX = 0, sumY = 0;  ///< Of the places of their pixels, in 1/256 px.
  LookCounts look;
  Point corner;   ///< Of the portrait that was found, in pixels.
  Point matched;  ///< Middle of the lower edge of the portrait, in 1/16 px.
};

struct TrackerState {
  Numbers numbers;           ///< Of the frame.
  int32_t appearance = 256;  ///< Weight of looks against places, in 1/256.
  Size frame;
  int stepPx = 1;
  bool showsMovers = false;  ///< As in GroupGrid.
  SceneScale scale;
  Clutter clutter;
  std::vector<Track> tracks;        ///< Sorted by id.
  std::vector<Sighting> sightings;  ///< Of each track that there was when the frame began.
  std::vector<FitTask> tasks;       ///< Of the tracks that are looked for.
  std::vector<uint16_t> owner;      ///< Of each cell of the evidence: 1 + track, 0 = none.
  Blobs blobs;                      ///< Each of one group of the energy's minimum.
  Blobs crowds;  ///< The same; but before a still camera, whose groups may be parts of a body, all
                 ///< that touches.
  uint64_t nextId = 1;  ///< Of the next track.

  /// Of each track the blob and the crowd in which it has most cells.
  void findBlobsOfTracks(const GroupGrid& evidence);
  /// What is seen of one track is seen of the other instead.
  void exchangeSightings(size_t a, size_t b);
  /// Until then a track is what its blob is: it grows with it, and nothing else begins beside it.
  [[nodiscard]] bool isSizeKnown(const Track& track) const;
  /// Whether its box hardly changes: what is missing of it is hidden.
  [[nodiscard]] bool isRigid(const Track& track) const;
  /// Whether its portrait tells where it is, where looks tell anything.
  [[nodiscard]] bool isFaithful(const Track& track) const;
  /// Whether a box of pixels is as large as a track, but for two cells or an eighth.
  [[nodiscard]] bool isAbout(const Box& box, const Track& track) const;
  /// Whether the crowd in which a track is alone is as large as it should be.
  [[nodiscard]] bool isClear(size_t index, const GroupGrid& evidence) const;
  /// Whether a box is larger than a track of which the size is known from its own history.
  [[nodiscard]] bool outgrows(const Track& track, const Box& box) const;
  /// Whether other tracks stand in front of most of this one.
  [[nodiscard]] bool isCovered(const Track& track) const;
  /// How large a track of unknown size is of which `box` is seen: what the frame's border cuts off
  /// was seen before, if it is about to leave.
  [[nodiscard]] Extent sizeOfPart(const Track& track, const Box& box) const;
  /// What a similarity of looks counts, up to kFullMatch: what it lacks of that is weighed.
  [[nodiscard]] int64_t weighed(int similarity) const;
  /// Null where there is none of that number.
  [[nodiscard]] const Track* find(uint64_t id) const;
  [[nodiscard]] Track* find(uint64_t id);
};

}  // namespace rg::objects
