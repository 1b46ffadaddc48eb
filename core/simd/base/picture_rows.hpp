// SPDX-License-Identifier: LGPL-2.1-or-later
// Rows of frames to rows of planes (core/base/picture.hpp), by the widest instructions there are.
//
// The same bits on every target. plain:: is the reference that the tests compare with.
#pragma once

#include "core/simd/base/conversion.hpp"

#include <cstdint>

namespace rg {

struct ColourRows {
  uint8_t *red, *green, *blue, *luma;
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
