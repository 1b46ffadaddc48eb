// SPDX-License-Identifier: LGPL-2.1-or-later
// Rows of frames to rows of planes (core/base/picture.hpp), by the widest instructions there are.
//
// The same bits on every target. plain:: is the reference that the tests compare with.
#pragma once

#include <cstdint>

namespace rg {

struct ColourRows {
  uint8_t *red, *green, *blue, *luma;
};

/// Where red, green and blue lie within a packed pixel.
struct PackedOrder {
  int red, green, blue;
  int bytesPerPixel;  ///< 3 or 4.
};

/// Inverse of Y'CbCr in Q14. Below 2^16 each, so that sums of three products fit 32 bits.
struct YuvToRgb {
  int offset;  ///< Luma of black.
  int luma;    ///< Gain of luma.
  int redByCr, greenByCb, greenByCr, blueByCb;
};

struct YuvRows {
  const uint8_t *luma, *cb, *cr;
  int chromaStep;  ///< 1 for planes of their own; 2 where Cb and Cr take turns, Cb first.
};

namespace plain {
void loadPackedRow(const uint8_t* from, int width, const PackedOrder& order, const ColourRows& to);
void loadYuvRow(const YuvRows& from, int width, const YuvToRgb& k, const ColourRows& to);
}  // namespace plain

namespace simd {
/// Luma is (77 R + 150 G + 29 B + 128) / 256.
void loadPackedRow(const uint8_t* from, int width, const PackedOrder& order, const ColourRows& to);
/// A chroma sample serves two columns; luma is copied.
void loadYuvRow(const YuvRows& from, int width, const YuvToRgb& k, const ColourRows& to);
}  // namespace simd

}  // namespace rg
