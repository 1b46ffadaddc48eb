// SPDX-License-Identifier: LGPL-2.1-or-later
// Objects over time: each keeps its number while it moves, stops, is hidden, or shares a blob.
//
// Every frame, tracks are predicted, boxes of their size are fitted to the foreground together
// (core/objects/tracking/box_fit.hpp), what is left over becomes newcomers, and newcomers that look
// like a track that is missing are that track.
//
// Determinism: integers. Tracks are sorted by id; every choice has a key that ends in an id or a
// raster position.
#pragma once

#include "core/objects/tracking/looks/track_portraits.hpp"
#include "core/objects/tracking/ownership/parted_tracks.hpp"
#include "core/objects/tracking/ownership/track_terminals.hpp"
#include "core/objects/tracking/steps/companies.hpp"
#include "core/objects/tracking/steps/encounters.hpp"
#include "core/objects/tracking/steps/newcomers.hpp"
#include "core/objects/tracking/steps/returns.hpp"
#include "core/objects/tracking/steps/track_fit.hpp"
#include "core/objects/tracking/steps/track_life.hpp"
#include "core/objects/tracking/steps/track_steps.hpp"

#include <cstdint>
#include <utility>
#include <vector>

namespace rg::objects {

struct TrackerParams {
  int64_t maxLostNs = 2'000'000'000;
  uint32_t minAreaPx = 0;    ///< 0 = learnt from the scene.
  int32_t appearance = 256;  ///< As in TrackerState.
  Numbers numbers{};
};

class Tracker {
 public:
  /// Ends all tracks; the next update's events tell. The scene's scale stays.
  void reset();
  /// As of the last takeEvents(), whatever has become of the tracker since.
  [[nodiscard]] TrackerLegacy bequeath() noexcept { return life_.bequeath(); }
  /// Goes on after another tracker, whose objects end with the next update's events.
  void inherit(TrackerLegacy&& legacy) noexcept;
  /// A frame that shows nothing: tracks move on as they are expected to.
  void predict(int64_t stepNs, const TrackerParams& params);
  /// What this frame's motion says of how far tracks went since `previous`, of which the cells'
  /// owners are: the next update takes it for their speeds.
  void measure(const motion::Motion& motion, const CameraMotion& camera, int64_t stepNs,
               const GroupGrid& previous);
  void update(const GroupGrid& evidence, const MergeInput& input, const TrackerParams& params,
              const Executor& executor);

  [[nodiscard]] const TrackerState& state() const { return state_; }
  [[nodiscard]] const std::vector<Track>& tracks() const { return state_.tracks; }
  /// Of each cell of the evidence: 1 + index of the track, 0 = none.
  [[nodiscard]] const std::vector<uint16_t>& owner() const { return state_.owner; }
  /// The events of the last update, which are told once; ends what they began and ended. Adds
  /// `isAnotherScene` as an event.
  void takeEvents(bool isAnotherScene, std::vector<Event>& out) {
    life_.takeEvents(isAnotherScene, state_.nextId, out);
  }
  void remember(size_t index, graph::Colour colour) { state_.tracks[index].colour = colour; }

 private:
  void begin(const GroupGrid& evidence, int64_t stepNs);

  TrackerState state_;
  TrackStepScratch stepScratch_;
  TrackFit fit_;
  TrackPortraits portraits_;
  PartedTracks parted_;
  TrackTerminals terminals_;
  Newcomers newcomers_;
  Encounters encounters_;
  Returns returns_;
  Companies companies_;
  TrackLife life_;
};

}  // namespace rg::objects
