// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/tracking/steps/sightings.hpp"

#include <algorithm>
#include <cstdlib>

namespace rg::objects {
namespace {

constexpr int kUnit = kPositionUnit;

/// Whether a box is about of a size; legs and arms change a width more than anything a height.
bool isLike(const Box& box, const Extent& size, const Numbers::Place& n) {
  return std::abs(int64_t{box.height} * kUnit - size.height) <= n.offHeight * size.height &&
         std::abs(int64_t{box.width} * kUnit - size.width) <= n.offWidth * size.width;
}

/// Whether a box lacks an end of what is expected there.
bool isCutAtOneEnd(const Track& track, const Box& box, bool isRigid, const Numbers::Place& n) {
  const int64_t width = track.size.width;
  const int64_t atLeft = std::abs(int64_t{box.x} * kUnit - (track.x - width / 2));
  const int64_t atRight = std::abs(int64_t{box.right()} * kUnit - (track.x + width / 2));
  return int64_t{box.width} * kUnit < (isRigid ? n.cutRigid : n.cutOther) * width &&
         std::min(atLeft, atRight) <= n.cutOneEnd * std::max(atLeft, atRight);
}

/// By how much the opposite edge has come nearer since this one stands.
int closedIn(StandingEdge& edge, int place, int opposite) {
  if (std::abs(place - edge.place) > 1) edge = {place, opposite};
  return std::abs(place - edge.opposite) - std::abs(place - opposite);
}

/// Whether the others in its crowd were told by their portraits: what they leave is its own.
bool hasTheRest(size_t index, const TrackerState& state) {
  for (size_t i = 0; i < state.sightings.size(); ++i)
    if (i != index && state.crowds.areTogether(i, index) && !state.sightings[i].isMatched)
      return false;
  return state.blobs.has(index);
}

/// Whether one end of what is seen stands while the other comes nearer: something stands before it.
bool goesBehind(Track& track, const Box& box, const TrackerState& state) {
  const int fromLeft = closedIn(track.rightEdge, box.right(), box.x);
  const int fromRight = closedIn(track.leftEdge, box.x, box.right());
  const Numbers::Sizes& n = state.numbers.sizes;
  return std::max(fromLeft, fromRight) >= std::max(n.closingPx.whole(), n.closing.of(box.width));
}

}  // namespace

void countCells(const GroupGrid& e, TrackerState& state) {
  for (size_t i = 0; i < state.tracks.size(); ++i) {
    Sighting& s = state.sightings[i];
    if (s.task < 0) continue;
    const Box& fitted = state.tasks[static_cast<size_t>(s.task)].fitted;
    const Box box = intersect(fitted, boundsOf(e.grid));
    s.boxCells = static_cast<uint32_t>(box.area());
    for (int y = box.y; y < box.bottom(); ++y) {
      auto& bins = s.look.bins[static_cast<size_t>((y - fitted.y) * kBodyBands / fitted.height)];
      const uint16_t* owner = state.owner.data() + e.at(box.x, y);
      const uint8_t* bin = e.bin.data() + e.at(box.x, y);
      for (int x = 0; x < box.width; ++x) {
        const bool isMine = owner[x] == i + 1;
        s.cells += isMine;
        s.othersCells += !isMine && owner[x] != 0;
        if (isMine) ++bins[bin[x]];
      }
    }
  }
}

void sight(const GroupGrid& e, TrackerState& state) {
  const Numbers::Place& n = state.numbers.place;
  for (size_t i = 0; i < state.tracks.size(); ++i) {
    Sighting& s = state.sightings[i];
    if (s.task < 0) continue;
    const Track& track = state.tracks[i];
    const bool isSole = state.crowds.isAlone(i);
    const bool isUsual = isLike(s.box, track.size, n) ||
                         (isSole && isLike(s.box, state.scale.at(s.box.bottom()), n)) ||
                         (!state.isSizeKnown(track) && (isSole || hasTheRest(i, state)));
    s.isSole = isSole;
    s.isStanding = state.blobs.has(i) && e.isStill[state.blobs.of(i).group - 1u] != 0;
    // People's strides, of which a uniform scene is full, are no reason to distrust a box.
    s.isCutOff = isSole && !state.scale.isUniform() && state.isSizeKnown(track) &&
                 isCutAtOneEnd(track, s.box, state.isRigid(track), n);
    const bool isClosing = isSole && goesBehind(state.tracks[i], s.box, state);
    if (isClosing && state.isRigid(track)) s.isCutOff = true;
    const bool isAllThere =
        isSole && state.isAbout(s.box, track) && s.share >= n.allThere * track.portrait.usual;
    s.isWhole = (!s.isMatched || isAllThere) && !s.box.isEmpty() && isUsual && !s.isCutOff &&
                s.othersCells < n.othersShare * s.boxCells;
  }
}

}  // namespace rg::objects
