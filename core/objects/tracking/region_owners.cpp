// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/tracking/region_owners.hpp"

#include <algorithm>
#include <numeric>

namespace rg::objects {
namespace {

/// Afterwards those of track t are parts[firstPart[t]] … parts[firstPart[t + 1] − 1].
void listParts(const GroupGrid& grid, std::span<const uint16_t> owner, size_t tracks,
               RegionOwnerScratch& s) {
  s.firstPart.assign(tracks + 2, 0);
  grid.forParts(owner, [&](const Run&, uint16_t track) {
    if (track != 0) ++s.firstPart[track + 1u];
  });
  std::partial_sum(s.firstPart.begin(), s.firstPart.end(), s.firstPart.begin());
  s.parts.resize(s.firstPart.back());
  grid.forParts(owner, [&](const Run& part, uint16_t track) {
    if (track != 0) s.parts[s.firstPart[track]++] = part;
  });
}

/// Calls visit(label, times) for what the middles of some cells show when they are shifted.
template <class Visit>
void forLabels(const segmentation::Labels& labels, const GroupGrid& grid, const Run& cells,
               Point shift, const Visit& visit) {
  const int y = grid.middleOf(0, cells.y).y + shift.y;
  if (y < 0 || y >= labels.ids.height()) return;
  const uint16_t* row = labels.ids.row(y);
  const auto width = static_cast<uint32_t>(labels.ids.width());
  const int end = grid.middleOf(cells.end - 1, 0).x + shift.x;  // The last one may be cut off.
  uint16_t last = segmentation::kNoRegion;
  uint32_t times = 0;
  int middle = grid.middleOf(cells.begin, 0).x + shift.x;
  for (int cell = cells.begin; cell < cells.end; ++cell, middle += grid.stepPx) {
    const auto x = static_cast<uint32_t>(std::min(middle, end));  // Large where it is negative.
    const uint16_t label = x < width ? row[x] : segmentation::kNoRegion;
    if (label != last) {
      if (last != segmentation::kNoRegion) visit(last, times);
      last = label;
      times = 0;
    }
    ++times;
  }
  if (last != segmentation::kNoRegion) visit(last, times);
}

}  // namespace

void findRegionOwners(const segmentation::Labels& labels, const GroupGrid& grid,
                      std::span<const uint16_t> owner, std::span<const Point> shifts,
                      RegionOwnerScratch& s, std::vector<TrackIndex>& ownerOf) {
  listParts(grid, owner, shifts.size(), s);
  s.votes.assign(ownerOf.size(), 0);
  s.mostVotes.assign(ownerOf.size(), 0);
  std::fill(ownerOf.begin(), ownerOf.end(), TrackIndex());
  for (size_t t = 0; t < shifts.size(); ++t) {
    s.seen.clear();
    for (uint32_t i = s.firstPart[t]; i < s.firstPart[t + 1]; ++i)
      forLabels(labels, grid, s.parts[i], shifts[t], [&](uint16_t label, uint32_t times) {
        if (s.votes[label - 1u] == 0) s.seen.push_back(label - 1u);
        s.votes[label - 1u] += times;
      });
    for (const uint32_t region : s.seen) {
      if (s.votes[region] > s.mostVotes[region]) {
        s.mostVotes[region] = s.votes[region];
        ownerOf[region] = TrackIndex::ofIndex(t);
      }
      s.votes[region] = 0;
    }
  }
}

}  // namespace rg::objects
