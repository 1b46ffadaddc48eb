// SPDX-License-Identifier: LGPL-2.1-or-later
// Which cells belong to which track, beyond the boxes that were fitted.
//
// Determinism: counts of cells; the smaller number wins ties.
#pragma once

#include "core/objects/tracking/tracker_state.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace rg::objects {

/// Who has more than half of what is counted (Boyer and Moore), found without a table of all pairs.
/// Both passes must count the same things; their order doesn't change who has a majority.
struct Majority {
  uint32_t value = 0;
  uint32_t lead = 0;
  uint32_t votes = 0;  ///< For `value`, after the second pass.
  uint32_t total = 0;

  void propose(uint32_t candidate, uint32_t times) {
    if (lead == 0) value = candidate;
    if (candidate == value) {
      lead += times;
    } else if (times <= lead) {
      lead -= times;
    } else {
      value = candidate;
      lead = times - lead;
    }
  }
  void count(uint32_t candidate, uint32_t times) {
    votes += candidate == value ? times : 0;
    total += times;
  }
};

class CellOwners {
 public:
  /// As long as the scene doesn't say how large things are, one blob is one object: whoever is in
  /// it shares all of it, each the cells that are nearest, and has nothing of another blob that
  /// stands beside it and is about as high.
  void shareBlobs(const GroupGrid& evidence, TrackerState& state);
  /// The groups of which a track has most are what is seen of it, once it has what sticks out of
  /// it.
  void giveGroups(const GroupGrid& evidence, std::span<const Group> groups, TrackerState& state);

 private:
  void partTracks(const GroupGrid& evidence, TrackerState& state);
  void limitTracks(const GroupGrid& evidence, const TrackerState& state);
  void reclaimExpected(const GroupGrid& evidence, TrackerState& state) const;
  void spreadOwners(const GroupGrid& evidence, TrackerState& state);
  void giveStrides(const GroupGrid& evidence, TrackerState& state) const;

  std::vector<Majority> majorities_;
  std::vector<uint16_t> distance_;  ///< Of each cell from those that owned it first.
  std::vector<Box> limits_;         ///< Of each track, cells: beyond, nothing is part of it.
};

}  // namespace rg::objects
