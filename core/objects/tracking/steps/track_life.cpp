// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/tracking/steps/track_life.hpp"

#include "core/base/pixel.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace rg::objects {
namespace {

/// How far a track has come since it last left its place, in 1/16 px. Of what comes in at the
/// border only the inner edges move, and what only gets smaller there is leaving.
int64_t movedBy(const Track& track, const TrackerState& state) {
  const int64_t dx = track.x - track.stillX, dy = track.foot - track.stillFoot;
  if (track.isConfirmed || !track.isFromBorder)
    return integerSqrt(static_cast<uint64_t>(dx * dx + dy * dy));
  const Box box = inflate(track.box(), 2 * state.stepPx);
  const int64_t wider = (track.size.width - track.stillSize.width) / 2;
  const int64_t higher = track.size.height - track.stillSize.height;
  const bool atLeft = box.x <= 0, atRight = box.right() >= state.frame.width;
  const bool atTop = box.y <= 0, atBottom = box.bottom() >= state.frame.height;
  const auto inwards = [](bool isAtLow, bool isAtHigh, int64_t low, int64_t high) {
    if (isAtLow != isAtHigh) return isAtLow ? high : -low;
    return isAtLow || (low < 0) != (high < 0) ? 0 : std::min(std::abs(low), std::abs(high));
  };
  return inwards(atLeft, atRight, dx - wider, dx + wider) +
         inwards(atTop, atBottom, dy - higher, dy);
}

void settleState(int64_t stepNs, const TrackerState& state, Track& track) {
  // In the middle of the picture only what left something behind appears, and who comes out of
  // somebody: of the former more is asked.
  const Numbers::Life& n = state.numbers.life;
  const bool isBelievable = track.isConfirmed || track.isFromBorder || !track.parents.empty();
  const int64_t leave = (isBelievable ? n.leave : n.leaveNew).of(track.size.height);
  track.stillNs += stepNs;
  const bool hasLeft = movedBy(track, state) > leave && (track.isConfirmed || !track.isStanding);
  if (hasLeft || (!track.isConfirmed && (track.stillNs > n.creep.whole() || track.isStanding))) {
    track.stillNs = 0;
    track.stillX = track.x;
    track.stillFoot = track.foot;
    track.stillSize = track.size;
  }
  track.hasMoved |= track.stillNs == 0 && hasLeft;
  const int64_t wayX = track.x - track.originX, wayY = track.foot - track.originFoot;
  track.hasTravelled |= std::abs(wayX) + std::abs(wayY) >= n.travelled * track.size.width;
  track.isConfirmed |=
      track.hasMoved && track.hits >= n.confirmHits.whole() && track.seenNs >= n.confirm.whole();
  if (!track.isConfirmed) return;
  if (track.isSeen)
    track.state = track.stillNs >= n.still.whole() ? ObjectState::Stopped : ObjectState::Tracked;
  // What was seen for a moment only is not believed to be there when it isn't seen.
  else if (state.isSizeKnown(track) && track.unseenNs <= n.believed * track.seenNs &&
           (track.unseenNs <= n.miss.whole() ||
            (track.state != ObjectState::Lost && state.isCovered(track))))
    track.state = ObjectState::Occluded;
  else
    track.state = ObjectState::Lost;
}

/// Whether the last bit of a track is about to leave the picture: what is seen there next may be
/// somebody who comes in. A portrait tells them apart.
bool isLeaving(const Track& track, const TrackerState& state) {
  const Box box = track.box();
  if (!track.isConfirmed || state.isFaithful(track) ||
      8 * intersect(box, boundsOf(state.frame)).area() >= box.area())
    return false;
  return (box.x < 0 && track.speedX < 0) || (box.right() > state.frame.width && track.speedX > 0) ||
         (box.y < 0 && track.speedY < 0) || (box.bottom() > state.frame.height && track.speedY > 0);
}

}  // namespace

/// A new object, and what it came out of if that is still there.
void TrackLife::tellNew(const Track& track, const TrackerState& state) {
  events_.push_back({EventKind::ObjectNew, {track.id}});
  for (const Track& parent : state.tracks)
    if (!track.parents.empty() && parent.id == track.parents.front() && parent.isConfirmed)
      events_.push_back({EventKind::Split, {parent.id, track.id}});
}

void TrackLife::settle(int64_t stepNs, int64_t maxLostNs, TrackerState& state) {
  const Numbers::Life& n = state.numbers.life;
  state.clutter.age(stepNs);
  if (endsAll_)
    for (const uint64_t id : told_.alive) events_.push_back({EventKind::ObjectEnd, {id}});
  endsAll_ = false;
  kept_.assign(state.tracks.size(), 0);
  size_t kept = 0;
  const size_t count = state.tracks.size();
  for (size_t i = 0; i < count; ++i) {
    Track& track = state.tracks[i];
    const bool wasConfirmed = track.isConfirmed;
    settleState(stepNs, state, track);
    const Box box = track.box();
    const bool hasLeft = !track.isSeen && state.frame.width > 0 &&
                         intersect(box, boundsOf(state.frame)).area() < n.gone * box.area();
    const bool isOver =
        track.isOver || hasLeft || isLeaving(track, state) ||
        (track.isConfirmed ? track.unseenNs > maxLostNs : track.unseenNs > n.flicker.whole());
    if (!wasConfirmed && track.isConfirmed) tellNew(track, state);
    if (isOver) {
      if (track.isConfirmed) events_.push_back({EventKind::ObjectEnd, {track.id}});
      if (!track.isOver && track.seenNs < n.clutter.whole())
        state.clutter.learn(intersect(box, boundsOf(state.frame)).area() * track.fill / 256);
      continue;
    }
    kept_[i] = static_cast<uint16_t>(kept + 1);
    if (kept != i) state.tracks[kept] = std::move(track);
    ++kept;
  }
  state.tracks.resize(kept);
  if (kept == count) return;
  for (uint16_t& owner : state.owner)
    if (owner != 0) owner = kept_[owner - 1u];
}

void TrackLife::takeEvents(bool isAnotherScene, uint64_t nextId, std::vector<Event>& out) {
  if (isAnotherScene) events_.push_back({EventKind::SceneChanged, {}});
  std::vector<uint64_t>& alive = told_.alive;
  alive.reserve(alive.size() + events_.size());
  // Nothing fails from here on.
  for (const Event& event : events_) {
    if (event.kind == EventKind::ObjectNew) alive.push_back(event.ids.front());
    if (event.kind == EventKind::ObjectEnd) std::erase(alive, event.ids.front());
  }
  std::sort(alive.begin(), alive.end());
  told_.nextId = nextId;
  events_.swap(out);
  events_.clear();
}

TrackerLegacy TrackLife::bequeath() noexcept {
  return std::exchange(told_, {});
}

void TrackLife::inherit(TrackerLegacy&& legacy) noexcept {
  told_ = std::move(legacy);
  endsAll_ = true;
}

}  // namespace rg::objects
