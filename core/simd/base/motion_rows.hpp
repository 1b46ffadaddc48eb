// SPDX-License-Identifier: LGPL-2.1-or-later
// The loops over one row that core/objects/merge/own_motion.cpp and core/motion/padded_luma.cpp are
// made of, compiled for every instruction set.
//
// Each is written once, in plain integer arithmetic on independent pixels; the compiler makes the
// vectors. So all targets, the plain one among them, give the same bits.
#pragma once

#include <cstddef>
#include <cstdint>

namespace rg::simd {

/// Weights 1 2 1, rounded.
[[nodiscard]] constexpr uint16_t binomialMean(int a, int b, int c) {
  return static_cast<uint16_t>((a + 2 * b + c + 2) >> 2);
}

/// to[i] = the mean of above[i], at[i] and below[i], weights 1 2 1, of each of which the mean with
/// its left and right neighbours is taken before, weights 1 2 1, too. Means are rounded; the row's
/// ends repeat.
struct ThreeRows {
  const uint8_t *above, *at, *below;
};
void smoothRow(const ThreeRows& rows, int count, uint8_t* to);

/// to[i] = the mean of upper[i], upper[i + 1], lower[i] and lower[i + 1], of which the right ones
/// weigh `right` and the lower ones `low` sixteenths.
struct WarpRow {
  const uint8_t *upper, *lower;
  int right, low;
};
void warpRow(const WarpRow& row, int count, uint8_t* to);

/// to[i] = the mean of the four pixels round a place, weighed in sixteenths, of kWarpSpan places on
/// a line; all of them lie within the picture.
inline constexpr int kWarpSpan = 16;
struct WarpSpan {
  const uint8_t* pixels;
  ptrdiff_t stride;
  int x, y;              ///< Of the first place, in 1/256 px from the first pixel's middle.
  int acrossX, acrossY;  ///< How far it is from there to the place after the last.
};
void warpSpan(const WarpSpan& span, uint8_t* to);

/// to[i] = the sum of the boxes of 4x4 pixels from [i] on of four rows; they have 3 more columns.
struct BoxRows {
  const uint8_t* rows[4];
};
void sumBoxRow(const BoxRows& from, int count, uint16_t* to);

/// Sums of |now − still| and |now − moved|, of which none counts more than `most`.
struct DifferenceSums {
  uint32_t still = 0;
  uint32_t moved = 0;
};
struct ComparedRows {
  const uint8_t *now, *still, *moved;
};
[[nodiscard]] DifferenceSums sumDifferences(const ComparedRows& rows, int count, uint8_t most);

/// Whether any of them is not 0.
[[nodiscard]] bool isAnySet(const uint16_t* values, int count);

/// Raises smaller values to `to`.
void raiseRow(uint16_t* values, int count, uint16_t to);

}  // namespace rg::simd
