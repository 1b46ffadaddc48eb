// SPDX-License-Identifier: LGPL-2.1-or-later
// Colours on the sides of a border: the arithmetic that every backend shares (border_pixels.hpp).
#pragma once

#include "core/base/pixel.hpp"

#include <algorithm>
#include <cstdint>

namespace rg::segmentation {

inline constexpr int kOneColour = 12;    ///< Largest difference of a channel within a pure cell.
inline constexpr int kAlikeColours = 8;  ///< Largest difference of a channel.
inline constexpr int kSideMargin = 5;    ///< Noise shall not decide: what is nearly as near stays.

/// Sums of cells' colours, 16 bits a channel, and in the highest 16 how many these are: up to nine.
[[nodiscard]] constexpr uint32_t packedCount(uint64_t packed) {
  return static_cast<uint32_t>(packed >> 48);
}
/// ⌈2^16 / n⌉: exact divisors of sums of up to nine bytes.
[[nodiscard]] constexpr uint32_t reciprocal(uint32_t n) {
  return (65536 + n - 1) / n;
}
/// Rounded; reciprocalOfCount: of packedCount().
[[nodiscard]] constexpr uint8_t packedMean(uint64_t packed, int channel,
                                           uint32_t reciprocalOfCount) {
  const auto sum = static_cast<uint32_t>(packed >> (channel * 16) & 0xFFFF);
  return static_cast<uint8_t>((sum + packedCount(packed) / 2) * reciprocalOfCount >> 16);
}

/// Of the channel that differs most. Colours: a[0], a[1], a[2].
template <class A, class B>
[[nodiscard]] constexpr int farthestOf(const A& a, const B& b) {
  return std::max(absDiff(a[0], b[0]), std::max(absDiff(a[1], b[1]), absDiff(a[2], b[2])));
}

/// Whether a colour is what pixels of two others mix to.
template <class A, class B, class C>
[[nodiscard]] constexpr bool lies(const A& colour, const B& one, const C& other) {
  if (farthestOf(one, other) <= kAlikeColours) return false;
  for (int c = 0; c < 3; ++c)
    if (absDiff(colour[c], one[c]) + absDiff(colour[c], other[c]) >
        absDiff(one[c], other[c]) + kAlikeColours)
      return false;
  return true;
}

}  // namespace rg::segmentation
