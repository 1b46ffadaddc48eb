// SPDX-License-Identifier: LGPL-2.1-or-later
// Who is in a crowd with whom, and since when: merges and splits.
//
// Determinism: a company is named after its smallest id.
#pragma once

#include "core/objects/tracking/tracker_state.hpp"

#include <cstdint>
#include <vector>

namespace rg::objects {

class Companies {
 public:
  /// Tracks of one crowd form a company; a change counts once it has lasted. Tracks that are not
  /// seen stay where they were.
  void find(int64_t stepNs, TrackerState& state);
  /// Adds one event for each company that came together or apart in this frame.
  void tell(const TrackerState& state, std::vector<Event>& events) const;

 private:
  std::vector<uint64_t> before_;  ///< Of each track its company in the previous frame.
};

}  // namespace rg::objects
