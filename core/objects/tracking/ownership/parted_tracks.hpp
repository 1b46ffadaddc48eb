// SPDX-License-Identifier: LGPL-2.1-or-later
// Two things that were taken for one when they came in: once one has moved against the other by a
// quarter of a width, the track gives it up. Parts of a body don't do that. The same where the gap
// between two beside each other moves along: what hides the middle of a thing stands still.
//
// Determinism: counts of cells; the smaller number wins ties.
#pragma once

#include "core/objects/tracking/tracker_state.hpp"

#include <cstdint>
#include <vector>

namespace rg::objects {

/// Who has more than half of what is counted (Boyer and Moore), found without a table of all pairs.
/// Both passes must count the same things; their order doesn't change who has a majority.
struct Majority {
  uint32_t value = 0;
  uint32_t lead = 0;
  uint32_t votes = 0;  ///< For `value`, after the second pass.
  uint32_t total = 0;

  void propose(uint32_t candidate) {
    if (lead == 0) value = candidate;
    lead = candidate == value ? lead + 1 : lead - 1;
  }
  void count(uint32_t candidate) {
    votes += candidate == value;
    ++total;
  }
};

class PartedTracks {
 public:
  /// Where all things are of one size nothing is given up: sizes tell where they end.
  void find(const GroupGrid& evidence, TrackerState& state);
  /// Of each cell of the evidence: 1 + the track that has just given it up, 0 = none.
  [[nodiscard]] const std::vector<uint16_t>& partedFrom() const { return partedFrom_; }

 private:
  std::vector<uint16_t> partedFrom_;
  std::vector<Majority> majorities_;  ///< Of each track: the other blob that it has most cells in.
};

}  // namespace rg::objects
