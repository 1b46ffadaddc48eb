// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/tracking/ownership/parted_tracks.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace rg::objects {
namespace {

/// Calls visit(blob, owner) for the cells in another blob than most of their owner's.
template <class Visit>
void forStrayCells(const TrackerState& state, const GroupGrid& e, const Visit& visit) {
  e.forParts(state.owner, [&](const Run& part, uint16_t owner) {
    if (owner == 0) return;
    const uint32_t main = state.blobs.numberOf(owner - 1u);
    const size_t end = e.at(part.end, part.y);
    for (size_t cell = e.at(part.begin, part.y); cell < end; ++cell)
      if (const uint32_t blob = state.blobs.at(cell); blob != 0 && blob != main)
        visit(blob, owner - 1u);
  });
}

/// The middle of the gap between two that lie beside each other, in half pixels; INT32_MIN where
/// they don't, or where the camera moves what could hide the middle of a thing.
int gapBetween(const Box& a, const Box& b, const GroupGrid& e) {
  const int begin = std::min(a.right(), b.right()), end = std::max(a.x, b.x);
  return begin < end && !e.showsMovers ? (begin + end) * e.stepPx : INT32_MIN;
}

}  // namespace

void PartedTracks::find(const GroupGrid& e, TrackerState& state) {
  partedFrom_.assign(state.owner.size(), 0);
  if (state.scale.isUniform()) return;
  majorities_.assign(state.tracks.size(), {});
  forStrayCells(state, e, [&](uint32_t blob, size_t owner) { majorities_[owner].propose(blob); });
  forStrayCells(state, e, [&](uint32_t blob, size_t owner) { majorities_[owner].count(blob); });
  const Numbers::Parting& n = state.numbers.parting;
  const Box inside = inflate(boundsOf(e.grid), -1);
  const auto isInside = [&](const Box& box) { return intersect(box, inside) == box; };
  for (size_t t = 0; t < state.tracks.size(); ++t) {
    Track& track = state.tracks[t];
    const Majority& other = majorities_[t];
    const bool isPair = state.crowds.isAlone(t) && 2 * other.votes > other.total &&
                        !state.blobs.isOwned(other.value);
    if (!isPair) {
      track.partOffset = track.partGap = INT32_MIN;
      continue;
    }
    const Piece &main = state.blobs.of(t), &part = state.blobs.piece(other.value);
    const int least = std::min(main.box.width, part.box.width);
    if (!isInside(main.box) || !isInside(part.box) || part.cells < n.partCells * main.cells)
      continue;
    const int way = 2 * part.box.x + part.box.width - 2 * main.box.x - main.box.width;
    const int offset = (part.box.y < main.box.y ? way : -way) * e.stepPx;
    if (track.partOffset == INT32_MIN) track.partOffset = offset;
    const int gap = gapBetween(main.box, part.box, e);
    if (track.partGap == INT32_MIN) track.partGap = gap;
    const auto hasMoved = [&](int from, int to) {
      return std::abs(to - from) > n.partOffset * (least * e.stepPx);
    };
    if (!hasMoved(track.partOffset, offset) && (gap == INT32_MIN || !hasMoved(track.partGap, gap)))
      continue;
    e.forForeground([&](size_t cell, int, int) {
      if (state.owner[cell] == t + 1 && state.blobs.at(cell) == other.value)
        partedFrom_[cell] = std::exchange(state.owner[cell], uint16_t{0});
    });
    track.sizeSamples = 0;
    track.portrait.frames = 0;
    track.partOffset = track.partGap = INT32_MIN;
  }
}

}  // namespace rg::objects
