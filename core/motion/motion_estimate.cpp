// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/motion/motion_estimate.hpp"

#include "core/base/pixel.hpp"

#include <algorithm>

namespace rg::motion {
namespace {

constexpr int64_t kNoiseVariance = 16;     // Grey levels squared.
constexpr int64_t kCurvaturePerPixel = 4;  // Grey levels: half of full reliability.

/// 256 · value / (value + half): 0 for none, 128 for `half`.
int64_t saturating(int64_t value, int64_t half) {
  return value <= 0 ? 0 : kFullReliability * value / (value + std::max<int64_t>(half, 1));
}

/// Low where the luma changes along one direction only, or not at all.
int64_t gradientReliability(const GradientSums& g) {
  const auto pixels = static_cast<int64_t>(std::max<uint64_t>(g.pixels, 1));
  // Per pixel in 1/16, so that the squares fit: 4 · 255² · 16 < 2^23.
  const int64_t sum = (g.xx + g.yy) * 16 / pixels;
  const int64_t diff = (g.xx - g.yy) * 16 / pixels, twiceXy = 2 * g.xy * 16 / pixels;
  const auto root =
      static_cast<int64_t>(integerSqrt(static_cast<uint64_t>(diff * diff + twiceXy * twiceXy)));
  return saturating((sum - root) / 2, kNoiseVariance * 16);
}

int64_t curvatureReliability(const FoundShift& found, int64_t pixels) {
  constexpr Point kDirections[] = {{1, 0}, {0, 1}, {1, 1}, {1, -1}};
  int64_t least = INT64_MAX;
  for (const Point& e : kDirections)
    least = std::min(least, found.sum(e.x, e.y) + found.sum(-e.x, -e.y) - 2 * found.sum());
  return saturating(least, kCurvaturePerPixel * pixels);
}

/// Low where another shift matches nearly as well: the lead over the second best is seen against
/// what the second best leaves unexplained, and against a shift at random.
int64_t peakReliability(const FoundShift& found, int64_t pixels) {
  const int64_t rival = found.rival;
  if (rival == UINT32_MAX) return kFullReliability;
  const int64_t lead = kFullReliability * (rival - found.sum());
  return integerSqrt(
      static_cast<uint64_t>(lead / (rival + pixels) * (lead / (found.mean + pixels))));
}

}  // namespace

RegionMotion estimateMotion(const FoundShift& found, const GradientSums& gradients) {
  RegionMotion motion{found.d.x * kMotionUnit, found.d.y * kMotionUnit,
                      static_cast<uint64_t>(found.sum()), 0};
  if (found.isBeaten) return motion;
  const auto pixels = static_cast<int64_t>(gradients.pixels);
  int64_t reliability =
      std::min(gradientReliability(gradients), curvatureReliability(found, pixels));
  if (found.d != Point{} || motion.sad > 0)
    reliability = std::min(reliability, peakReliability(found, pixels));
  motion.reliability = static_cast<uint16_t>(std::clamp<int64_t>(reliability, 0, kFullReliability));
  return motion;
}

}  // namespace rg::motion
