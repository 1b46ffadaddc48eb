// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/motion_refinement.hpp"

#include "core/normal_sums.hpp"
#include "core/pixel.hpp"

#include <algorithm>
#include <bit>
#include <cstdlib>

namespace rg {
namespace {

constexpr int kSteps = 4;
/// Added to the gradients of each pixel, squared: keeps steps small where there are none.
constexpr int64_t kNoise = 4;
/// Pixels fit when their residual is at most so many times the mean, and kLeastLimit more.
constexpr int64_t kFitFactor = 3;
constexpr int64_t kLeastLimit = 2 * kFine;

/// The step that the fitting pixels ask for, in 1/128 px. Sums are scaled down together to 30 bits,
/// so that all products fit 64.
Point solve(const NormalSums& sums) {
  const int64_t xx = sums.xx + kNoise * sums.pixels, yy = sums.yy + kNoise * sums.pixels;
  const int64_t largest = std::max({xx, yy, std::abs(sums.xr), std::abs(sums.yr)});
  const int shift =
      std::max(0, static_cast<int>(std::bit_width(static_cast<uint64_t>(largest))) - 30);
  const int64_t a = xx >> shift, b = sums.xy >> shift, c = yy >> shift;
  const int64_t u = sums.xr >> shift, v = sums.yr >> shift;
  const int64_t determinant = a * c - b * b;
  if (determinant <= 0) return {};
  const auto step = [&](int64_t numerator) {
    return static_cast<int>(
        std::clamp<int64_t>(divideRounded(-2 * numerator, determinant), -kFine, kFine));
  };
  return {step(c * u - b * v), step(a * v - b * u)};
}

}  // namespace

Point refineMotion(std::span<const MatchedPart> parts, ImageView<const uint8_t> luma,
                   const PaddedLuma& previous, const RegionMotion& start) {
  int64_t pixels = 0;
  for (const MatchedPart& part : parts) pixels += part.pixels();
  const int64_t mean = static_cast<int64_t>(start.sad) * kFine / std::max<int64_t>(pixels, 1);
  const auto limit = static_cast<int>(std::min<int64_t>(kFitFactor * mean + kLeastLimit, kNoLimit));
  const int unit = kFine / kMotionUnit;
  const Point origin{start.dx * unit, start.dy * unit};
  Point d = origin;
  for (int step = 0; step < kSteps; ++step) {
    const Point move = solve(sumNormals(parts, luma, previous, d, limit));
    if (move == Point{}) break;
    d = {std::clamp(d.x + move.x, origin.x - kFine + 1, origin.x + kFine - 1),
         std::clamp(d.y + move.y, origin.y - kFine + 1, origin.y + kFine - 1)};
  }
  return {static_cast<int>(divideRounded(d.x, unit)), static_cast<int>(divideRounded(d.y, unit))};
}

}  // namespace rg
