// SPDX-License-Identifier: LGPL-2.1-or-later
// What has stopped before a moving camera (part of stage 5).
//
// It moves as the ground does, so no motion parts it from that. But its portrait is known, and
// where that still is where the ground has taken it, it stands there. Only things that have come
// some way over the ground are remembered so: what seemed to move for a moment was none.
//
// Determinism: integer counts of pixels; the track with the smaller number wins ties.
#pragma once

#include "core/objects/tracking/tracker_state.hpp"
#include "core/segmentation/segmentation.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace rg::objects {

/// What a region shows of a thing that stands on the ground.
struct StandingTrack {
  TrackIndex track;
  uint32_t areaPx = 0;  ///< Of the region's pixels those that have its colours.
};

struct StandingScratch {
  std::vector<uint32_t> votes;  ///< Of each region; all 0 between tracks.
  std::vector<uint32_t> seen;   ///< Regions with votes.
};

/// tracks: as they were in the previous frame; camera: how the ground has moved since.
/// Result: of each region that a thing shows in at least half of its pixels, that thing; `ofRegion`
/// comes with an entry per region. Cost: nine looks at a part of each portrait.
void findStandingTracks(const TrackerState& state, const segmentation::Labels& labels,
                        const CameraMotion& camera, std::span<const graph::Region> regions,
                        StandingScratch& scratch, std::span<StandingTrack> ofRegion);

}  // namespace rg::objects
