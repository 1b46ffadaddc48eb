// SPDX-License-Identifier: LGPL-2.1-or-later
// Linked pixels, or cells, as horizontal runs, and the runs' components (part of stage 2).
//
// Components larger than a limit are cut along a fixed grid of tiles: one motion does not describe
// half a frame, and a grid stands still where iso-lines of a shading would wander.
// Determinism: a component is a transitive closure; components are numbered from 0 in the raster
// order of their first pixels.
#pragma once

#include "core/colour_links.hpp"
#include "core/executor.hpp"
#include "core/image.hpp"
#include "core/row_spans.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace rg {

/// Columns first … last − 1 of one row, linked one to the next.
struct PixelRun {
  int32_t first = 0;
  int32_t last = 0;
};

struct RunLimits {
  uint32_t maxAreaPx = ~uint32_t{0};  ///< Larger components are cut.
  int tilePx = 64;                    ///< Side of the tiles that they are cut into.
};

class PixelRuns {
 public:
  void build(const ColourLinks& links, const RunLimits& limits, const Executor& executor);
  /// The parts of equal labels; label 0 has none.
  void build(ImageView<const uint16_t> labels, const RunLimits& limits, const Executor& executor);

  [[nodiscard]] uint32_t count() const { return static_cast<uint32_t>(runs_.size()); }
  [[nodiscard]] uint32_t componentCount() const { return componentCount_; }
  /// Index of the first run of row y; y = height gives count().
  [[nodiscard]] uint32_t rowStart(int y) const { return rowStarts_[static_cast<size_t>(y)]; }
  [[nodiscard]] const PixelRun& run(uint32_t i) const { return runs_[i]; }
  [[nodiscard]] uint32_t component(uint32_t run) const { return components_[run]; }

  /// Bands of rows that tasks share out: no run of one belongs to the part of another.
  [[nodiscard]] int bandCount() const { return static_cast<int>(cuts_.size()); }
  [[nodiscard]] Span bandRows(int band) const {
    return {band * limits_.tilePx, std::min((band + 1) * limits_.tilePx, size_.height)};
  }
  /// What is linked within a band and a tile is a part: its first run, itself for that one.
  [[nodiscard]] uint32_t part(uint32_t run) const { return parents_[run]; }

 private:
  void prepare(Size size, const RunLimits& limits);
  void countRuns(int y);
  void findComponents(const Executor& executor);
  void findRuns(int y, std::vector<uint32_t>& cuts);
  void joinRows(int y, std::vector<uint32_t>& parents) const;
  void joinTiles();
  void numberComponents();

  RunLimits limits_;
  Size size_;
  std::vector<uint16_t> noLabels_;               ///< As wide as a row.
  std::vector<uint64_t> tileStarts_;             ///< Bits of the columns where tiles begin.
  Image<uint64_t> scope_, leftLinks_, upLinks_;  ///< A bit a pixel.
  std::vector<uint32_t> rowStarts_;
  std::vector<PixelRun> runs_;
  std::vector<uint32_t> parents_;            ///< Of each run the first one of its part.
  std::vector<uint32_t> whole_;              ///< Forest of the parts, across the tiles.
  std::vector<std::vector<uint32_t>> cuts_;  ///< By band: runs linked to the one to their left.
  std::vector<uint32_t> areas_;              ///< Of each root of `whole_`.
  std::vector<uint32_t> components_;
  uint32_t componentCount_ = 0;
};

/// Calls visit(i, j, first, last) for the runs i of row y − 1 and j of row y that have the columns
/// first … last − 1 in common.
template <class Visit>
void forOverlaps(const PixelRuns& runs, int y, Visit&& visit) {
  uint32_t i = runs.rowStart(y - 1);
  uint32_t j = runs.rowStart(y);
  const uint32_t iEnd = j;
  const uint32_t jEnd = runs.rowStart(y + 1);
  while (i < iEnd && j < jEnd) {
    const PixelRun& a = runs.run(i);
    const PixelRun& b = runs.run(j);
    const int first = a.first > b.first ? a.first : b.first;
    const int last = a.last < b.last ? a.last : b.last;
    if (first < last) visit(i, j, first, last);
    if (a.last <= b.last) ++i;
    if (b.last <= a.last) ++j;
  }
}

}  // namespace rg
