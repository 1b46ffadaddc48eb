// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/tracking/steps/encounters.hpp"

#include <algorithm>
#include <utility>

namespace rg::objects {
namespace {

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

void exchange(Track& a, Track& b, TrackerState& state) {
  const auto first = static_cast<size_t>(&a - state.tracks.data());
  const auto second = static_cast<size_t>(&b - state.tracks.data());
  exchangeIdentities(a, b);
  std::swap(a, b);  // Tracks stay sorted by id.
  state.exchangeSightings(first, second);
  for (uint16_t& owner : state.owner) {
    if (owner == first + 1)
      owner = static_cast<uint16_t>(second + 1);
    else if (owner == second + 1)
      owner = static_cast<uint16_t>(first + 1);
  }
}

}  // namespace

void Encounters::meet(TrackerState& state) {
  for (Encounter& encounter : list_) encounter.isTogether = false;
  for (size_t a = 0; a < state.sightings.size(); ++a) {
    if (!state.crowds.has(a) || !state.tracks[a].isConfirmed ||
        state.crowds.soleTrack(state.crowds.numberOf(a)) != 0)
      continue;
    for (size_t b = a + 1; b < state.sightings.size(); ++b) {
      if (!state.crowds.areTogether(b, a) || !state.tracks[b].isConfirmed) continue;
      if (intersect(state.tracks[a].box(), state.tracks[b].box()).isEmpty()) continue;
      const std::pair ids{state.tracks[a].id, state.tracks[b].id};
      const auto at = std::lower_bound(list_.begin(), list_.end(), ids,
                                       [](const Encounter& e, const auto& key) {
                                         return std::pair{e.first, e.second} < key;
                                       });
      if (at != list_.end() && std::pair{at->first, at->second} == ids)
        at->isTogether = true;
      else if (list_.size() < kMaxEncounters)
        list_.insert(at, {ids.first, ids.second, true});
    }
  }
  for (Track& track : state.tracks) track.isInDoubt = false;
  const auto mark = [&](uint64_t id) {
    if (Track* track = state.find(id)) track->isInDoubt = true;
  };
  for (const Encounter& encounter : list_) {
    mark(encounter.first);
    mark(encounter.second);
  }
}

void Encounters::judge(TrackerState& state) {
  const int64_t looks = state.numbers.identity.looks.whole();
  const auto isSettled = [&](const Encounter& encounter) {
    Track *first = state.find(encounter.first), *second = state.find(encounter.second);
    if (!first || !second || first->isOver || second->isOver) return true;
    if (encounter.isTogether) return false;
    if (first->recent.frames < looks || second->recent.frames < looks) return false;
    const int stay =
        similarity(first->look, first->recent) + similarity(second->look, second->recent);
    const int change =
        similarity(first->look, second->recent) + similarity(second->look, first->recent);
    if (change > stay + state.numbers.identity.margin.of(kFullMatch))
      exchange(*first, *second, state);
    return true;
  };
  size_t kept = 0;
  for (size_t i = 0; i < list_.size(); ++i)
    if (!isSettled(list_[i])) list_[kept++] = list_[i];
  list_.resize(kept);
}

bool Encounters::contains(uint64_t a, uint64_t b) const {
  return std::any_of(list_.begin(), list_.end(), [&](const Encounter& e) {
    return (e.first == a && e.second == b) || (e.first == b && e.second == a);
  });
}

void learnLook(size_t index, TrackerState& state) {
  Track& track = state.tracks[index];
  const Sighting& s = state.sightings[index];
  if (!track.isInDoubt) {
    track.recent = {};
    if (s.isWhole) learn(track.look, s.look);
  } else if (!s.isSole) {
    track.recent = {};
  } else if (s.isWhole) {
    learn(track.recent, s.look);
  }
}

}  // namespace rg::objects
