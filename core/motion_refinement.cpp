// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/motion_refinement.hpp"

#include "core/pixel.hpp"

#include <algorithm>
#include <bit>
#include <cstdlib>

namespace rg {
namespace {

constexpr int kFineBits = 8;  // Positions while refining: 1/256 px.
constexpr int kFine = 1 << kFineBits;
constexpr int kSteps = 4;
/// Added to the gradients of each pixel, squared: keeps steps small where there are none.
constexpr int64_t kNoise = 4;
/// Pixels fit when their residual is at most so many times the mean, and kLeastLimit more.
constexpr int64_t kFitFactor = 3;
constexpr int64_t kLeastLimit = 2 * kFine;

/// Of the pixels that fit: sums of products of gradients (gx, gy: differences over 2 px) and of
/// gradients with the residual (in 1/256 grey levels).
struct NormalSums {
  int64_t xx = 0, xy = 0, yy = 0, xr = 0, yr = 0;
  int64_t pixels = 0;
};

struct Sampler {
  Point whole;        ///< Where pixel (0, 0) is looked at in the previous picture.
  int fractionX = 0;  ///< 1/256 px beyond it.
  int fractionY = 0;

  explicit Sampler(Point d)
      : whole{(-d.x) >> kFineBits, (-d.y) >> kFineBits},
        fractionX((-d.x) & (kFine - 1)),
        fractionY((-d.y) & (kFine - 1)) {}

  /// In 1/256 grey levels.
  [[nodiscard]] int at(const PaddedLuma& previous, int x, int y) const {
    const uint8_t* upper = previous.along(x + whole.x, y + whole.y);
    const uint8_t* lower = previous.along(x + whole.x, y + whole.y + 1);
    const int top = upper[0] * (kFine - fractionX) + upper[1] * fractionX;
    const int bottom = lower[0] * (kFine - fractionX) + lower[1] * fractionX;
    return (top * (kFine - fractionY) + bottom * fractionY) >> kFineBits;
  }
};

void addPart(const MatchedPart& part, ImageView<const uint8_t> luma, const PaddedLuma& previous,
             const Sampler& sampler, int limit, NormalSums& sums) {
  forBlocks(part, [&](int x0, int y) {
    if (y == 0 || y == luma.height() - 1) return;
    const uint8_t *row = luma.row(y), *above = luma.row(y - 1), *below = luma.row(y + 1);
    const int xEnd = std::min(x0 + kBlockWidth, luma.width() - 1);
    for (int x = std::max(x0, 1); x < xEnd; ++x) {
      const int residual = row[x] * kFine - sampler.at(previous, x, y);
      if (std::abs(residual) > limit) continue;
      const int gx = row[x + 1] - row[x - 1], gy = below[x] - above[x];
      sums.xx += gx * gx;
      sums.xy += gx * gy;
      sums.yy += gy * gy;
      sums.xr += gx * residual;
      sums.yr += gy * residual;
      ++sums.pixels;
    }
  });
}

/// The step that the fitting pixels ask for, in 1/256 px. Sums are scaled down together to 30 bits,
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
  const auto limit = static_cast<int>(kFitFactor * mean + kLeastLimit);
  const int unit = kFine / kMotionUnit;
  const Point origin{start.dx * unit, start.dy * unit};
  Point d = origin;
  for (int step = 0; step < kSteps; ++step) {
    NormalSums sums;
    const Sampler sampler(d);
    for (const MatchedPart& part : parts) addPart(part, luma, previous, sampler, limit, sums);
    const Point move = solve(sums);
    if (move == Point{}) break;
    d = {std::clamp(d.x + move.x, origin.x - kFine + 1, origin.x + kFine - 1),
         std::clamp(d.y + move.y, origin.y - kFine + 1, origin.y + kFine - 1)};
  }
  return {static_cast<int>(divideRounded(d.x, unit)), static_cast<int>(divideRounded(d.y, unit))};
}

}  // namespace rg
