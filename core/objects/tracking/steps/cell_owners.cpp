// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/tracking/steps/cell_owners.hpp"

#include <algorithm>

namespace rg::objects {
namespace {

/// pairs(f) calls f(key, value, times) for everything that is counted.
template <class Pairs>
void findMajorities(size_t keys, std::vector<Majority>& result, const Pairs& pairs) {
  result.assign(keys, {});
  pairs([&](size_t key, uint32_t value, uint32_t times) { result[key].propose(value, times); });
  pairs([&](size_t key, uint32_t value, uint32_t times) { result[key].count(value, times); });
}

/// Whether a blob is another thing than the one beside it: about as high, and in other columns.
bool standBeside(const Box& mine, const Box& other, const Numbers::Cells& n) {
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

void CellOwners::shareBlobs(const GroupGrid& e, TrackerState& state) {
  if (state.scale.isUniform()) return;
  forStrayCells(state, e, [&](size_t cell, uint32_t blob, uint32_t main) {
    const uint16_t owner = state.owner[cell];
    const Piece &mine = state.blobs.piece(main), &other = state.blobs.piece(blob);
    if (areStrangersApart(e, mine.group, other.group)) {
      state.owner[cell] = 0;
      return;
    }
    if (!standBeside(mine.box, other.box, state.numbers.cells)) return;
    state.sightings[owner - 1u].isParted = true;
    const Track& track = state.tracks[owner - 1u];
    if (!state.isSizeKnown(track) || track.partedNs > state.numbers.cells.parted.whole())
      state.owner[cell] = 0;
  });
  partTracks(e, state);
  limitTracks(e, state);
  reclaimExpected(e, state);
  spreadOwners(e, state);
}

/// Two things above each other were taken for one when they came in: once one has moved against the
/// other by a quarter of a width, it is given up. Parts of a body don't do that.
void CellOwners::partTracks(const GroupGrid& e, TrackerState& state) {
  findMajorities(state.tracks.size(), majorities_, [&](auto&& count) {
    forStrayCells(state, e, [&](size_t cell, uint32_t blob, uint32_t) {
      count(state.owner[cell] - 1u, blob, 1u);
    });
  });
  const Numbers::Cells& n = state.numbers.cells;
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
      if (state.owner[cell] == t + 1 && state.blobs.at(cell) == other.value) state.owner[cell] = 0;
    });
    track.sizeSamples = 0;
    track.portrait.frames = 0;
    track.partOffset = INT32_MIN;
  }
}

/// A track of known size ends a little way beyond its box.
void CellOwners::limitTracks(const GroupGrid& e, const TrackerState& state) {
  limits_.assign(state.tracks.size(), boundsOf(e.grid));
  for (size_t t = 0; t < state.tasks.size(); ++t) {
    const Box& box = state.tasks[t].fitted;
    if (state.isSizeKnown(state.tracks[state.tasks[t].trackIndex()]))
      limits_[state.tasks[t].trackIndex()] = inflate(
          box, std::max(2, static_cast<int>(
                               state.numbers.cells.limit.of(std::min(box.width, box.height)))));
  }
}

/// Cells go to whom their region is predicted to be, unless a portrait told whose they are.
void CellOwners::reclaimExpected(const GroupGrid& e, TrackerState& state) const {
  e.forParts(e.expected, [&](const Run& part, uint16_t expected) {
    if (expected == 0) return;
    const Box& limits = limits_[expected - 1u];
    const Box cells = intersect({part.begin, part.y, part.end - part.begin, 1}, limits);
    for (size_t cell = e.at(cells.x, part.y), end = cell + static_cast<size_t>(cells.width);
         cell < end; ++cell) {
      const bool isTold =
          state.owner[cell] != 0 && state.sightings[state.owner[cell] - 1u].isMatched;
      if (!isTold && state.blobs.at(cell) == state.blobs.numberOf(expected - 1u))
        state.owner[cell] = expected;
    }
  });
}

/// Two passes over the grid, each handing owners on with a distance of 3 straight and 4 diagonally.
void CellOwners::spreadOwners(const GroupGrid& e, TrackerState& state) {
  constexpr uint16_t kFar = UINT16_MAX;
  distance_.resize(state.owner.size());
  bool isComplete = true;
  e.forParts(state.owner, [&](const Run& part, uint16_t owner) {
    std::fill_n(distance_.data() + e.at(part.begin, part.y), part.end - part.begin,
                owner != 0 ? uint16_t{0} : kFar);
    isComplete = isComplete && owner != 0;
  });
  if (isComplete) return;
  const auto take = [&](int direction, int x, int y) {
    const size_t cell = e.at(x, y);
    if (distance_[cell] == 0) return;
    const Point sources[] = {{-direction, 0}, {-1, -direction}, {0, -direction}, {1, -direction}};
    for (const Point& d : sources) {
      if (!boundsOf(e.grid).contains({x + d.x, y + d.y})) continue;
      const size_t other = e.at(x + d.x, y + d.y);
      if (state.blobs.at(other) != state.blobs.at(cell)) continue;
      const uint32_t far = distance_[other] + (d.x != 0 && d.y != 0 ? 4u : 3u);
      if (far >= distance_[cell] || !limits_[state.owner[other] - 1u].contains({x, y})) continue;
      distance_[cell] = static_cast<uint16_t>(far);
      state.owner[cell] = state.owner[other];
    }
  };
  e.forForeground([&](size_t, int x, int y) { take(1, x, y); });
  for (auto run = e.runs.rbegin(); run != e.runs.rend(); ++run)
    for (int x = run->end; x-- > run->begin;) take(-1, x, run->y);
}

/// What sticks out of a fitted box (an arm, a long stride) goes with its group, when most of the
/// group belongs to one track.
void CellOwners::giveStrides(const GroupGrid& e, TrackerState& state) const {
  const Numbers::Cells& n = state.numbers.cells;
  for (size_t t = 0; t < state.tasks.size(); ++t) {
    const auto mine = state.tasks[t].track;
    const Box& fitted = state.tasks[t].fitted;
    const int side = std::max(1, static_cast<int>(n.strideSide.of(fitted.width)));
    const int above = std::max(1, static_cast<int>(n.strideAbove.of(fitted.height)));
    const Box near = intersect(
        {fitted.x - side, fitted.y - above, fitted.width + 2 * side, fitted.height + 2 * above},
        boundsOf(e.grid));
    for (int y = near.y; y < near.bottom(); ++y)
      for (int x = near.x; x < near.right(); ++x) {
        const size_t cell = e.at(x, y);
        if (e.group[cell] == 0 || state.owner[cell] != 0) continue;
        const Majority& group = majorities_[e.group[cell] - 1u];
        if (group.value == mine && group.votes >= n.groupShare * e.cellsOf[e.group[cell] - 1u])
          state.owner[cell] = mine;
      }
  }
}

void CellOwners::giveGroups(const GroupGrid& e, std::span<const Group> groups,
                            TrackerState& state) {
  const auto vote = [&](auto&& count) {
    e.forParts(state.owner, [&](const Run& part, uint16_t owner) {
      if (owner == 0) return;
      count(e.group[e.at(part.begin, part.y)] - 1u, owner, uint32_t{part.end} - part.begin);
    });
  };
  findMajorities(groups.size(), majorities_, vote);
  giveStrides(e, state);
  const Numbers::Cells& n = state.numbers.cells;
  // Where sizes say nothing, a group of several is shared cell by cell.
  const auto isOwned = [&](size_t g) {
    const uint32_t votes = majorities_[g].votes, cells = e.cellsOf[g];
    return votes > 0 && votes >= (state.scale.isUniform() ? n.uniformShare : n.loneShare) * cells;
  };
  if (!state.scale.isUniform())
    e.forParts(state.owner, [&](const Run& part, uint16_t owner) {
      if (owner == 0 || isOwned(e.group[e.at(part.begin, part.y)] - 1u)) return;
      Sighting& s = state.sightings[owner - 1u];
      const Box box = intersect(
          {part.begin * e.stepPx, part.y * e.stepPx, (part.end - part.begin) * e.stepPx, e.stepPx},
          boundsOf(e.frame));
      s.box = unite(s.box, box);
      s.areaPx += static_cast<uint64_t>(box.area());
      s.sumX += box.area() * (2 * box.x + box.width - 1) * 128;
      s.sumY += box.area() * (2 * box.y + box.height - 1) * 128;
    });
  for (size_t g = 0; g < groups.size(); ++g) {
    if (!isOwned(g)) continue;
    Sighting& s = state.sightings[majorities_[g].value - 1u];
    s.box = unite(s.box, groups[g].box);
    s.areaPx += groups[g].areaPx;
    s.sumX += groups[g].sumX;
    s.sumY += groups[g].sumY;
  }
}

}  // namespace rg::objects
