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

#include "core/base/memory/executor.hpp"
#include "core/base/memory/image.hpp"
#include "core/segmentation/colour_cells.hpp"
#include "core/simd/segmentation/border_rows.hpp"
#include "core/simd/segmentation/cell_rows.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace rg::segmentation {

class BorderPixels {
 public:
  /// cellIds: the regions of cells.cells(), 0 = none. Writes ids, of the size of cells.pixels();
  /// out of scope they are 0.
  void refine(const ColourCells& cells, ImageView<const uint16_t> cellIds, const Executor& executor,
              ImageView<uint16_t> ids);

 private:
  /// A row of cells, each to be summed: its channels and a 1 to count it, in four lanes. A place
  /// more on either side, 0 as all that is beyond the picture.
  struct CellLine {
    std::vector<uint64_t> keys, colours, pures;
    [[nodiscard]] simd::PackedCells cells() const {
      return {keys.data() + 1, colours.data() + 1, pures.data() + 1};
    }
  };
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
    std::array<CellLine, 3> lines;  ///< Of the rows above, of and below the one that is refined.
    std::vector<uint64_t> own, other, others;
    std::vector<uint16_t> ids;                    ///< Of the other region, by cell.
    std::array<std::vector<uint8_t>, 6> colours;  ///< Of the own region and the other, by cell,
    std::array<std::vector<uint8_t>, 6> wide;     ///< and by pixel.
    std::vector<uint16_t> wideOwn, wideOther;
  };

  void prepare(Scratch& scratch) const;
  void pack(int cellRow, CellLine& line) const;
  void refineRow(int cellRow, Scratch& scratch) const;
  void comparePairs(int cellRow, Scratch& scratch) const;
  void chooseRows(int cellRow, bool isDivided, Scratch& scratch) const;
  void refineCell(int cellX, int cellY, const simd::CellRows& lines) const;
  static void collect(int cellX, const simd::CellRows& lines, Found& found);
  static void choose(const Found& found, Candidates& candidates);
  void clearOutOfScope(int y) const;

  ColourGrid pixels_, cells_;
  ImageView<const uint16_t> cellIds_;
  ImageView<uint16_t> ids_;
  std::vector<Scratch> scratch_;
};

}  // namespace rg::segmentation
