// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/tracking/steps/returns.hpp"

#include "core/base/pixel.hpp"
#include "core/base/time/frame_count.hpp"

#include <algorithm>
#include <utility>

namespace rg::objects {
namespace {

constexpr int kUnit = kPositionUnit;
constexpr size_t kMaxTracks = 256;  // Together with kMaxNewcomers bounds a frame of noise.

/// The object that a newcomer comes out of: the one that it touches, or whose place it overlaps
/// most when it appears right beside it. 0 = none.
uint64_t parentOf(const Newcomer& newcomer, const TrackerState& state) {
  if (newcomer.parent != 0 || newcomer.isAtBorder) return newcomer.parent;
  const auto beside = [&](int width) {
    return static_cast<int>(state.numbers.newcomers.besideParent.of(width));
  };
  uint64_t parent = 0;
  int64_t most = 0;
  for (const Track& track : state.tracks) {
    const Box box = track.box();
    const int64_t shared = intersect(inflate(box, beside(box.width)), newcomer.box).area();
    if (!track.isConfirmed || track.state == ObjectState::Lost || shared <= most) continue;
    most = shared;
    parent = track.id;
  }
  return parent;
}

void seeAgain(Track& track, const Place& place) {
  track.x = static_cast<int32_t>(place.x);
  track.foot = static_cast<int32_t>(place.foot);
  track.isSeen = true;
  track.unseenNs = 0;
  countUp(track.hits);
}

/// The track that was missing is where the young one was seen, which ends.
void takePlace(size_t index, size_t young, TrackerState& state) {
  Track &track = state.tracks[index], &other = state.tracks[young];
  seeAgain(track, {other.x, other.foot});
  track.speedX = other.speedX;
  track.speedY = other.speedY;
  track.isWhole = other.isWhole;
  track.isStanding = other.isStanding;
  other.isSeen = false;  // No other step takes the two for one body.
  other.isOver = true;
  state.exchangeSightings(index, young);
  for (uint16_t& owner : state.owner)
    if (owner == young + 1) owner = static_cast<uint16_t>(index + 1);
}

void begin(const Newcomer& newcomer, TrackerState& state) {
  Track track;
  track.id = state.nextId++;
  track.x = (2 * newcomer.box.x + newcomer.box.width) * kUnit / 2;
  track.foot = newcomer.box.bottom() * kUnit;
  track.size = {newcomer.box.width * kUnit, newcomer.box.height * kUnit};
  if (state.scale.isUniform()) {
    const Extent expected = state.scale.at(newcomer.box.bottom());
    const bool isUsual = track.size.width <= state.numbers.newcomers.usualWidth * expected.width &&
                         track.size.height <= state.numbers.newcomers.usualHeight * expected.height;
    // What comes in shows a part: the rest is beyond the border that it touches.
    if (isUsual) {
      const Box& box = newcomer.box;
      track.size = expected;
      if (box.x <= 0) track.x = box.right() * kUnit - expected.width / 2;
      if (box.right() >= state.frame.width) track.x = box.x * kUnit + expected.width / 2;
      if (box.bottom() >= state.frame.height) track.foot = box.y * kUnit + expected.height;
    }
  }
  if (const uint64_t parent = parentOf(newcomer, state)) track.parents.push_back(parent);
  track.stillX = track.originX = track.learntX = track.x;
  track.stillFoot = track.originFoot = track.learntFoot = track.foot;
  track.stillSize = track.size;
  track.look = newcomer.appearance;
  track.isFromBorder = newcomer.isAtBorder || state.showsMovers;
  track.isSeen = true;
  track.hits = 1;
  track.ageFrames = 1;
  state.tracks.push_back(std::move(track));
}

}  // namespace

/// Newcomers, and then tracks that nobody has been told of yet. Before a moving camera who isn't
/// seen may stand: nobody has taken that place.
void Returns::findCandidates(const std::vector<Newcomer>& newcomers, const TrackerState& state) {
  missing_.clear();
  young_.clear();
  for (size_t i = 0; i < state.tracks.size(); ++i) {
    const Track& track = state.tracks[i];
    if (!track.isSeen)
      missing_.push_back(i);
    else if (!track.isConfirmed && !state.showsMovers)
      young_.push_back(i);
  }
  candidates_.clear();
  for (const Newcomer& newcomer : newcomers)
    candidates_.push_back({newcomer.cells > 0 ? newcomer.box : Box{}, &newcomer.appearance,
                           parentOf(newcomer, state), UINT64_MAX});
  for (const size_t i : young_) {
    const Track& track = state.tracks[i];
    candidates_.push_back(
        {track.box(), &track.look, track.parents.empty() ? 0 : track.parents.front(), track.id});
  }
}

void Returns::settle(const GroupGrid& e, const Encounters& encounters, Newcomers& newcomers,
                     TrackerState& state) {
  const std::vector<Newcomer>& list = newcomers.list();
  std::vector<int>& trackOf = newcomers.tracks();
  findCandidates(list, state);
  costs_.clear();
  for (const size_t m : missing_)
    for (const Candidate& candidate : candidates_)
      costs_.push_back(costOf(state.tracks[m], candidate, encounters, state));
  assignment_.solve(costs_, static_cast<int>(missing_.size()), static_cast<int>(candidates_.size()),
                    state.numbers.identity.leaveOut.whole());
  trackOf.assign(list.size(), -1);
  for (size_t m = 0; m < missing_.size(); ++m) {
    const int column = assignment_.columnOf(static_cast<int>(m));
    if (column < 0) continue;
    const auto n = static_cast<size_t>(column);
    if (n >= list.size()) {
      takePlace(missing_[m], young_[n - list.size()], state);
      continue;
    }
    comeBack(list[n], state, state.tracks[missing_[m]]);
    trackOf[n] = static_cast<int>(missing_[m]);
  }
  for (size_t n = 0; n < list.size(); ++n) {
    if (list[n].cells == 0 || trackOf[n] >= 0 || state.tracks.size() >= kMaxTracks) continue;
    trackOf[n] = static_cast<int>(state.tracks.size());
    begin(list[n], state);
  }
  newcomers.giveCells(e, state);
}

/// 0 … 2000, or kForbidden: how unlikely it is that the candidate is the track that is missing.
int64_t Returns::costOf(const Track& track, const Candidate& candidate,
                        const Encounters& encounters, const TrackerState& state) {
  const Box& box = candidate.box;
  // One whom nobody knows takes nobody's place.
  const bool isYoung = candidate.id != UINT64_MAX;
  if (box.isEmpty() || track.id > candidate.id || (isYoung && !track.isConfirmed))
    return kForbidden;
  const int64_t x = (2 * int64_t{box.x} + box.width) * kUnit / 2;
  const int64_t foot = int64_t{box.bottom()} * kUnit;
  const int64_t dx = x - track.x, dy = foot - track.foot;
  const uint32_t far = integerSqrt(static_cast<uint64_t>(dx * dx + dy * dy));
  const Numbers::Identity& n = state.numbers.identity;
  const int64_t growth = n.gateGrowth.of(track.size.height * (track.unseenNs / 1'000'000)) / 1000;
  const int64_t gate = std::max<int64_t>(1, n.gate.of(track.size.height) + growth);
  if (far > gate) return kForbidden;
  // What comes out of a blob that the track went into may also be the other one of the two; who is
  // who is judged later.
  int likeness = similarity(track.look, *candidate.look);
  if (const Track* other = state.find(candidate.parent))
    if (encounters.contains(track.id, other->id))
      likeness = std::max(likeness, similarity(other->look, *candidate.look));
  const int64_t alike = state.weighed(likeness);
  if (track.isConfirmed && alike < n.alike * kFullMatch) return kForbidden;
  return 1000 * int64_t{far} / gate + 1000 - 1000 * alike / kFullMatch;
}

void Returns::comeBack(const Newcomer& newcomer, const TrackerState& state, Track& track) {
  // What comes out from behind something shows a part first.
  const bool isPart = track.centreSamples > 0 &&
                      newcomer.box.width * kUnit < state.numbers.identity.part * track.size.width;
  Place place{(2 * int64_t{newcomer.box.x} + newcomer.box.width) * kUnit / 2,
              int64_t{newcomer.box.bottom()} * kUnit};
  if (isPart) place = placeOfPart(track, newcomer.box, state.frame);
  seeAgain(track, place);
}

}  // namespace rg::objects
