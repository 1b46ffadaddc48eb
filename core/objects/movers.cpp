// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/movers.hpp"

namespace rg::objects {
namespace {

bool isFollowed(const Track& track, const Numbers::Parallax& numbers) {
  return track.seenNs >= numbers.followed.whole();
}

}  // namespace

void Movers::reset() {
  past_.clear();
  evidence_.reset();
  parallax_.reset();
}

void Movers::compareWith(const PastFrame& past, const motion::Motion& motion,
                         const MoverRules& rules, Operations& operations) {
  expected_.clear();
  for (const Track& track : rules.tracks)
    expected_.push_back(
        {expectedShift(track, past.camera, past.ageNs), isFollowed(track, rules.parallax)});
  findOwnMotion(motion, {*past.picture, past.camera, past.ageNs, rules.stepNs},
                {rules.arcs, rules.weights, rules.expected, expected_, &parallax_}, operations,
                scratch_, own_);
}

void Movers::find(const motion::Motion& motion, const MoverRules& rules, Operations& operations) {
  clearOwnMotion(motion.regions.size(), scratch_, own_);
  // What was not matched with the previous frame is not like it.
  if (motion.status == Status::Skipped) past_.clear();
  past_.advance(motion.camera, rules.stepNs);
  const PastFrame* older = past_.nearest(rules.perPixelNs);
  const PastFrame* previous = past_.previous();
  const std::shared_ptr<const Picture>& now = motion.graph->picture;
  if (previous == nullptr || !now || previous->picture->size() != now->size()) {
    past_.clear();
    parallax_.reset();
    evidence_.carry(motion, nullptr, rules.stepNs, operations);
    return;
  }
  evidence_.carry(motion, previous->picture.get(), rules.stepNs, operations);
  isKnown_.clear();
  for (const TrackIndex track : rules.expected)
    isKnown_.push_back(track && isFollowed(rules.tracks[track.index()], rules.parallax));
  parallax_.look(motion, isKnown_, rules.stepNs, rules.parallax);
  compareWith(*previous, motion, rules, operations);
  if (older == previous) return;
  sinceLast_ = own_;
  compareWith(*older, motion, rules, operations);
  for (size_t i = 0; i < own_.size(); ++i)
    if (sinceLast_[i].isTried() && sinceLast_[i].gain > own_[i].gain) own_[i] = sinceLast_[i];
}

void Movers::remember(const motion::Motion& motion, const MoverRules& rules,
                      Operations& operations) {
  evidence_.add(motion, own_, operations);
  if (motion.graph->picture) past_.add(motion.graph->picture, rules.perPixelNs);
}

}  // namespace rg::objects
