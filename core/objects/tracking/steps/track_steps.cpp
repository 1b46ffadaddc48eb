// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/tracking/steps/track_steps.hpp"

#include "core/objects/merge/motion_evidence.hpp"

#include <algorithm>
#include <optional>

namespace rg::objects {
namespace {

uint32_t cellsOf(const graph::Graph& graph, size_t region, const GroupGrid& grid) {
  uint32_t cells = 0;
  for (const Run& run : graph.runs.of(region)) {
    const Run found = grid.cellsIn(run);
    cells += static_cast<uint32_t>(found.end - found.begin);
  }
  return cells;
}

/// Of each track, how many cells of a region came from it.
void findArrivals(const motion::Motion& motion, size_t region, const GroupGrid& grid,
                  std::span<const uint16_t> owner, std::vector<uint32_t>& arrived) {
  std::fill(arrived.begin(), arrived.end(), 0);
  for (const Run& run : motion.graph->runs.of(region)) {
    const Run cells = grid.cellsIn(run);
    for (int cell = cells.begin; cell < cells.end; ++cell) {
      const Point from = cameFrom(grid.middleOf(cell, cells.y), motion.regions[region]);
      if (!boundsOf(grid.frame).contains(from)) continue;
      const uint16_t number = owner[grid.at(from.x / grid.stepPx, from.y / grid.stepPx)];
      if (number != 0) ++arrived[number - 1u];
    }
  }
}

void findSteps(const motion::Motion& motion, const GroupGrid& grid, std::span<const uint16_t> owner,
               TrackStepScratch& s) {
  s.steps.clear();
  s.arrived.resize(s.trackCells.size());
  const uint32_t most = *std::max_element(s.trackCells.begin(), s.trackCells.end());
  for (size_t region = 0; region < motion.regions.size(); ++region) {
    const uint32_t cells = cellsOf(*motion.graph, region, grid);
    if (cells == 0 || cells >= 2 * most) continue;  // More than half of it can't be one track's.
    findArrivals(motion, region, grid, owner, s.arrived);
    const auto from = std::max_element(s.arrived.begin(), s.arrived.end());
    if (2 * *from <= cells) continue;
    const motion::RegionMotion& moved = motion.regions[region];
    s.steps.push_back(
        {static_cast<uint32_t>(from - s.arrived.begin()), *from, {moved.dx, moved.dy}});
  }
}

/// What half of the cells go at most, in one direction.
int medianOf(std::span<RegionStep> steps, uint32_t cells, int Point::*axis) {
  std::sort(steps.begin(), steps.end(), [axis](const RegionStep& a, const RegionStep& b) {
    return a.step.*axis < b.step.*axis;
  });
  uint64_t passed = 0;
  size_t i = 0;
  while (2 * (passed += steps[i].cells) < cells) ++i;
  return steps[i].step.*axis;
}

/// The step of a track that had so many cells.
std::optional<Point> stepOf(std::span<RegionStep> steps, uint32_t trackCells) {
  uint32_t cells = 0;
  for (const RegionStep& step : steps) cells += step.cells;
  if (2 * cells < trackCells) return {};
  return Point{medianOf(steps, cells, &Point::x), medianOf(steps, cells, &Point::y)};
}

}  // namespace

void measureSteps(const motion::Motion& motion, const CameraMotion& camera, int64_t stepNs,
                  const GroupGrid& previous, std::span<const uint16_t> owner, TrackStepScratch& s,
                  std::vector<Track>& tracks) {
  if (tracks.empty()) return;
  s.trackCells.assign(tracks.size(), 0);
  previous.forParts(owner, [&](const Run& part, uint16_t track) {
    if (track != 0) s.trackCells[track - 1u] += static_cast<uint32_t>(part.end - part.begin);
  });
  findSteps(motion, previous, owner, s);
  std::sort(s.steps.begin(), s.steps.end(),
            [](const RegionStep& a, const RegionStep& b) { return a.track < b.track; });
  for (size_t begin = 0, end = 0; begin < s.steps.size(); begin = end) {
    const uint32_t index = s.steps[begin].track;
    while (end < s.steps.size() && s.steps[end].track == index) ++end;
    const std::optional<Point> step =
        stepOf(std::span(s.steps).subspan(begin, end - begin), s.trackCells[index]);
    if (step) tracks[index].setStep(*step, camera, stepNs);
  }
}

}  // namespace rg::objects
