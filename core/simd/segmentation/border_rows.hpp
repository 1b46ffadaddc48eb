// SPDX-License-Identifier: LGPL-2.1-or-later
// The loops over one row that core/segmentation/border_pixels.cpp is made of, compiled for every
// instruction set.
//
// Each is written once, in integer arithmetic on independent elements; of most the compiler makes
// the vectors. So all targets, the plain one among them, give the same bits.
#pragma once

#include <cstdint>

namespace rg::segmentation::simd {

/// Colours of cells, the largest difference within each, and regions.
struct CellPlanes {
  const uint8_t *red, *green, *blue, *ranges;
  const uint16_t* ids;
};
/// Each cell in four lanes of 16 bits: its channels and a 1 to count it.
inline constexpr int kLaneBits = 16;
/// Writes regions as keys, colours, and those of ranges up to `pureRange` again, others as 0.
void packCells(const CellPlanes& cells, int count, uint8_t pureRange, uint64_t* keys,
               uint64_t* colours, uint64_t* pures);

/// Findings come in vectors of up to so many cells.
inline constexpr int kSideLanes = 8;
/// Cells of a row. Elements −1 and `count` are read, too: 0 where there is no cell. So are
/// kSideLanes − 1 more, whatever they hold; as many results are written behind the last.
struct PackedCells {
  const uint64_t* keys;  ///< The region; from bit 16 on what must be alike of neighbours. 0: none.
  const uint64_t* colours;  ///< To be summed.
  const uint64_t* pures;    ///< The same of a cell of one colour, else 0.
};

/// Of each cell: sums over the pure ones of the 3x3 cells round it, or over all where none is pure.
/// The cell itself counts where it is pure or where no other cell is of its region.
struct CellSides {
  uint64_t* own;     ///< Over those of the cell's own region.
  uint64_t* other;   ///< Over those of other regions.
  uint64_t* others;  ///< The other region's key; 0: there is none, kManySides: several.
};
inline constexpr uint64_t kManySides = ~uint64_t{0};
struct CellRows {
  PackedCells above, middle, below;
};
void findSides(const CellRows& cells, int count, const CellSides& sides);

/// Each element `side` times: 2, 4 or 8.
void repeatRow(const uint8_t* from, int count, int side, uint8_t* to);
void repeatRow(const uint16_t* from, int count, int side, uint16_t* to);

/// ids[i] = others[i] where pixel i is nearer to the other colour by more than the margin, else
/// owns[i]. Distances are sums of absolute differences, those above 255 all alike.
struct PixelSides {
  const uint8_t *pixels[3], *own[3], *other[3];
  const uint16_t *owns, *others;
  uint8_t margin;
};
void chooseSides(const PixelSides& row, int count, uint16_t* ids);

}  // namespace rg::segmentation::simd
