// SPDX-License-Identifier: LGPL-2.1-or-later
// Which newcomers are tracks that were missing; the others begin tracks. A track that goes missing
// only after its successor has begun takes that one's place, as long as nobody was told of it.
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
  /// What a missing track may be.
  struct Candidate {
    Box box;  ///< In pixels; empty: it is gone.
    const Look* look;
    uint64_t parent;  ///< Id of the track that it came out of, 0 = none.
    uint64_t id;      ///< Of the young track that it is, UINT64_MAX = a newcomer.
  };
  void findCandidates(const std::vector<Newcomer>& newcomers, const TrackerState& state);
  [[nodiscard]] static int64_t costOf(const Track& track, const Candidate& candidate,
                                      const Encounters& encounters, const TrackerState& state);
  static void comeBack(const Newcomer& newcomer, const TrackerState& state, Track& track);

  std::vector<size_t> missing_, young_;  ///< Tracks.
  std::vector<Candidate> candidates_;
  std::vector<int64_t> costs_;
  Assignment assignment_;
};

}  // namespace rg::objects
