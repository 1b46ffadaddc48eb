// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/region_owners.hpp"

#include <algorithm>
#include <numeric>

namespace rg {
namespace {

/// Afterwards those of track t are cells[firstCell[t]] … cells[firstCell[t + 1] − 1].
void listCells(const Evidence& grid, std::span<const uint16_t> owner, size_t tracks,
               RegionOwnerScratch& s) {
  s.firstCell.assign(tracks + 2, 0);
  grid.forForeground([&](size_t cell, int, int) {
    if (const uint16_t track = owner[cell]; track != 0) ++s.firstCell[track + 1u];
  });
  std::partial_sum(s.firstCell.begin(), s.firstCell.end(), s.firstCell.begin());
  s.cells.resize(s.firstCell.back());
  grid.forForeground([&](size_t cell, int x, int y) {
    if (const uint16_t track = owner[cell]; track != 0)
      s.cells[s.firstCell[track]++] = grid.middleOf(x, y);
  });
}

uint16_t labelAt(const Labels& labels, Point p) {
  return boundsOf(labels.ids.size()).contains(p) ? labels.ids.at(p.x, p.y) : kNoRegion;
}

}  // namespace

void findRegionOwners(const Labels& labels, const Evidence& grid, std::span<const uint16_t> owner,
                      std::span<const Point> shifts, RegionOwnerScratch& s,
                      std::vector<uint32_t>& ownerOf) {
  listCells(grid, owner, shifts.size(), s);
  s.votes.assign(ownerOf.size(), 0);
  s.mostVotes.assign(ownerOf.size(), 0);
  std::fill(ownerOf.begin(), ownerOf.end(), 0u);
  for (size_t t = 0; t < shifts.size(); ++t) {
    const auto forRegions = [&](auto&& visit) {
      for (uint32_t i = s.firstCell[t]; i < s.firstCell[t + 1]; ++i)
        if (const uint16_t label =
                labelAt(labels, {s.cells[i].x + shifts[t].x, s.cells[i].y + shifts[t].y}))
          visit(label - 1u);
    };
    forRegions([&](uint32_t region) { ++s.votes[region]; });
    forRegions([&](uint32_t region) {
      if (s.votes[region] > s.mostVotes[region]) {
        s.mostVotes[region] = s.votes[region];
        ownerOf[region] = static_cast<uint32_t>(t + 1);
      }
      s.votes[region] = 0;
    });
  }
}

}  // namespace rg
