// SPDX-License-Identifier: LGPL-2.1-or-later
// The loops that core/segmentation/colour_cells.cpp and core/segmentation/border_pixels.cpp are
// made of, compiled for every instruction set.
//
// Each is written once, in integer arithmetic on independent elements; of most the compiler makes
// the vectors. So all targets, the plain one among them, give the same bits.
#pragma once

#include <cstddef>
#include <cstdint>

namespace rg::segmentation::simd {

/// sums[i] += from[i].
void addRow(const uint8_t* from, int count, uint16_t* sums);
/// The same for those in scope.
void addScopedRow(const uint8_t* from, const uint8_t* scope, int count, uint16_t* sums);
/// sums[i] += 256 for what is in scope, and 1 more for kInScope.
void countRow(const uint8_t* scope, int count, uint16_t* sums);
/// to[i] = from[2 i] + from[2 i + 1].
void addPairs(const uint16_t* from, int count, uint16_t* to);
/// From sums of countRow: how many are in scope, and which scope value those have, 0 for none.
void splitCounts(const uint16_t* sums, int count, uint8_t* counts, uint8_t* scope);
/// to[i] = sums[i] / counts[i], halves rounded up; 0 where the count is 0. Counts up to 64.
void divideRow(const uint16_t* sums, const uint8_t* counts, int count, uint8_t* to);

/// least[i] and most[i] take in from[i].
void widenRow(const uint8_t* from, int count, uint8_t* least, uint8_t* most);
/// The same for those in scope.
void widenScopedRow(const uint8_t* from, const uint8_t* scope, int count, uint8_t* least,
                    uint8_t* most);
/// In place: least[i] and most[i] = those of the elements 2 i and 2 i + 1 before.
void widenPairs(int count, uint8_t* least, uint8_t* most);
/// Raises ranges[i] to most[i] - least[i], where that is not negative.
void raiseRanges(const uint8_t* least, const uint8_t* most, int count, uint8_t* ranges);

/// Square cells of pixels, and the colours that those are compared with. Whole rows of `side`
/// bytes are read, those beyond the picture's width too; of rows only `rows`.
inline constexpr int kMostColours = 9;
struct CellColours {
  const uint8_t* pixels[3] = {};  ///< First pixel of the cell, by channel.
  ptrdiff_t strides[3] = {};
  int side = 0;  ///< 2, 4 or 8.
  int rows = 0;
  int count = 0;  ///< Of the candidates.
  uint8_t candidates[kMostColours][3];
  uint8_t margin = 0;
};
/// choices[side y + x] = the candidate of least sum of absolute differences of the channels, at
/// most 255; all but the first have `margin` added; of equal ones the first. Returns whether any is
/// not 0. Writes 64 bytes.
bool chooseColours(const CellColours& cell, uint8_t* choices);

/// Bit i of the words = (a[i] == b[i]); the last word's other bits are 0.
void packEqual(const uint16_t* a, const uint16_t* b, int count, uint64_t* words);

/// Sum of the bytes.
uint32_t sumRow(const uint8_t* from, int count);

}  // namespace rg::segmentation::simd
