// SPDX-License-Identifier: LGPL-2.1-or-later
// Who is who after several objects were one crowd: once they are apart again, their looks tell
// whether two of them have taken each other's place.
//
// Determinism: pairs in the order of their ids.
#pragma once

#include "core/objects/tracking/tracker_state.hpp"

#include <cstdint>
#include <vector>

namespace rg::objects {

class Encounters {
 public:
  /// Remembers the pairs of tracks that overlap in one crowd.
  void meet(TrackerState& state);
  /// Judges the pairs that came apart; where each looks like the other did, they are exchanged.
  void judge(TrackerState& state);
  /// Whether two tracks were in one crowd and have not been judged since.
  [[nodiscard]] bool contains(uint64_t a, uint64_t b) const;
  void clear() { list_.clear(); }

 private:
  struct Encounter {
    uint64_t first = 0, second = 0;  ///< Ids, the smaller one first.
    bool isTogether = false;         ///< In this frame.
  };
  std::vector<Encounter> list_;  ///< Sorted by ids.
};

/// The look of a track; as long as it may be somebody else's, only what is seen since it is alone.
void learnLook(size_t index, TrackerState& state);

}  // namespace rg::objects
