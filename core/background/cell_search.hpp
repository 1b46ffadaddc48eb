// SPDX-License-Identifier: LGPL-2.1-or-later
// Where a frame differs from the one before, looked for in the whole frame or only from given
// places on (paper, section 2.1: "sequential connected components with feedback").
//
// The frame is a grid of cells of 8x8 pixels. A cell is occupied when at least kLeastOccupied of
// its pixels are found; parts are the 8-connected components of occupied cells. Seeds are the cells
// inside the areas and those that were hit by the scan. The search starts at the seeds and goes on
// to all neighbours of every occupied cell, until nothing is left to follow: so a part that holds a
// seed is found whole, whatever the areas' borders cut, overlap or join, and each cell is looked at
// once.
// Determinism: the parts that hold a seed, and the pixels found in them and in the cells around
// them, are the same for SearchScope::Frame and SearchScope::Areas and for any number of threads.
#pragma once

#include "core/background/background.hpp"
#include "core/background/changed_pixels.hpp"
#include "core/background/scene_memory.hpp"
#include "core/base/components.hpp"
#include "core/base/memory/executor.hpp"
#include "core/base/run.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace rg::background {

inline constexpr int kCellPx = 8;
inline constexpr int kLeastOccupied = 4;

/// The pixels of cells, of which the last ones in a row or column may be cut by the frame's border.
[[nodiscard]] constexpr Box pixelsOfCells(const Box& cells, Size frame) {
  return intersect(
      {cells.x * kCellPx, cells.y * kCellPx, cells.width * kCellPx, cells.height * kCellPx},
      boundsOf(frame));
}
[[nodiscard]] constexpr Box pixelsOfCells(const ComponentRun& run, Size frame) {
  return pixelsOfCells(Box{run.begin, run.y, run.end - run.begin, 1}, frame);
}

/// What a frame is compared with.
struct Comparison {
  ColourPlanes now;
  ColourPlanes before;  ///< Without data: there is no frame before.
  const SceneMemory& memory;
  int threshold = 0;       ///< For what changed since the frame before.
  int sceneThreshold = 0;  ///< For what is not as in the memory.
};

/// What is counted in a cell: found pixels, those of them that differ from the frame before, and of
/// these the ones in scanned rows.
struct CellCounts {
  uint8_t found = 0, moved = 0, hits = 0;
};

class CellSearch {
 public:
  void prepare(Size frame);

  /// Starts a frame: no seeds.
  void begin();
  /// All cells that the box touches are seeds, and in them pixels count as found also where they
  /// differ from the memory. One task of its own, but for the cells of areas added before.
  void addArea(const Box& areaPx);
  /// Makes seeds of the cells that have a change above the threshold in row y, of which `changes`
  /// holds the differences. To be called after all areas are added.
  void addHits(const uint8_t* changes, int y, int threshold);
  void run(SearchScope search, const Comparison& what, const Executor& executor);
  /// In place of addHits() and run(), from who has looked everywhere: the counts of all cells, row
  /// by row. The pixels go into pixels().
  void take(std::span<const CellCounts> cells);

  [[nodiscard]] Size grid() const { return isOccupied_.size(); }
  /// The parts; boxes and runs are in cells.
  [[nodiscard]] const Components& parts() const { return parts_; }
  [[nodiscard]] bool hasSeed(uint32_t part) const { return hasSeed_[part] != 0; }
  /// Found pixels of a cell, and those of them that differ from the frame before.
  [[nodiscard]] int found(int x, int y) const { return found_.at(x, y); }
  [[nodiscard]] int moved(int x, int y) const { return moved_.at(x, y); }
  /// 255 where a pixel was found. Defined in occupied cells and the eight around each; one pixel of
  /// 0 lies around the frame.
  [[nodiscard]] const uint8_t* foundRow(int y) const { return pixels_.row(y + 1) + 1; }
  /// foundRow() of all rows, in a border of one pixel.
  [[nodiscard]] Image<uint8_t>& pixels() { return pixels_; }
  [[nodiscard]] const Image<uint8_t>& pixels() const { return pixels_; }
  /// 1 in the cells of areas, before hits are added.
  [[nodiscard]] Image<uint8_t>& seeds() { return isSeed_; }
  [[nodiscard]] const Image<uint8_t>& seeds() const { return isSeed_; }
  /// How many cells were looked at in this frame.
  [[nodiscard]] int lookedAt() const { return looked_; }

 private:
  struct Task {
    size_t first = 0, last = 0;
  };

  [[nodiscard]] Run pixelsOf(const Run& cells, int row) const;
  void look(const Run& cells, const Comparison& what);
  void recall(const Run& cells, const Comparison& what);
  void count(const Run& cells);
  void lookEverywhere(const Comparison& what, const Executor& executor);
  void lookInAreas(const Comparison& what, const Executor& executor);
  void follow(const Comparison& what, const Executor& executor);
  void lookAtCells(std::span<const Point> cells, const Comparison& what, const Executor& executor);
  void note(int x, int y, std::vector<Point>& cells);
  void findParts();

  Size frame_;
  int looked_ = 0;
  Image<uint8_t> pixels_;  ///< With a border of one pixel.
  Image<uint8_t> found_, moved_, isOccupied_, isSeed_, isLooked_;
  std::vector<Run> runs_;    ///< Of the areas, disjoint.
  std::vector<Task> tasks_;  ///< One an area.
  std::vector<Point> hits_, frontier_, next_;
  std::vector<uint8_t> isHit_;  ///< Of each pixel of a row, in whole cells.
  Components parts_;
  std::vector<uint8_t> hasSeed_;
};

}  // namespace rg::background
