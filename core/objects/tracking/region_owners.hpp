// SPDX-License-Identifier: LGPL-2.1-or-later
// Which object each region overlaps most: in this frame, or where the objects of the previous frame
// are expected in this one (the prediction that restarts the MRF; paper, section 2.3 phase 2.4).
//
// Determinism: counts of cells; the track with the smaller number wins ties.
#pragma once

#include "core/base/geometry.hpp"
#include "core/objects/tracking/group_grid.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace rg::objects {

/// Working memory that keeps its capacity from frame to frame.
struct RegionOwnerScratch {
  std::vector<uint32_t> firstPart;
  std::vector<Run> parts;                  ///< Of each track's cells, one track after another.
  std::vector<uint32_t> votes, mostVotes;  ///< Of each region.
  std::vector<uint32_t> seen;              ///< Regions with votes.
};

/// owner: of each cell of `grid` 1 + track, 0 = none; shifts: of each track, pixels, how far its
/// cells are moved before they are compared with `labels`; cells that leave the frame do not count.
/// Result: of each region its track or none; `ownerOf` comes with an entry per region.
void findRegionOwners(const segmentation::Labels& labels, const GroupGrid& grid,
                      std::span<const uint16_t> owner, std::span<const Point> shifts,
                      RegionOwnerScratch& scratch, std::vector<TrackIndex>& ownerOf);

}  // namespace rg::objects
