// SPDX-License-Identifier: LGPL-2.1-or-later
// The loops that core/colour_cells.cpp and core/border_pixels.cpp are made of, compiled for every
// instruction set.
//
// Each is written once, in plain integer arithmetic on independent elements; the compiler makes the
// vectors. So all targets, the plain one among them, give the same bits.
#pragma once

#include <cstdint>

namespace rg::simd {

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

/// Colours that the pixels of a cell are compared with. The first is the one to stay with: another
/// must be nearer by more than `margin`.
inline constexpr int kMostPixels = 64;
inline constexpr int kMostColours = 9;
struct NearestColours {
  int pixels = 0;                        ///< A multiple of 16 up to kMostPixels.
  uint8_t colours[3][kMostPixels] = {};  ///< Of the pixels, by channel.
  int count = 0;                         ///< Of the candidates.
  uint8_t candidates[3][kMostColours] = {};
  uint16_t ids[kMostColours] = {};
  uint16_t margin = 0;
};
/// to[i] = the id of the candidate of least sum of absolute differences of the channels; of equal
/// ones the first.
void chooseColours(const NearestColours& cell, uint16_t* to);

/// Bit i of the words = (a[i] == b[i]); the last word's other bits are 0.
void packEqual(const uint16_t* a, const uint16_t* b, int count, uint64_t* words);

/// Sum of the bytes.
uint32_t sumRow(const uint8_t* from, int count);

}  // namespace rg::simd
