// SPDX-License-Identifier: LGPL-2.1-or-later
// From regions of cells to regions of pixels: each pixel of a cell that touches another region goes
// where its colour fits (part of stage 2).
//
// The candidates are the regions of the 3x3 cells round it, each with the mean colour of its cells
// there, of those of one colour if there are any: a cell of several colours may be crossed by a
// border. A region that has only such cells there, of a colour between those of two others, is the
// ramp of the edge between them and no candidate.
// Candidates whose colours are within kAlikeColours of the cell's own are none: between them noise
// would draw the border. A pixel stays with its cell's region unless another is nearer by the sum
// of absolute differences of the channels, or nearer than others that come before in raster order.
// Determinism: each pixel depends on its neighbourhood only.
#pragma once

#include "core/colour_cells.hpp"
#include "core/executor.hpp"
#include "core/image.hpp"
#include "core/simd/cell_rows.hpp"

#include <cstdint>
#include <vector>

namespace rg {

class BorderPixels {
 public:
  /// cellIds: the regions of cells.cells(), 0 = none. Writes ids, of the size of cells.pixels();
  /// out of scope they are 0.
  void refine(const ColourCells& cells, ImageView<const uint16_t> cellIds, const Executor& executor,
              ImageView<uint16_t> ids);

 private:
  /// Regions round a cell: packed sums of their cells there, and of those of one colour.
  struct Found {
    uint64_t all[simd::kMostColours], pure[simd::kMostColours];
    uint16_t ids[simd::kMostColours];
    int count = 1;
  };
  struct Candidates {
    uint16_t ids[simd::kMostColours];
    simd::CellColours cell;
  };
  /// Of one thread.
  struct Scratch {
    std::vector<uint16_t> least, most;
  };

  void pack(int cellRow);
  void spread(int cellRow) const;
  void refineRow(int cellRow, Scratch& scratch) const;
  void collect(int cellX, int cellY, Candidates& candidates) const;
  static void choose(const Found& found, Candidates& candidates);
  void refineCell(int cellX, int cellY) const;
  void clearOutOfScope(int y) const;

  ColourPlanes pixels_, cells_;
  /// A cell, to be summed.
  struct PackedCell {
    uint64_t colour = 0;  ///< Its channels and a 1 to count it, in four lanes.
    uint64_t pure = 0;    ///< The same of a cell of one colour, else 0.
  };
  Image<PackedCell> packed_;
  ImageView<const uint16_t> cellIds_;
  ImageView<uint16_t> ids_;
  std::vector<Scratch> scratch_;
};

}  // namespace rg
