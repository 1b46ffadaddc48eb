// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/motion/motion_fit.hpp"

#include "core/base/pixel.hpp"

#include <algorithm>
#include <bit>
#include <cstdlib>

namespace rg::motion {
namespace {

constexpr int kUnknowns = 6;
constexpr int kMeanBits = 12;
/// Pixels are not independent: so many say as much as one would.
constexpr int64_t kCorrelation = 8;
/// Least variance of a residual, in 1/256 grey levels squared: that of rounding, and more.
constexpr int64_t kLeastVariance = 128;
/// Added to the squared gradient of each pixel, per mean: keeps steps small where there are none.
constexpr int64_t kFlat = int64_t{4} << kMeanBits;
/// Slopes are expected to be 0 within 0.3 px per 32 px.
constexpr int64_t kSlopeWeight = 2844;
/// A shared change of brightness is believed as if so many pixels had seen none.
constexpr int64_t kSteadyPixels = 16;
constexpr int kTurns = 3;
/// A step of which nothing is larger is the last one: 1/32 px, also of the slopes per 32 px.
constexpr int64_t kSettled = kFine / 32;

using Row = std::array<int64_t, kUnknowns>;

// Unknowns: x, y, then x along X and Y, then y along X and Y. Those of x go with the gradient gx,
// those of y with gy.
constexpr std::array<bool, kUnknowns> kIsY = {false, true, false, false, true, true};
/// What of the place an unknown goes with: 0 = nothing, 1 = x, 2 = y.
constexpr std::array<size_t, kUnknowns> kPlace = {0, 0, 1, 2, 1, 2};

int64_t productOf(const FitMoments& moments, size_t i, size_t j) {
  constexpr size_t kProduct[3][3] = {{0, 1, 2}, {1, 3, 4}, {2, 4, 5}};
  const auto& products = kIsY[i] != kIsY[j] ? moments.xy : kIsY[i] ? moments.yy : moments.xx;
  return products[kProduct[kPlace[i]][kPlace[j]]];
}

/// Means in 1/4096, positions in units of 32 px.
struct Equations {
  std::array<Row, kUnknowns> products{};
  Row right{};           ///< In 1/256 px times products.
  int64_t variance = 0;  ///< Of a fitting pixel, 1/256 grey levels squared.
};

int64_t meanOf(int64_t sum, int64_t count, int places) {
  const int64_t unit = int64_t{1} << kMeanBits;
  const int64_t scaled = std::abs(sum) < (int64_t{1} << 50)
                             ? sum * unit / count
                             : sum / std::max<int64_t>(count / unit, 1);
  return scaled / (places == 0 ? 1 : places == 1 ? kSlopeUnitPx : kSlopeUnitPx * kSlopeUnitPx);
}

// The shared change of brightness is eliminated: it takes the means out of all products.
Equations normalise(const FitMoments& moments) {
  Equations e;
  const int64_t count = std::max<int64_t>(moments.pixels, 1);
  const auto places = [](size_t i) { return i < 2 ? 0 : 1; };
  const int64_t known = count * 256 / (count + kSteadyPixels);
  Row gradient{};
  for (size_t i = 0; i < kUnknowns; ++i)
    gradient[i] = meanOf((kIsY[i] ? moments.y : moments.x)[kPlace[i]], count, places(i));
  const int64_t residual = meanOf(moments.r, count, 0);
  const auto common = [&](int64_t a, int64_t b) { return ((a * b) >> kMeanBits) * known / 256; };
  for (size_t i = 0; i < kUnknowns; ++i) {
    for (size_t j = i; j < kUnknowns; ++j) {
      e.products[i][j] = meanOf(productOf(moments, i, j), count, places(i) + places(j)) -
                         common(gradient[i], gradient[j]);
      e.products[j][i] = e.products[i][j];
    }
    const int64_t product = (kIsY[i] ? moments.yr : moments.xr)[kPlace[i]];
    e.right[i] = -2 * (meanOf(product, count, places(i)) - common(gradient[i], residual));
  }
  // A residual in 1/256 squared is 2^16 of a grey level squared.
  const int64_t mean = residual >> kMeanBits;
  e.variance = std::max(moments.rr / count - (mean * mean >> 8) * known / 256, kLeastVariance);
  return e;
}

/// By how many bits a number is wider than `bits`.
int excessBits(int64_t number, int bits) {
  return std::max(0, static_cast<int>(std::bit_width(static_cast<uint64_t>(number))) - bits);
}

/// So much of the weight falls on a pixel, in the products' unit.
int64_t perPixel(int64_t weight, int64_t variance, int64_t pixels) {
  return 2 * weight * variance / std::max<int64_t>(pixels, 1);
}

Row solve(const Equations& e) {
  Row step{};
  for (int turn = 0; turn < kTurns; ++turn)
    for (size_t i = 0; i < kUnknowns; i += 2) {
      Step right{e.right[i], e.right[i + 1]};
      for (size_t j = 0; j < kUnknowns; ++j) {
        if (j / 2 == i / 2) continue;
        right.x -= e.products[i][j] * step[j];
        right.y -= e.products[i + 1][j] * step[j];
      }
      const Step result =
          solveStep(e.products[i][i], e.products[i][i + 1], e.products[i + 1][i + 1], right);
      const auto bounded = [](int64_t d) { return std::clamp<int64_t>(d, -kFine, kFine); };
      step[i] = bounded(result.x);
      step[i + 1] = bounded(result.y);
    }
  return step;
}

void addExpectations(const MotionFit& fit, const MotionPrior& prior, int64_t pixels, Equations& e) {
  const int64_t weight = perPixel(prior.weight, e.variance, pixels);
  e.products[0][0] += kFlat + weight;
  e.products[1][1] += kFlat + weight;
  e.right[0] += weight * (prior.at.x - fit.at.x);
  e.right[1] += weight * (prior.at.y - fit.at.y);
  const int64_t flatness = perPixel(kSlopeWeight, e.variance, pixels);
  for (size_t i = 2; i < kUnknowns; ++i) {
    e.products[i][i] += flatness;
    e.right[i] -= flatness * fit.slopes[i - 2];
  }
}

bool isSettled(const Row& step) {
  return std::all_of(step.begin(), step.end(), [](int64_t d) { return std::abs(d) <= kSettled; });
}

/// Of at most 30 bits, its shape kept.
Information informationOf(const Equations& e, int64_t pixels) {
  constexpr int kMostBits = 30;
  const auto known = [&](int64_t product) {
    return pixels * product / (kCorrelation * e.variance / 4);
  };
  const Information i{known(e.products[0][0]), known(e.products[0][1]), known(e.products[1][1])};
  const int shift = excessBits(std::max(i.xx, i.yy), kMostBits);
  return {i.xx >> shift, i.xy >> shift, i.yy >> shift};
}

}  // namespace

Step solveStep(int64_t xx, int64_t xy, int64_t yy, Step right) {
  const int shift = excessBits(std::max({xx, yy, std::abs(right.x), std::abs(right.y)}), 30);
  const int64_t a = xx >> shift, b = xy >> shift, c = yy >> shift;
  const int64_t u = right.x >> shift, v = right.y >> shift;
  const int64_t determinant = a * c - b * b;
  if (determinant <= 0) return {};
  return {divideRounded(c * u - b * v, determinant), divideRounded(a * v - b * u, determinant)};
}

int64_t leastInformation(const Information& i) {
  if (i.xx == 0 || i.yy == 0) return 0;
  const int64_t sum = i.xx + i.yy, diff = i.xx - i.yy;
  const auto root = static_cast<int64_t>(
      integerSqrt(static_cast<uint64_t>(diff * diff) + 4 * static_cast<uint64_t>(i.xy * i.xy)));
  return std::max<int64_t>(sum - root, 0) / 2;
}

MotionFit fitMotion(const FitRegion& region, const FitPlane& plane, const MotionFit& start,
                    const MotionPrior& prior, int steps) {
  MotionFit fit = start;
  const int most = plane.previous->reach() * kFine;
  const auto moved = [&](int at, int64_t by, int origin) {
    return std::clamp(at + static_cast<int>(by), std::max(origin - kFine * 3 / 2, -most),
                      std::min(origin + kFine * 3 / 2, most));
  };
  for (int i = 0; i < steps; ++i) {
    const FitMoments moments =
        sumMoments(region.parts, plane, {fit.at, fit.slopes, region.centroid}, region.limit);
    Equations equations = normalise(moments);
    fit.pixels = static_cast<uint32_t>(moments.pixels);
    fit.seen = static_cast<uint32_t>(moments.seen);
    fit.misfit = moments.misfit / std::max<int64_t>(moments.seen, 1);
    fit.information = informationOf(equations, moments.pixels);
    addExpectations(fit, prior, moments.pixels, equations);
    const Row step = solve(equations);
    fit.at = {moved(fit.at.x, step[0], start.at.x), moved(fit.at.y, step[1], start.at.y)};
    for (size_t s = 0; s < fit.slopes.size(); ++s)
      fit.slopes[s] = std::clamp(fit.slopes[s] + static_cast<int>(step[s + 2]), -kFine, kFine);
    if (isSettled(step)) break;
  }
  return fit;
}

}  // namespace rg::motion
