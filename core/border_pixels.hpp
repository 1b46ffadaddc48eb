// SPDX-License-Identifier: LGPL-2.1-or-later
// From regions of cells to regions of pixels: each pixel of a cell that touches another region goes
// where its colour fits (part of stage 2).
//
// The candidates are the regions of the 3x3 cells round it, each with the mean colour of its cells
// there; the cell itself, which the border may cross, counts only where its region has no other.
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
  /// Of one thread.
  struct Scratch {
    std::vector<uint16_t> least, most;
    simd::NearestColours cell;
    uint16_t ids[simd::kMostPixels] = {};
  };

  void spread(int cellRow) const;
  void refineRow(int cellRow, Scratch& scratch) const;
  void collectCandidates(int cellX, int cellY, simd::NearestColours& cell) const;
  void refineCell(int cellX, int cellY, Scratch& scratch) const;
  void clearOutOfScope(int y) const;

  ColourPlanes pixels_, cells_;
  ImageView<const uint16_t> cellIds_;
  ImageView<uint16_t> ids_;
  std::vector<Scratch> scratch_;
};

}  // namespace rg
