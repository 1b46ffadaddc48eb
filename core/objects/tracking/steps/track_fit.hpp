// SPDX-License-Identifier: LGPL-2.1-or-later
// Where boxes of the tracks' sizes lie best in the foreground (core/objects/tracking/box_fit.hpp).
#pragma once

#include "core/objects/tracking/tracker_state.hpp"

namespace rg::objects {

class TrackFit {
 public:
  /// Fits the boxes of the tracks that are looked for, gives them the cells inside, and begins the
  /// frame's sightings.
  void find(const GroupGrid& evidence, int64_t stepNs, TrackerState& state);

 private:
  std::vector<size_t> order_;
  FitScratch scratch_;
};

}  // namespace rg::objects
