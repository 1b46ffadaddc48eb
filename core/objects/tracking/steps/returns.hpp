// SPDX-License-Identifier: LGPL-2.1-or-later
// Which newcomers are tracks that were missing; the others begin tracks.
//
// Determinism: of several cheapest assignments one is chosen by the order of tracks and newcomers.
#pragma once

#include "core/objects/tracking/assignment.hpp"
#include "core/objects/tracking/steps/encounters.hpp"
#include "core/objects/tracking/steps/newcomers.hpp"

#include <cstdint>
#include <vector>

namespace rg::objects {

class Returns {
 public:
  /// Gives newcomers to the tracks that are missing and look like them.
  void settle(const GroupGrid& evidence, const Encounters& encounters, Newcomers& newcomers,
              TrackerState& state);

 private:
  [[nodiscard]] int64_t costOf(const Track& track, const Newcomer& newcomer,
                               const Encounters& encounters, const TrackerState& state);
  void comeBack(const Newcomer& newcomer, const TrackerState& state, Track& track);

  std::vector<size_t> missing_;  ///< Tracks.
  std::vector<int64_t> costs_;
  Assignment assignment_;
};

}  // namespace rg::objects
