// SPDX-License-Identifier: LGPL-2.1-or-later
// The loops of core/background/changed_pixels.hpp over a piece of a row, by the widest instructions
// there are.
//
// The same bits on every target. plain:: is the reference that the tests compare with. Nothing is
// read or written outside of the piece.
#pragma once

#include <array>
#include <cstdint>

namespace rg::background {

/// Pixels of two pictures: the distance of two is the largest difference of a channel.
struct RowPair {
  std::array<const uint8_t*, 3> a, b;
  int channels;  ///< 1 or 3.
  int count;
};

/// A row of 0 and 255 and its neighbours, which are readable one column to the left and right.
struct BinaryRows {
  const uint8_t *above, *here, *below;
};

namespace plain {
void measureDistances(const RowPair& pair, uint8_t* out);
void markFar(const RowPair& pair, uint8_t limit, uint8_t* out);
void addFar(const RowPair& pair, uint8_t limit, const uint8_t* where, uint8_t* out);
void keepDense(const BinaryRows& rows, int count, uint8_t* out);
}  // namespace plain

namespace simd {
void measureDistances(const RowPair& pair, uint8_t* out);
/// 255 where the distance is above the limit, else 0.
void markFar(const RowPair& pair, uint8_t limit, uint8_t* out);
/// Sets to 255 what is above the limit where `where` is 255.
void addFar(const RowPair& pair, uint8_t limit, const uint8_t* where, uint8_t* out);
/// 255 where at least four of the 3x3 around the pixel are 255, else 0.
void keepDense(const BinaryRows& rows, int count, uint8_t* out);
}  // namespace simd

}  // namespace rg::background
