// SPDX-License-Identifier: LGPL-2.1-or-later
// How far tracks went since the previous frame, by the vectors of the regions that came from them
// (paper, section 2.3 phase 2.4, which predicts labels by motion). A speed tells it only of what
// goes on as it did.
//
// Determinism: counts of cells and medians.
#pragma once

#include "core/base/camera/camera_motion.hpp"
#include "core/motion/motion.hpp"
#include "core/objects/tracking/group_grid.hpp"
#include "core/objects/tracking/track.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace rg::objects {

/// A region that came from a track: how far, in 1/16 px, and how many of its cells did.
struct RegionStep {
  uint32_t track = 0, cells = 0;
  Point step;
};

/// Working memory that keeps its capacity from frame to frame.
struct TrackStepScratch {
  std::vector<uint32_t> trackCells;  ///< Of each track, in the previous frame.
  std::vector<uint32_t> arrived;     ///< Of each track: cells of one region that came from it.
  std::vector<RegionStep> steps;
};

/// Sets `stepSpeed` of the tracks that at least half as many cells came from as they had: by the
/// median of those. A region came from a track if more than half of its cells did.
/// previous, owner: the previous frame's grid, and of each of its cells 1 + track, 0 = none;
/// camera, stepNs: since then.
void measureSteps(const motion::Motion& motion, const CameraMotion& camera, int64_t stepNs,
                  const GroupGrid& previous, std::span<const uint16_t> owner, TrackStepScratch& s,
                  std::vector<Track>& tracks);

}  // namespace rg::objects
