// SPDX-License-Identifier: LGPL-2.1-or-later
// From a region's sums of absolute differences to its vector and how far it can be relied on (part
// of stage 4).
#pragma once

#include "core/base/pixel.hpp"
#include "core/motion/motion.hpp"
#include "core/motion/shift_search.hpp"

#include <algorithm>
#include <cstdint>

namespace rg::motion {

/// Sums over a region's pixels of products of the luma's central differences, in grey levels per 2
/// pixels.
struct GradientSums {
  int64_t xx = 0, xy = 0, yy = 0;
  uint64_t pixels = 0;
};

namespace detail {
inline constexpr int64_t kNoiseVariance = 16;     // Grey levels squared.
inline constexpr int64_t kCurvaturePerPixel = 4;  // Grey levels: half of full reliability.

/// 256 · value / (value + half): 0 for none, 128 for `half`.
[[nodiscard]] constexpr int64_t saturating(int64_t value, int64_t half) {
  return value <= 0 ? 0 : kFullReliability * value / (value + std::max<int64_t>(half, 1));
}

/// Low where the luma changes along one direction only, or not at all.
[[nodiscard]] constexpr int64_t gradientReliability(const GradientSums& g) {
  const auto pixels = static_cast<int64_t>(std::max<uint64_t>(g.pixels, 1));
  // Per pixel in 1/16, so that the squares fit: 4 · 255² · 16 < 2^23.
  const int64_t sum = (g.xx + g.yy) * 16 / pixels;
  const int64_t diff = (g.xx - g.yy) * 16 / pixels, twiceXy = 2 * g.xy * 16 / pixels;
  const auto root =
      static_cast<int64_t>(integerSqrt(static_cast<uint64_t>(diff * diff + twiceXy * twiceXy)));
  return saturating((sum - root) / 2, kNoiseVariance * 16);
}

[[nodiscard]] constexpr int64_t curvatureReliability(const FoundShift& found, int64_t pixels) {
  const auto along = [&](int x, int y) {
    return found.sum(x, y) + found.sum(-x, -y) - 2 * found.sum();
  };
  const int64_t least =
      std::min(std::min(along(1, 0), along(0, 1)), std::min(along(1, 1), along(1, -1)));
  return saturating(least, kCurvaturePerPixel * pixels);
}

/// Low where another shift matches nearly as well: the lead over the second best is seen against
/// what the second best leaves unexplained, and against a shift at random.
[[nodiscard]] constexpr int64_t peakReliability(const FoundShift& found, int64_t pixels) {
  const int64_t rival = found.rival;
  if (rival == UINT32_MAX) return kFullReliability;
  const int64_t lead = kFullReliability * (rival - found.sum());
  return integerSqrt(
      static_cast<uint64_t>(lead / (rival + pixels) * (lead / (found.mean + pixels))));
}
}  // namespace detail

/// What is said of the best whole-pixel shift. The ring of shifts beyond those that could be found
/// tells a motion on the border of the search, which can be relied on, from one that goes further.
/// Where nothing changed the shifts farther than 1 px don't count: the result is the same for any
/// reach.
[[nodiscard]] constexpr RegionMotion estimateMotion(const FoundShift& found,
                                                    const GradientSums& gradients) {
  RegionMotion motion{found.d.x * kMotionUnit, found.d.y * kMotionUnit,
                      static_cast<uint64_t>(found.sum()), 0};
  if (found.isBeaten) return motion;
  const auto pixels = static_cast<int64_t>(gradients.pixels);
  int64_t reliability =
      std::min(detail::gradientReliability(gradients), detail::curvatureReliability(found, pixels));
  if (found.d != Point{} || motion.sad > 0)
    reliability = std::min(reliability, detail::peakReliability(found, pixels));
  motion.reliability = static_cast<uint16_t>(std::clamp<int64_t>(reliability, 0, kFullReliability));
  return motion;
}

}  // namespace rg::motion
