// SPDX-License-Identifier: LGPL-2.1-or-later
// What becomes of tracks: their states, their end, and what is told of them.
//
// Determinism: events in the order of the tracks' ids.
#pragma once

#include "core/objects/tracking/tracker_state.hpp"

#include <cstdint>
#include <vector>

namespace rg::objects {

/// What a tracker's successor must know: which objects readers take to be there, and the next id.
struct TrackerLegacy {
  std::vector<uint64_t> alive;  ///< Sorted.
  uint64_t nextId = 1;
};

class TrackLife {
 public:
  /// The end of all that were told is to be told.
  void endAll() { endsAll_ = true; }
  /// As of the last takeEvents().
  [[nodiscard]] TrackerLegacy bequeath() noexcept;
  /// Goes on after another one, whose objects end with the next events.
  void inherit(TrackerLegacy&& legacy) noexcept;

  /// States of all tracks; ends those that are gone and says so.
  void settle(int64_t stepNs, int64_t maxLostNs, TrackerState& state);
  /// Of the frame.
  [[nodiscard]] std::vector<Event>& events() { return events_; }
  /// The frame's events, which are told once; ends what they began and ended. Adds
  /// `isAnotherScene` as an event.
  void takeEvents(bool isAnotherScene, uint64_t nextId, std::vector<Event>& out);

 private:
  void tellNew(const Track& track, const TrackerState& state);

  std::vector<Event> events_;
  TrackerLegacy told_;  ///< As of the last takeEvents().
  bool endsAll_ = false;
  std::vector<uint16_t> kept_;  ///< Of each track: 1 + its index among those that stay, 0 = over.
};

}  // namespace rg::objects
