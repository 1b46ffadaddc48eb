// SPDX-License-Identifier: LGPL-2.1-or-later
// The loops over one row that core/segmentation/colour_links.cpp is made of, compiled for every
// instruction set.
//
// Each is written once, in plain integer arithmetic on independent pixels; the compiler makes the
// vectors. So all targets, the plain one among them, give the same bits.
#pragma once

#include "core/segmentation/hue.hpp"

#include <cstdint>

namespace rg::segmentation::simd {

/// to[i] = the mean of a[i], b[i] and from[i], weights 1 1 2.
void smoothRow(const uint8_t* a, const uint8_t* b, const uint8_t* from, int count, uint8_t* to);

/// Pairs of pixels a[i], b[i] of one channel or three: their largest difference, at most `most`.
struct PixelPairs {
  int channels = 1;
  const uint8_t* a[3] = {};
  const uint8_t* b[3] = {};
};
void measureRow(const PixelPairs& pairs, int count, uint8_t most, uint8_t* to);

/// Hues as hueOf, with kInBand set for those of the band.
inline constexpr int16_t kInBand = 1 << 11;
static_assert(kHueCount <= kInBand);
void findHueRow(const uint8_t* red, const uint8_t* green, const uint8_t* blue, int count,
                const HueBand& band, int16_t* hues);

/// Raises distances below `to` to it where both pixels have a hue, one of them in the band, and
/// their hues differ by more than `least`.
struct HueGuard {
  int least;
  uint8_t to;
};
void guardRow(const int16_t* a, const int16_t* b, int count, const HueGuard& guard,
              uint8_t* distances);

/// For each of `count` pixels which neighbour is nearest: of equal ones up, left, right, down.
/// left[i], left[i + 1], up[i] and down[i] are its distances; `none` is the one to no neighbour.
enum Nearest : uint8_t { kNearestUp, kNearestLeft, kNearestRight, kNearestDown, kNearestNone };
struct Distances {
  const uint8_t *left, *up, *down;
};
void chooseRow(const Distances& distances, int count, uint8_t none, uint8_t* nearest);

/// Which of the two pixels has the other for its nearest, or (distance at most `similarity`) need
/// not.
struct LinkRow {
  const uint8_t *left, *up;  ///< Distances to the left and the upper neighbour.
  const uint8_t* nearest;    ///< As chooseRow gives it, of the row and of the one above; null = no
  const uint8_t* above;      ///< pixel has a choice.
  uint8_t similarity, none;
};
/// links[i] gets the bit `leftBit` and `upBit` where the pixel is linked, and those of `always`.
/// Of the first pixel's left link, the choice of the pixel before it is not considered.
struct LinkBits {
  uint8_t leftBit, upBit, always;
};
void linkRow(const LinkRow& row, int count, const LinkBits& bits, uint8_t* links);

/// Bit i of the words = (bytes[i] & mask) != 0; the last word's other bits are 0.
void packRow(const uint8_t* bytes, int count, uint8_t mask, uint64_t* words);

}  // namespace rg::segmentation::simd
