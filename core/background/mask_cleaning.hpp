// SPDX-License-Identifier: LGPL-2.1-or-later
// Tidying binary masks.
//
// Determinism: integers and explicit neighbourhoods; component steps follow
// core/base/components.hpp. Pixels outside the picture count as 0 where nothing else is said.
#pragma once

#include "core/base/bit_mask.hpp"
#include "core/base/components.hpp"
#include "core/base/memory/executor.hpp"
#include "core/base/memory/image.hpp"

#include <cstdint>
#include <vector>

namespace rg::background {

/// Scratch of the functions below.
struct CleaningScratch {
  Components components;
  std::vector<uint8_t> isChosen;
  Image<uint64_t> repeated;            ///< The mask with its ends repeated.
  Image<uint64_t> counts;              ///< Sums along rows, digit by digit.
  std::vector<int> firstRow, lastRow;  ///< Of each column's edge pixels.
};

/// A pixel is set where more than `share` of 256 of the square of side 2 · radius + 1 around it
/// are set in `mask`; its border is repeated outside. radius 1 … 7. share 128 is the median. In and
/// out must differ.
void keepMajority(const BitMask& mask, int radius, int share, const Executor& executor,
                  CleaningScratch& scratch, BitMask& out);

/// Clears 4-connected parts of fewer than `leastPx` pixels.
void dropSmallParts(BitMask& mask, uint32_t leastPx, CleaningScratch& scratch);

/// Sets holes: 4-connected unset parts that don't touch the frame's border and have at most
/// `mostPx` pixels.
void fillHoles(BitMask& mask, uint32_t mostPx, CleaningScratch& scratch);

/// Clears 8-connected parts in which fewer than `leastPx` pixels are set in `strong` too
/// (hysteresis).
void keepSupported(BitMask& mask, const BitMask& strong, uint32_t leastPx,
                   CleaningScratch& scratch);

/// Writes kForegroundPixel and kShadowPixel where `mask` and `shadow` are set, else
/// kBackgroundPixel: each pixel is that of the masks at `shift` from it, beyond them background.
void paintForeground(const BitMask& mask, const BitMask& shadow, Point shift,
                     const Executor& executor, ImageView<uint8_t> out);

/// The paper's line segmentation inside `box`: a pixel is set in `out` where its row has an edge
/// pixel on both sides of it (or at it) and its column too. Only sets pixels, never clears.
void fillLines(ImageView<const uint8_t> edges, const Box& box, CleaningScratch& scratch,
               ImageView<uint8_t> out);

}  // namespace rg::background
