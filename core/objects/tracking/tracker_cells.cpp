// SPDX-License-Identifier: LGPL-2.1-or-later
// Which cells belong to which track, beyond the boxes that were fitted.
#include "core/objects/tracking/tracker.hpp"

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

}  // namespace

/// Connected parts of all the foreground.
void Tracker::findBlobs(const GroupGrid& e) {
  findPieces(e, {}, blobScratch_, blobs_);
  if (!scale_.isUniform()) cutPieces(e, blobScratch_, blobs_);
  findOwnBlobs(e);
}

/// For each track the blob that it has most cells in.
void Tracker::findOwnBlobs(const GroupGrid& e) {
  blobOf_.assign(tracks_.size(), 0);
  soleTrack_.assign(blobs_.size() + 1, 0);
  blobCells_.assign(blobs_.size() + 1, 0);
  constexpr uint16_t kSeveral = UINT16_MAX;
  for (size_t t = 0; t < tasks_.size(); ++t) {
    const size_t track = tasks_[t].trackIndex();
    uint32_t& best = blobOf_[track];
    const Box box = intersect(tasks_[t].fitted, boundsOf(e.grid));
    uint32_t most = 0;
    seenBlobs_.clear();
    for (int y = box.y; y < box.bottom(); ++y)
      for (size_t cell = e.at(box.x, y), end = cell + static_cast<size_t>(box.width); cell < end;
           ++cell)
        if (owner_[cell] == track + 1 && blobCells_[blobScratch_.label[cell]]++ == 0)
          seenBlobs_.push_back(blobScratch_.label[cell]);
    for (const uint32_t blob : seenBlobs_) {
      if (blobCells_[blob] > most || (blobCells_[blob] == most && blob < best)) {
        most = blobCells_[blob];
        best = blob;
      }
      blobCells_[blob] = 0;
    }
    if (best == 0) continue;
    uint16_t& sole = soleTrack_[best];
    sole = sole == 0 ? static_cast<uint16_t>(track + 1) : kSeveral;
  }
  for (uint16_t& sole : soleTrack_)
    if (sole == kSeveral) sole = 0;
}

/// Calls visit(cell, its blob, the owner's blob) for the cells whose owner has most of its cells in
/// another blob, in raster order. It may take the cell from its owner.
template <class Visit>
void Tracker::forStrayCells(const GroupGrid& e, const Visit& visit) const {
  e.forParts(owner_, [&](const Run& part, uint16_t owner) {
    if (owner == 0) return;
    const uint32_t main = blobOf_[owner - 1u];
    const size_t end = e.at(part.end, part.y);
    for (size_t cell = e.at(part.begin, part.y); cell < end; ++cell) {
      const uint32_t blob = blobScratch_.label[cell];
      if (blob != 0 && blob != main) visit(cell, blob, main);
    }
  });
}

/// As long as the scene doesn't say how large things are, one blob is one object: whoever is in it
/// shares all of it, each the cells that are nearest, and has nothing of another blob that stands
/// beside it and is about as high.
void Tracker::giveBlobs(const GroupGrid& e) {
  if (scale_.isUniform()) return;
  forStrayCells(e, [&](size_t cell, uint32_t blob, uint32_t main) {
    const uint16_t owner = owner_[cell];
    const Box &mine = blobs_[main - 1].box, &other = blobs_[blob - 1].box;
    if (areStrangersApart(e, blobs_[main - 1].group, blobs_[blob - 1].group)) {
      owner_[cell] = 0;
      return;
    }
    if (!standBeside(mine, other, numbers_.cells)) return;
    sightings_[owner - 1u].isParted = true;
    const Track& track = tracks_[owner - 1u];
    if (!isSizeKnown(track) || track.partedNs > numbers_.cells.parted.whole()) owner_[cell] = 0;
  });
  partTracks(e);
  limitTracks(e);
  reclaimExpected(e);
  spreadOwners(e);
}

/// Two things above each other were taken for one when they came in: once one has moved against the
/// other by a quarter of a width, it is given up. Parts of a body don't do that.
void Tracker::partTracks(const GroupGrid& e) {
  findMajorities(tracks_.size(), majorities_, [&](auto&& count) {
    forStrayCells(
        e, [&](size_t cell, uint32_t blob, uint32_t) { count(owner_[cell] - 1u, blob, 1u); });
  });
  const Numbers::Cells& n = numbers_.cells;
  const Box inside = inflate(boundsOf(e.grid), -1);
  const auto isInside = [&](const Box& box) { return intersect(box, inside) == box; };
  for (size_t t = 0; t < tracks_.size(); ++t) {
    Track& track = tracks_[t];
    const Majority& other = majorities_[t];
    const bool isPair = blobOf_[t] != 0 && soleTrack_[blobOf_[t]] == t + 1 &&
                        2 * other.votes > other.total &&
                        std::count(blobOf_.begin(), blobOf_.end(), other.value) == 0;
    if (!isPair) track.partOffset = INT32_MIN;
    if (!isPair) continue;
    const Piece &main = blobs_[blobOf_[t] - 1], &part = blobs_[other.value - 1];
    const int least = std::min(main.box.width, part.box.width);
    if (!isInside(main.box) || !isInside(part.box) || part.cells < n.partCells * main.cells)
      continue;
    const int way = 2 * part.box.x + part.box.width - 2 * main.box.x - main.box.width;
    const int offset = (part.box.y < main.box.y ? way : -way) * e.stepPx;
    if (track.partOffset == INT32_MIN) track.partOffset = offset;
    if (std::abs(offset - track.partOffset) <= n.partOffset * (least * e.stepPx)) continue;
    e.forForeground([&](size_t cell, int, int) {
      if (owner_[cell] == t + 1 && blobScratch_.label[cell] == other.value) owner_[cell] = 0;
    });
    track.sizeSamples = 0;
    track.portrait.frames = 0;
    track.partOffset = INT32_MIN;
  }
}

/// A track of known size ends a little way beyond its box.
void Tracker::limitTracks(const GroupGrid& e) {
  limits_.assign(tracks_.size(), boundsOf(e.grid));
  for (size_t t = 0; t < tasks_.size(); ++t) {
    const Box& box = tasks_[t].fitted;
    if (isSizeKnown(tracks_[tasks_[t].trackIndex()]))
      limits_[tasks_[t].trackIndex()] = inflate(
          box,
          std::max(2, static_cast<int>(numbers_.cells.limit.of(std::min(box.width, box.height)))));
  }
}

/// Cells go to whom their region is predicted to be, unless a portrait told whose they are.
void Tracker::reclaimExpected(const GroupGrid& e) {
  e.forParts(e.expected, [&](const Run& part, uint16_t expected) {
    if (expected == 0) return;
    const Box& limits = limits_[expected - 1u];
    const Box cells = intersect({part.begin, part.y, part.end - part.begin, 1}, limits);
    for (size_t cell = e.at(cells.x, part.y), end = cell + static_cast<size_t>(cells.width);
         cell < end; ++cell) {
      const bool isTold = owner_[cell] != 0 && sightings_[owner_[cell] - 1u].isMatched;
      if (!isTold && blobScratch_.label[cell] == blobOf_[expected - 1u]) owner_[cell] = expected;
    }
  });
}

/// Two passes over the grid, each handing owners on with a distance of 3 straight and 4 diagonally.
void Tracker::spreadOwners(const GroupGrid& e) {
  constexpr uint16_t kFar = UINT16_MAX;
  distance_.resize(owner_.size());
  bool isComplete = true;
  e.forParts(owner_, [&](const Run& part, uint16_t owner) {
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
      if (blobScratch_.label[other] != blobScratch_.label[cell]) continue;
      const uint32_t far = distance_[other] + (d.x != 0 && d.y != 0 ? 4u : 3u);
      if (far >= distance_[cell] || !limits_[owner_[other] - 1u].contains({x, y})) continue;
      distance_[cell] = static_cast<uint16_t>(far);
      owner_[cell] = owner_[other];
    }
  };
  e.forForeground([&](size_t, int x, int y) { take(1, x, y); });
  for (auto run = e.runs.rbegin(); run != e.runs.rend(); ++run)
    for (int x = run->end; x-- > run->begin;) take(-1, x, run->y);
}

/// What sticks out of a fitted box (an arm, a long stride) goes with its group, when most of the
/// group belongs to one track.
void Tracker::giveStrides(const GroupGrid& e) {
  const Numbers::Cells& n = numbers_.cells;
  for (size_t t = 0; t < tasks_.size(); ++t) {
    const auto mine = tasks_[t].track;
    const Box& fitted = tasks_[t].fitted;
    const int side = std::max(1, static_cast<int>(n.strideSide.of(fitted.width)));
    const int above = std::max(1, static_cast<int>(n.strideAbove.of(fitted.height)));
    const Box near = intersect(
        {fitted.x - side, fitted.y - above, fitted.width + 2 * side, fitted.height + 2 * above},
        boundsOf(e.grid));
    for (int y = near.y; y < near.bottom(); ++y)
      for (int x = near.x; x < near.right(); ++x) {
        const size_t cell = e.at(x, y);
        if (e.group[cell] == 0 || owner_[cell] != 0) continue;
        const Majority& group = majorities_[e.group[cell] - 1u];
        if (group.value == mine && group.votes >= n.groupShare * e.cellsOf[e.group[cell] - 1u])
          owner_[cell] = mine;
      }
  }
}

/// The groups of which a track has most are what is seen of it, once it has what sticks out of it.
void Tracker::giveGroups(const GroupGrid& e, std::span<const Group> groups) {
  const auto vote = [&](auto&& count) {
    e.forParts(owner_, [&](const Run& part, uint16_t owner) {
      if (owner == 0) return;
      count(e.group[e.at(part.begin, part.y)] - 1u, owner, uint32_t{part.end} - part.begin);
    });
  };
  findMajorities(groups.size(), majorities_, vote);
  giveStrides(e);
  const Numbers::Cells& n = numbers_.cells;
  // Where sizes say nothing, a group of several is shared cell by cell.
  const auto isOwned = [&](size_t g) {
    const uint32_t votes = majorities_[g].votes, cells = e.cellsOf[g];
    return votes > 0 && votes >= (scale_.isUniform() ? n.uniformShare : n.loneShare) * cells;
  };
  if (!scale_.isUniform())
    e.forParts(owner_, [&](const Run& part, uint16_t owner) {
      if (owner == 0 || isOwned(e.group[e.at(part.begin, part.y)] - 1u)) return;
      Sighting& s = sightings_[owner - 1u];
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
    Sighting& s = sightings_[majorities_[g].value - 1u];
    s.box = unite(s.box, groups[g].box);
    s.areaPx += groups[g].areaPx;
    s.sumX += groups[g].sumX;
    s.sumY += groups[g].sumY;
  }
}

}  // namespace rg::objects
