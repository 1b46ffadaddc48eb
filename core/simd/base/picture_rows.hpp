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

/// Samples of a row that have others between them.
struct SpacedRow {
  const uint8_t* first;
  int stepBytes;            ///< 2 or 4.
  bool hasTenBits = false;  ///< Words, as YuvOrder says.
};

namespace plain {
void gatherRow(const SpacedRow& from, int count, uint8_t* to);
void loadPlanarRow(const uint8_t* red, const uint8_t* green, const uint8_t* blue, int width,
                   const ColourRows& to);
void loadPackedRow(const uint8_t* from, int width, const PackedOrder& order, const ColourRows& to);
void loadYuvRow(const YuvRows& from, int width, const YuvToRgb& k, const ColourRows& to);
}  // namespace plain

namespace simd {
/// Puts samples side by side; of ten bits the upper 8. Touches no byte behind the last one's.
void gatherRow(const SpacedRow& from, int count, uint8_t* to);
/// Luma as by loadPackedRow.
void loadPlanarRow(const uint8_t* red, const uint8_t* green, const uint8_t* blue, int width,
                   const ColourRows& to);
/// Luma is (77 R + 150 G + 29 B + 128) / 256.
void loadPackedRow(const uint8_t* from, int width, const PackedOrder& order, const ColourRows& to);
/// A chroma sample serves two columns; luma is copied.
void loadYuvRow(const YuvRows& from, int width, const YuvToRgb& k, const ColourRows& to);
}  // namespace simd

}  // namespace rg
