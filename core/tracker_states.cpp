// SPDX-License-Identifier: LGPL-2.1-or-later
// What becomes of tracks: their size, their state, their end, whom they share a blob with.
#include "core/pixel.hpp"
#include "core/tracker.hpp"

#include <algorithm>

namespace rg {
namespace {

constexpr int kUnit = kPositionUnit;
constexpr uint32_t kConfirmHits = 3;
constexpr int64_t kFlickerNs = 250'000'000;  // A new track that is unseen for longer was nothing.
constexpr int64_t kMissNs = 400'000'000;     // Unseen for longer without a reason, it is lost.
constexpr int64_t kStillNs = 1'000'000'000;  // In one place for so long, it has stopped.

int32_t mix(int32_t old, int64_t fresh, int64_t oldWeight) {
  return static_cast<int32_t>(divideRounded(old * oldWeight + fresh, oldWeight + 1));
}

}  // namespace

/// From a track that was seen whole: its own size and, every half height of its way, the scene's.
void Tracker::learnSize(size_t index, const Evidence& e) {
  Track& track = tracks_[index];
  const Sighting& s = sightings_[index];
  if (!s.isWhole || !track.isSeen) return;
  const Box frame = boundsOf(e.frame);
  const bool isCut = s.box.x <= frame.x || s.box.y <= frame.y || s.box.right() >= frame.right() ||
                     s.box.bottom() >= frame.bottom();
  if (isCut) return;
  const int64_t known = std::min<int64_t>(track.sizeSamples, scale_.isUniform() ? 12 : 4);
  const int64_t weight = scale_.isUniform() ? std::max<int64_t>(known, 4) : known;
  track.size.width = mix(track.size.width, int64_t{s.box.width} * kUnit, weight);
  track.size.height = mix(track.size.height, int64_t{s.box.height} * kUnit, weight);
  ++track.sizeSamples;
  if (s.boxCells > 0) {
    const int64_t fill = std::clamp<int64_t>(int64_t{s.cells} * 256 / s.boxCells, 64, 256);
    track.fill = static_cast<uint16_t>(mix(track.fill, fill, 7));
  }
  const int64_t dx = track.x - track.learntX, dy = track.foot - track.learntFoot;
  const int64_t half = track.size.height / 2;
  if (!track.isConfirmed || s.othersCells > 0 || dx * dx + dy * dy < half * half) return;
  track.learntX = track.x;
  track.learntFoot = track.foot;
  scale_.learn(s.box.bottom(), {s.box.width * kUnit, s.box.height * kUnit});
}

/// Whether other tracks stand in front of most of this one.
bool Tracker::isCovered(const Track& track) const {
  const Box box = track.box();
  int64_t covered = 0;
  for (const Track& other : tracks_)
    if (other.id != track.id && other.isSeen && other.isConfirmed)
      covered += intersect(other.box(), box).area();
  return 5 * covered >= 2 * box.area();
}

void Tracker::settleState(Track& track, int64_t stepNs) const {
  const int64_t dx = track.x - track.stillX, dy = track.foot - track.stillFoot;
  const int64_t leave = track.size.height / 6;
  track.stillNs += stepNs;
  if (dx * dx + dy * dy > leave * leave) {
    track.stillNs = 0;
    track.stillX = track.x;
    track.stillFoot = track.foot;
  }
  if (track.hits >= kConfirmHits) track.isConfirmed = true;
  if (!track.isConfirmed) return;
  if (track.isSeen)
    track.state = track.stillNs >= kStillNs ? ObjectState::Stopped : ObjectState::Tracked;
  else if (track.unseenNs <= kMissNs || (track.state != ObjectState::Lost && isCovered(track)))
    track.state = ObjectState::Occluded;
  else
    track.state = ObjectState::Lost;
}

/// States of all tracks; ends those that are gone and says so.
void Tracker::settle(int64_t stepNs, const TrackerParams& params) {
  for (const uint64_t id : ended_) events_.push_back({EventKind::ObjectEnd, {id}});
  ended_.clear();
  trackIndex_.assign(tracks_.size(), 0);
  size_t kept = 0;
  for (size_t i = 0; i < tracks_.size(); ++i) {
    Track& track = tracks_[i];
    const bool wasConfirmed = track.isConfirmed;
    settleState(track, stepNs);
    const Box box = track.box();
    const bool hasLeft = !track.isSeen && frame_.width > 0 &&
                         2 * intersect(box, boundsOf(frame_)).area() < box.area();
    const bool isOver = track.isConfirmed ? track.unseenNs > params.maxLostNs || hasLeft
                                          : track.unseenNs > kFlickerNs || hasLeft;
    if (!wasConfirmed && track.isConfirmed) events_.push_back({EventKind::ObjectNew, {track.id}});
    if (isOver) {
      if (track.isConfirmed) events_.push_back({EventKind::ObjectEnd, {track.id}});
      continue;
    }
    trackIndex_[i] = static_cast<uint16_t>(kept + 1);
    if (kept != i) tracks_[kept] = std::move(track);
    ++kept;
  }
  tracks_.resize(kept);
  for (uint16_t& owner : owner_)
    if (owner != 0) owner = trackIndex_[owner - 1u];
}

}  // namespace rg
