// SPDX-License-Identifier: LGPL-2.1-or-later
// The inner loops of Picture::loadDoubled, compiled for every instruction set.
//
// They are written once, in plain integer arithmetic; the compiler makes the vectors. So all
// targets, the plain one among them, give the same bits.
#pragma once

#include <cstdint>

namespace rg::simd {

/// What lies a quarter of a pixel off the centre of one, along an axis: 128ths of the four pixels
/// round that place. Cubic convolution (Keys 1981, a = -1/2) at 1/4 of the way to the next.
struct QuarterTaps {
  static constexpr int kHere = 111, kNext = 29, kBehind = -9, kAfterNext = -3;
  static constexpr int kUnit = 128;
};

/// Rows at, next to, on the other side of, and two from a centre.
struct QuarterRows {
  const uint8_t *here, *next, *behind, *afterNext;
};

/// sums[i]: the taps of the rows' bytes, each less 128: within ±19456.
void sumQuarter(const QuarterRows& rows, int count, int16_t* sums);

/// to[2 i], to[2 i + 1]: a quarter before and a quarter behind the centre of sums[i], rounded and
/// kept within a byte. sums[-2] … sums[count + 1] are read.
void doubleSums(const int16_t* sums, int count, uint8_t* to);

}  // namespace rg::simd
