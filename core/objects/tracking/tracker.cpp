// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/tracking/tracker.hpp"

#include "core/objects/tracking/steps/doubles.hpp"
#include "core/objects/tracking/steps/sightings.hpp"
#include "core/objects/tracking/steps/track_places.hpp"
#include "core/objects/tracking/steps/track_sizes.hpp"

namespace rg::objects {

void Tracker::reset() {
  life_.endAll();
  state_.tracks.clear();
  encounters_.clear();
  state_.owner.clear();
}

void Tracker::inherit(TrackerLegacy&& legacy) noexcept {
  state_.nextId = legacy.nextId;
  life_.inherit(std::move(legacy));
}

void Tracker::predict(int64_t stepNs, const TrackerParams& params) {
  state_.numbers = params.numbers;
  life_.events().clear();
  state_.owner.clear();
  for (Track& track : state_.tracks) {
    advance(stepNs, state_, track);
    track.isSeen = false;
    track.unseenNs += stepNs;
  }
  life_.settle(stepNs, params.maxLostNs, state_);
}

void Tracker::measure(const motion::Motion& motion, const CameraMotion& camera, int64_t stepNs,
                      const GroupGrid& previous) {
  measureSteps(motion, camera, stepNs, previous, state_.owner, stepScratch_, state_.tracks);
}

/// Tracks are where they are expected.
void Tracker::begin(const GroupGrid& e, int64_t stepNs) {
  if (state_.frame != e.frame || state_.showsMovers != e.showsMovers) {
    state_.frame = e.frame;
    state_.scale.reset(state_.frame, state_.numbers.sizes);
  }
  state_.stepPx = e.stepPx;
  state_.showsMovers = e.showsMovers;
  for (Track& track : state_.tracks) {
    moveWithCamera(track, e.camera);
    advance(stepNs, state_, track);
  }
}

void Tracker::update(const GroupGrid& evidence, const MergeInput& input,
                     const TrackerParams& params, const Executor& executor) {
  const int64_t stepNs = input.stepNs;
  state_.numbers = params.numbers;
  state_.appearance = params.appearance;
  life_.events().clear();
  begin(evidence, stepNs);
  fit_.find(evidence, stepNs, state_);
  state_.blobs.find(evidence, true, !state_.scale.isUniform());
  state_.crowds.find(evidence, evidence.showsMovers, !state_.scale.isUniform());
  state_.findBlobsOfTracks(evidence);
  portraits_.place(evidence, stepNs, executor, state_);
  parted_.find(evidence, state_);
  terminals_.decide(evidence, input, parted_.partedFrom(), state_);
  countCells(evidence, state_);
  newcomers_.find(evidence, params.minAreaPx, state_);
  sight(evidence, state_);
  encounters_.meet(state_);
  for (size_t i = 0; i < state_.tracks.size(); ++i) correct(i, stepNs, state_);
  returns_.settle(evidence, encounters_, newcomers_, state_);
  for (size_t i = 0; i < state_.sightings.size(); ++i) {
    learnSize(i, stepNs, evidence, state_);
    learnPortrait(i, evidence, state_);
  }
  learnScale(evidence, state_);
  joinDoubles(stepNs, state_);
  encounters_.judge(state_);
  companies_.find(stepNs, state_);
  companies_.tell(state_, life_.events());
  life_.settle(stepNs, params.maxLostNs, state_);
  for (Track& track : state_.tracks) track.stepSpeed.reset();
}

}  // namespace rg::objects
