// SPDX-License-Identifier: LGPL-2.1-or-later
// What the tracker looks at: the frame's merged groups on a coarse grid, so that its cost depends
// on objects rather than on resolution.
//
// Determinism: each cell is the sample at its middle.
#pragma once

#include "core/base/camera/camera_motion.hpp"
#include "core/base/geometry.hpp"
#include "core/base/picture.hpp"
#include "core/graph/graph.hpp"
#include "core/objects/merge/mrf_merge.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace rg::objects {

struct GroupGrid {
  int stepPx = 1;  ///< Side of a cell; 1 up to 288 lines, then growing with the frame.
  Size frame;
  const Picture* picture = nullptr;  ///< Of this frame; null where there is none.
  Size grid;
  std::vector<uint16_t> group;   ///< Of each cell: 1 + group, 0 = background. Row by row.
  std::vector<uint16_t> region;  ///< Of each cell: 1 + its region, where group is not 0.
  std::vector<uint8_t>
      bin;  ///< Colour bin (core/objects/tracking/looks/appearance.hpp), where group is not 0.
  std::vector<uint16_t> expected;  ///< Of each cell: 1 + the track that its region is predicted to
                                   ///< be, 0 = none; where group is not 0.
  std::vector<uint8_t> isStill;    ///< Of each group: it is known not to move, as what somebody
                                   ///< uncovered doesn't who was there first.
  std::vector<Run> runs;  ///< Of the cells that are no background, of one group each. Row by
                          ///< row: what walks them costs nothing where nothing is.
  std::vector<uint16_t> runBegins;  ///< Scratch.
  /// For each row and column of pixels the first cell whose middle does not come before it; one
  /// entry more than there are pixels.
  std::vector<uint16_t> cellFromRow, cellFromColumn;
  CameraMotion camera;  ///< Since the previous frame.
  /// What stands still is background, whatever it is.
  bool showsMovers = false;

  /// The pixel that cell (x, y) shows.
  [[nodiscard]] Point middleOf(int x, int y) const {
    const int half = stepPx / 2;
    return {std::min(x * stepPx + half, frame.width - 1),
            std::min(y * stepPx + half, frame.height - 1)};
  }
  /// The cells whose middles lie in a run of pixels.
  [[nodiscard]] Run cellsIn(const Run& pixels) const {
    const uint16_t y = cellFromRow[pixels.y];
    if (cellFromRow[pixels.y + 1u] == y) return {};
    return {y, cellFromColumn[pixels.begin], cellFromColumn[pixels.end]};
  }
  [[nodiscard]] size_t at(int x, int y) const {
    return static_cast<size_t>(y) * static_cast<size_t>(grid.width) + static_cast<size_t>(x);
  }
  /// Calls visit(index, x, y) for the cells that are no background, in raster order.
  template <class Visit>
  void forForeground(Visit&& visit) const {
    for (const Run& run : runs)
      for (int x = run.begin; x < run.end; ++x) visit(at(x, run.y), x, int{run.y});
  }
  /// Calls visit(part, value) for the longest parts of the runs over which a cell's value is the
  /// same, in raster order.
  template <class Visit>
  void forParts(std::span<const uint16_t> values, Visit&& visit) const {
    for (const Run& run : runs) {
      const uint16_t* row = values.data() + at(0, run.y);
      for (uint16_t begin = run.begin, end = begin; begin < run.end; begin = end) {
        const uint16_t value = row[begin];
        end = static_cast<uint16_t>(graph::endOfRun(row, begin, run.end));
        visit(Run{run.y, begin, end}, value);
      }
    }
  }
  /// Sets `runs` to what `group` and `grid` say.
  void listRuns();
};

/// Samples the labels. Groups for which isBackground is set count as background. expectedOf: of
/// each region the track that it is predicted to be, or none.
void gather(const graph::Graph& graph, std::span<const GroupIndex> groupOf,
            std::span<const uint8_t> isBackground, std::span<const TrackIndex> expectedOf,
            GroupGrid& evidence);

}  // namespace rg::objects
