// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/tracking/ownership/parted_tracks.hpp"

#include <algorithm>
#include <cstdlib>

namespace rg::objects {
namespace {

/// Whether a blob is another thing than the one beside it: about as high, and in other columns.
bool standBeside(const Box& mine, const Box& other, const Numbers::Parting& n) {
  const int columns = std::min(mine.right(), other.right()) - std::max(mine.x, other.x);
  return columns < n.besideColumns * std::min(mine.width, other.width) &&
         other.height >= n.besideHeight * mine.height;
}

/// Calls visit(cell, its blob, the owner's blob) for the cells whose owner has most of its cells in
/// another blob, in raster order. It may take the cell from its owner.
template <class Visit>
void forStrayCells(const TrackerState& state, const GroupGrid& e, const Visit& visit) {
  e.forParts(state.owner, [&](const Run& part, uint16_t owner) {
    if (owner == 0) return;
    const uint32_t main = state.blobs.numberOf(owner - 1u);
    const size_t end = e.at(part.end, part.y);
    for (size_t cell = e.at(part.begin, part.y); cell < end; ++cell) {
      const uint32_t blob = state.blobs.at(cell);
      if (blob != 0 && blob != main) visit(cell, blob, main);
    }
  });
}

}  // namespace

void PartedTracks::find(const GroupGrid& e, TrackerState& state) {
  partedFrom_.assign(state.owner.size(), 0);
  if (state.scale.isUniform()) return;
  partBeside(e, state);
  partStacked(e, state);
}

void PartedTracks::giveUp(size_t cell, TrackerState& state) {
  partedFrom_[cell] = state.owner[cell];
  state.owner[cell] = 0;
}

void PartedTracks::partBeside(const GroupGrid& e, TrackerState& state) {
  const Numbers::Parting& n = state.numbers.parting;
  forStrayCells(state, e, [&](size_t cell, uint32_t blob, uint32_t main) {
    const size_t owner = state.owner[cell] - 1u;
    const Piece &mine = state.blobs.piece(main), &other = state.blobs.piece(blob);
    if (areStrangersApart(e, mine.group, other.group)) return giveUp(cell, state);
    if (!standBeside(mine.box, other.box, n)) return;
    state.sightings[owner].isParted = true;
    const Track& track = state.tracks[owner];
    if (!state.isSizeKnown(track) || track.partedNs > n.parted.whole()) giveUp(cell, state);
  });
}

/// Two things above each other were taken for one when they came in: once one has moved against the
/// other by a quarter of a width, it is given up. Parts of a body don't do that.
void PartedTracks::partStacked(const GroupGrid& e, TrackerState& state) {
  majorities_.assign(state.tracks.size(), {});
  const auto forStray = [&](auto&& visit) {
    forStrayCells(state, e, [&](size_t cell, uint32_t blob, uint32_t) {
      visit(majorities_[state.owner[cell] - 1u], blob);
    });
  };
  forStray([](Majority& of, uint32_t blob) { of.propose(blob); });
  forStray([](Majority& of, uint32_t blob) { of.count(blob); });
  const Numbers::Parting& n = state.numbers.parting;
  const Box inside = inflate(boundsOf(e.grid), -1);
  const auto isInside = [&](const Box& box) { return intersect(box, inside) == box; };
  for (size_t t = 0; t < state.tracks.size(); ++t) {
    Track& track = state.tracks[t];
    const Majority& other = majorities_[t];
    const bool isPair = state.blobs.isAlone(t) && 2 * other.votes > other.total &&
                        !state.blobs.isOwned(other.value);
    if (!isPair) track.partOffset = INT32_MIN;
    if (!isPair) continue;
    const Piece &main = state.blobs.of(t), &part = state.blobs.piece(other.value);
    const int least = std::min(main.box.width, part.box.width);
    if (!isInside(main.box) || !isInside(part.box) || part.cells < n.partCells * main.cells)
      continue;
    const int way = 2 * part.box.x + part.box.width - 2 * main.box.x - main.box.width;
    const int offset = (part.box.y < main.box.y ? way : -way) * e.stepPx;
    if (track.partOffset == INT32_MIN) track.partOffset = offset;
    if (std::abs(offset - track.partOffset) <= n.partOffset * (least * e.stepPx)) continue;
    e.forForeground([&](size_t cell, int, int) {
      if (state.owner[cell] == t + 1 && state.blobs.at(cell) == other.value) giveUp(cell, state);
    });
    track.sizeSamples = 0;
    track.portrait.frames = 0;
    track.partOffset = INT32_MIN;
  }
}

}  // namespace rg::objects
