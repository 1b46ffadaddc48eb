// SPDX-License-Identifier: LGPL-2.1-or-later
// Which cells belong to which track, beyond the boxes that were fitted.
#include "core/tracker.hpp"

#include <algorithm>

namespace rg {
namespace {

/// pairs(f) calls f(key, value) for everything that is counted.
template <class Pairs>
void findMajorities(size_t keys, std::vector<Majority>& result, const Pairs& pairs) {
  result.assign(keys, {});
  pairs([&](size_t key, uint32_t value) { result[key].propose(value); });
  pairs([&](size_t key, uint32_t value) { result[key].count(value); });
}

}  // namespace

/// Connected parts of all the foreground, and for each track the one that it has most cells in.
void Tracker::findBlobs(const Evidence& e) {
  noOwner_.assign(e.group.size(), 0);
  findPieces(e, noOwner_, blobScratch_, blobs_);
  blobOf_.assign(tracks_.size(), 0);
  soleTrack_.assign(blobs_.size() + 1, 0);
  blobCells_.assign(blobs_.size() + 1, 0);
  constexpr uint16_t kSeveral = UINT16_MAX;
  for (size_t t = 0; t < tasks_.size(); ++t) {
    const size_t track = taskTrack_[t];
    uint32_t& best = blobOf_[track];
    const Box box = intersect(tasks_[t].fitted, boundsOf(e.grid));
    const auto forMine = [&](auto&& visit) {
      for (int y = box.y; y < box.bottom(); ++y)
        for (int x = box.x; x < box.right(); ++x)
          if (owner_[e.at(x, y)] == track + 1) visit(blobScratch_.label[e.at(x, y)]);
    };
    uint32_t most = 0;
    forMine([&](uint32_t blob) { ++blobCells_[blob]; });
    forMine([&](uint32_t blob) {
      if (blobCells_[blob] > most || (blobCells_[blob] == most && blob < best)) {
        most = blobCells_[blob];
        best = blob;
      }
    });
    forMine([&](uint32_t blob) { blobCells_[blob] = 0; });
    if (best == 0) continue;
    uint16_t& sole = soleTrack_[best];
    sole = sole == 0 ? static_cast<uint16_t>(track + 1) : kSeveral;
  }
  for (uint16_t& sole : soleTrack_)
    if (sole == kSeveral) sole = 0;
}

/// As long as sizes are not known one blob is one object: it has all of it, and nothing of another
/// blob that stands beside it and is about as high.
void Tracker::giveBlobs(const Evidence& e) {
  for (size_t cell = 0; cell < owner_.size(); ++cell) {
    const uint32_t blob = blobScratch_.label[cell];
    if (blob == 0) continue;
    const uint16_t sole = soleTrack_[blob], owner = owner_[cell];
    if (owner == 0) {
      if (sole != 0 && e.group[cell] != 0 && !isSizeKnown(tracks_[sole - 1u])) owner_[cell] = sole;
      continue;
    }
    const uint32_t main = blobOf_[owner - 1u];
    if (main == blob || isSizeKnown(tracks_[owner - 1u])) continue;
    const Box &mine = blobs_[main - 1].box, &other = blobs_[blob - 1].box;
    const int columns = std::min(mine.right(), other.right()) - std::max(mine.x, other.x);
    if (2 * columns < std::min(mine.width, other.width) && 2 * other.height >= mine.height)
      owner_[cell] = 0;
  }
}

/// What sticks out of a fitted box (an arm, a long stride) goes with its group, when most of the
/// group belongs to one track. The groups of which a track has most are what is seen of it.
void Tracker::giveGroups(const Evidence& e, std::span<const Group> groups) {
  const auto vote = [&](auto&& count) {
    for (size_t cell = 0; cell < owner_.size(); ++cell)
      if (owner_[cell] != 0) count(e.group[cell] - 1u, owner_[cell]);
  };
  findMajorities(groups.size(), majorities_, vote);
  for (size_t t = 0; t < tasks_.size(); ++t) {
    const auto mine = static_cast<uint16_t>(taskTrack_[t] + 1);
    const Box& fitted = tasks_[t].fitted;
    const int side = std::max(1, fitted.width / 3), above = std::max(1, fitted.height / 6);
    const Box near = intersect(
        {fitted.x - side, fitted.y - above, fitted.width + 2 * side, fitted.height + 2 * above},
        boundsOf(e.grid));
    for (int y = near.y; y < near.bottom(); ++y)
      for (int x = near.x; x < near.right(); ++x) {
        const size_t cell = e.at(x, y);
        if (e.group[cell] == 0 || owner_[cell] != 0) continue;
        const Majority& group = majorities_[e.group[cell] - 1u];
        if (group.value == mine && 2 * group.votes >= e.cellsOf[e.group[cell] - 1u])
          owner_[cell] = mine;
      }
  }
  for (size_t g = 0; g < groups.size(); ++g) {
    if (5 * majorities_[g].votes < 3 * e.cellsOf[g] || majorities_[g].votes == 0) continue;
    Sighting& s = sightings_[majorities_[g].value - 1u];
    s.box = unite(s.box, groups[g].box);
  }
}

}  // namespace rg
