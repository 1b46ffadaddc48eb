// SPDX-License-Identifier: LGPL-2.1-or-later
// Who is who after several objects were one blob: once they are apart again, their looks tell
// whether two of them have taken each other's place. And which of them are one.
#include "core/objects/tracking/tracker.hpp"

#include <algorithm>
#include <tuple>
#include <utility>

namespace rg::objects {
namespace {

constexpr int kUnit = kPositionUnit;
constexpr size_t kMaxEncounters = 512;

/// Exchanges who two tracks are; where they are and what is seen there stays.
void exchangeIdentities(Track& a, Track& b) {
  std::swap(a.id, b.id);
  std::swap(a.look, b.look);
  std::swap(a.portrait, b.portrait);
  std::swap(a.colour, b.colour);
  std::swap(a.parents, b.parents);
  std::swap(a.ageNs, b.ageNs);
  std::swap(a.seenNs, b.seenNs);
  std::swap(a.ageFrames, b.ageFrames);
}

}  // namespace

/// Who stands where somebody was expected but looks like nothing that was seen of them is somebody
/// else: one who comes in where the other left.
void Tracker::dropStrangers(const GroupGrid& e) {
  const Numbers::Identity& n = numbers_.identity;
  bool hasStrangers = false;
  for (size_t i = 0; i < tracks_.size(); ++i) {
    Sighting& s = sightings_[i];
    const Track& track = tracks_[i];
    const bool isAlone = blobOf_[i] != 0 && soleTrack_[blobOf_[i]] == i + 1;
    if (!isAlone || s.isMatched || track.look.frames < n.knownLook.whole() ||
        s.cells < n.leastCells.whole())
      continue;
    Look now;
    learn(now, s.look);
    if (similarity(track.look, now) >= n.stranger * kFullMatch) continue;
    s = {};
    blobOf_[i] = 0;
    hasStrangers = true;
  }
  if (!hasStrangers) return;
  e.forForeground([&](size_t cell, int, int) {
    if (owner_[cell] != 0 && sightings_[owner_[cell] - 1u].task < 0) owner_[cell] = 0;
  });
}

/// Remembers the pairs of tracks that overlap in one blob.
void Tracker::meet() {
  for (Encounter& encounter : encounters_) encounter.isTogether = false;
  for (size_t a = 0; a < sightings_.size(); ++a) {
    if (blobOf_[a] == 0 || !tracks_[a].isConfirmed || soleTrack_[blobOf_[a]] != 0) continue;
    for (size_t b = a + 1; b < sightings_.size(); ++b) {
      if (blobOf_[b] != blobOf_[a] || !tracks_[b].isConfirmed) continue;
      if (intersect(tracks_[a].box(), tracks_[b].box()).isEmpty()) continue;
      const std::pair ids{tracks_[a].id, tracks_[b].id};
      const auto at = std::lower_bound(encounters_.begin(), encounters_.end(), ids,
                                       [](const Encounter& e, const auto& key) {
                                         return std::pair{e.first, e.second} < key;
                                       });
      if (at != encounters_.end() && std::pair{at->first, at->second} == ids)
        at->isTogether = true;
      else if (encounters_.size() < kMaxEncounters)
        encounters_.insert(at, {ids.first, ids.second, true});
    }
  }
  for (Track& track : tracks_) track.isInDoubt = false;
  const auto mark = [&](uint64_t id) {
    if (Track* track = find(id)) track->isInDoubt = true;
  };
  for (const Encounter& encounter : encounters_) {
    mark(encounter.first);
    mark(encounter.second);
  }
}

Track* Tracker::find(uint64_t id) {
  const auto at = std::lower_bound(tracks_.begin(), tracks_.end(), id,
                                   [](const Track& track, uint64_t key) { return track.id < key; });
  return at != tracks_.end() && at->id == id ? &*at : nullptr;
}

/// The look of a track; as long as it may be somebody else's, only what is seen since it is alone.
void Tracker::learnLook(size_t index) {
  Track& track = tracks_[index];
  const Sighting& s = sightings_[index];
  if (!track.isInDoubt) {
    track.recent = {};
    if (s.isWhole || track.look.frames < 4) learn(track.look, s.look);
  } else if (!s.isSole) {
    track.recent = {};
  } else if (s.isWhole) {
    learn(track.recent, s.look);
  }
}

/// Judges the pairs that came apart; where each looks like the other did, they are exchanged.
void Tracker::judgeIdentities() {
  const int64_t looks = numbers_.identity.looks.whole();
  const auto isSettled = [&](const Encounter& encounter) {
    Track *first = find(encounter.first), *second = find(encounter.second);
    if (!first || !second || first->isOver || second->isOver) return true;
    if (encounter.isTogether) return false;
    if (first->recent.frames < looks || second->recent.frames < looks) return false;
    const int stay =
        similarity(first->look, first->recent) + similarity(second->look, second->recent);
    const int change =
        similarity(first->look, second->recent) + similarity(second->look, first->recent);
    if (change > stay + numbers_.identity.margin.of(kFullMatch)) exchange(*first, *second);
    return true;
  };
  size_t kept = 0;
  for (size_t i = 0; i < encounters_.size(); ++i)
    if (!isSettled(encounters_[i])) encounters_[kept++] = encounters_[i];
  encounters_.resize(kept);
}

void Tracker::exchange(Track& a, Track& b) {
  const auto first = static_cast<size_t>(&a - tracks_.data());
  const auto second = static_cast<size_t>(&b - tracks_.data());
  exchangeIdentities(a, b);
  std::swap(a, b);  // Tracks stay sorted by id.
  std::swap(sightings_[first], sightings_[second]);
  std::swap(blobOf_[first], blobOf_[second]);
  for (uint16_t& owner : owner_) {
    if (owner == first + 1)
      owner = static_cast<uint16_t>(second + 1);
    else if (owner == second + 1)
      owner = static_cast<uint16_t>(first + 1);
  }
}

/// Whether two tracks seem to be one body: they lie above each other as its halves do, or together
/// show no more than one of them should.
bool Tracker::areOneBody(const GroupGrid& e, size_t a, size_t b) const {
  const Numbers::Life& n = numbers_.life;
  const Track &p = tracks_[a], &q = tracks_[b];
  const Box first = p.box(), second = q.box(), both = unite(first, second);
  const int columns = std::min(first.right(), second.right()) - std::max(first.x, second.x);
  if (blobOf_[a] != 0 && blobOf_[b] != 0 &&
      areApart(e, blobs_[blobOf_[a] - 1].group, blobs_[blobOf_[b] - 1].group))
    return false;
  if (!scale_.isUniform() && (isComplete(a, e) || isComplete(b, e))) return false;
  if (outgrows(p, both) || outgrows(q, both)) return false;
  if (!scale_.isUniform() && blobOf_[a] != 0 && blobOf_[a] == blobOf_[b] &&
      std::min(p.apartNs, q.apartNs) < n.doubled.whole())
    return true;
  if (columns < n.oneBodyColumns * std::min(first.width, second.width)) return false;
  if (!scale_.isUniform()) {
    const int rows = std::min(first.bottom(), second.bottom()) - std::max(first.y, second.y);
    const int least = std::min(first.height, second.height);
    return rows < n.oneBodyRows * least && -rows < n.oneBodyGap * least;
  }
  const Extent usual = scale_.at(both.bottom());
  if (both.height * kUnit < n.oneBodyHeight * usual.height) return true;
  const Sighting &s = sightings_[a], &t = sightings_[b];
  const int64_t one = int64_t{std::max(s.boxCells, t.boxCells)} * std::max(p.fill, q.fill);
  return 256 * (int64_t{s.cells} + t.cells) < n.oneBodyCells * one &&
         intersect(first, second).area() > n.oneBodyShared * std::min(first.area(), second.area());
}

/// Ends tracks that were one body with an older one for a while.
void Tracker::joinDoubles(const GroupGrid& e, int64_t stepNs) {
  for (size_t b = 0; b < sightings_.size(); ++b) {
    Track& track = tracks_[b];
    if (!track.isSeen) continue;
    size_t partner = b;
    for (size_t a = 0; a < b && partner == b; ++a)
      if (tracks_[a].isSeen && !tracks_[a].isOver && areOneBody(e, a, b)) partner = a;
    if (partner == b) {
      track.doubleNs = 0;
      continue;
    }
    track.doubleNs += stepNs;
    // Nothing says that it is a thing of its own when it was apart for a shorter time.
    const int64_t doubled = numbers_.life.doubled.whole();
    if (track.doubleNs < (scale_.isUniform() ? doubled : std::min(doubled, track.apartNs)))
      continue;
    Track& kept = tracks_[partner];
    if (!scale_.isUniform()) {
      const Box both = unite(kept.box(), track.box());
      kept.x = (2 * both.x + both.width) * kUnit / 2;
      kept.foot = both.bottom() * kUnit;
      kept.size = {both.width * kUnit, both.height * kUnit};
      kept.sizeSamples = 0;
    }
    track.isOver = true;
    for (uint16_t& owner : owner_)
      if (owner == b + 1) owner = static_cast<uint16_t>(partner + 1);
  }
}

}  // namespace rg::objects
