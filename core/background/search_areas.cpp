// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/search_areas.hpp"

#include "core/base/pixel.hpp"

#include <algorithm>

namespace rg::background {
namespace {

constexpr int kCentroidUnit = 16;
constexpr int kMostStepShare = 8;  ///< No step is longer than this share of the frame's side.

void addRun(const CellSearch& search, const ComponentRun& run, PartSums& sums) {
  for (int x = run.begin; x < run.end; ++x) {
    const auto found = static_cast<uint64_t>(search.found(x, run.y));
    sums.found += found;
    sums.moved += static_cast<uint64_t>(search.moved(x, run.y));
    sums.x += found * static_cast<uint64_t>(kCentroidUnit * kCellPx * x);
    sums.y += found * static_cast<uint64_t>(kCentroidUnit * kCellPx * run.y);
  }
}

/// The area whose search box has most in common with the part's box.
const SearchArea* areaOf(const Box& part, const std::vector<SearchArea>& before) {
  const SearchArea* best = nullptr;
  int64_t most = 0;
  for (const SearchArea& area : before) {
    const int64_t common = intersect(part, searchBox(area)).area();
    if (common <= most) continue;
    most = common;
    best = &area;
  }
  return best;
}

/// Less than a 64th of its pixels, or than a cell needs, is noise.
bool hasMoved(const SearchArea& area) {
  return area.movedPx >= std::max<uint32_t>(kLeastOccupied, area.foundPx / 64);
}

bool isFar(Point a, Point b) {
  constexpr int kReach = 2 * kCellPx * kCentroidUnit;
  return std::max(absDiff(a.x, b.x), absDiff(a.y, b.y)) >= kReach;
}

int stepOf(int moved, int stepBefore, int side) {
  const int step = (moved + kCentroidUnit - 1) / kCentroidUnit;
  return std::min(std::max(step, stepBefore * 3 / 4), side / kMostStepShare);
}

}  // namespace

Box searchBox(const SearchArea& area) {
  const int x = area.step.x + kCellPx, y = area.step.y + kCellPx;
  return {area.box.x - x, area.box.y - y, area.box.width + 2 * x, area.box.height + 2 * y};
}

void followAreas(const CellSearch& search, const std::vector<SearchArea>& before, Size frame,
                 std::vector<PartSums>& sums, std::vector<SearchArea>& areas) {
  const Components& parts = search.parts();
  sums.assign(parts.list.size(), {});
  for (const ComponentRun& run : parts.runs) addRun(search, run, sums[run.component]);
  areas.assign(parts.list.size(), {});
  for (size_t i = 0; i < areas.size(); ++i) {
    SearchArea& area = areas[i];
    const PartSums& sum = sums[i];
    area.box = pixelsOfCells(parts.list[i].box, frame);
    area.centroid = {static_cast<int>(sum.x / sum.found), static_cast<int>(sum.y / sum.found)};
    area.foundPx = static_cast<uint32_t>(sum.found);
    area.movedPx = static_cast<uint32_t>(sum.moved);
    const SearchArea* was =
        search.hasSeed(static_cast<uint32_t>(i)) ? areaOf(area.box, before) : nullptr;
    area.origin = area.centroid;
    if (!was) continue;
    // What a thing has left behind did not travel.
    if (area.foundPx >= was->foundPx / 4) {
      area.origin = was->origin;
      area.hasTravelled = was->hasTravelled || isFar(area.centroid, area.origin);
    }
    area.step = {stepOf(absDiff(area.centroid.x, was->centroid.x), was->step.x, frame.width),
                 stepOf(absDiff(area.centroid.y, was->centroid.y), was->step.y, frame.height)};
    area.stillFrames = hasMoved(area) ? 0 : was->stillFrames + 1;
  }
}

}  // namespace rg::background
