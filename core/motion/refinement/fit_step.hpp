// SPDX-License-Identifier: LGPL-2.1-or-later
// From the sums over a region's pixels to a step of the fit of its motion (part of stage 4): one
// arithmetic for the CPU and for devices.
// Determinism: integers; blocks of two unknowns are solved in turn, a fixed number of times.
#pragma once

#include "core/base/pixel.hpp"
#include "core/motion/fit_moments.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace rg::motion {

/// How narrowly a vector is known: a quadratic form, 1/256 px⁻², below 2^30.
struct Information {
  int64_t xx = 0, xy = 0, yy = 0;
};

struct Step {
  int64_t x = 0, y = 0;
};

/// What is expected of a vector: that it lies at `at`, so narrowly in each direction.
struct MotionPrior {
  Point at;            ///< 1/256 px.
  int64_t weight = 0;  ///< 1/256 px⁻²; 0 = nothing is expected.
};

struct MotionFit {
  Point at;                     ///< At the centroid, 1/256 px.
  std::array<int, 4> slopes{};  ///< Of x along x and y, of y along x and y: 1/256 px per 32 px.
  Information information;
  int64_t misfit = 0;   ///< Mean |residual|, limited: 1/256 grey levels.
  uint32_t pixels = 0;  ///< That fit.
  uint32_t seen = 0;    ///< That lie inside the previous frame, fitting or not.
};

inline constexpr size_t kUnknowns = 6;
using Unknowns = std::array<int64_t, kUnknowns>;

/// Means in 1/4096, positions in units of 32 px. Unknowns: x, y, then x along X and Y, then y along
/// X and Y. Those of x go with the gradient gx, those of y with gy.
struct FitEquations {
  std::array<Unknowns, kUnknowns> products;
  Unknowns right;     ///< In 1/256 px times products.
  Unknowns gradient;  ///< Means.
  Unknowns step;
  int64_t variance;  ///< Of a fitting pixel, 1/256 grey levels squared.
};

// No references to constants and no tables: a device has none of the host's.
namespace detail {
inline constexpr int kMeanBits = 12;
/// Pixels are not independent: so many say as much as one would.
inline constexpr int64_t kCorrelation = 8;
/// Least variance of a residual, in 1/256 grey levels squared: that of rounding, and more.
inline constexpr int64_t kLeastVariance = 128;
/// Added to the squared gradient of each pixel, per mean: keeps steps small where there are none.
inline constexpr int64_t kFlat = int64_t{4} << kMeanBits;
/// Slopes are expected to be 0 within 0.3 px per 32 px.
inline constexpr int64_t kSlopeWeight = 2844;
/// A shared change of brightness is believed as if so many pixels had seen none.
inline constexpr int64_t kSteadyPixels = 16;
inline constexpr int kTurns = 3;
/// A step of which nothing is larger is the last one: 1/32 px, also of the slopes per 32 px.
inline constexpr int64_t kSettled = kFine / 32;

[[nodiscard]] constexpr int64_t larger(int64_t a, int64_t b) {
  return a < b ? b : a;
}
[[nodiscard]] constexpr int64_t magnitude(int64_t value) {
  return value < 0 ? -value : value;
}

[[nodiscard]] constexpr bool isOfY(size_t unknown) {
  return unknown == 1 || unknown >= 4;
}
/// What of the place an unknown goes with: 0 = nothing, 1 = x, 2 = y.
[[nodiscard]] constexpr size_t placeOf(size_t unknown) {
  return unknown < 2 ? 0 : 1 + unknown % 2;
}
[[nodiscard]] constexpr int placesOf(size_t unknown) {
  return unknown < 2 ? 0 : 1;
}
/// Where FitMoments have the product of two places.
[[nodiscard]] constexpr size_t productOf(size_t a, size_t b) {
  return a == 0 || b == 0 ? a + b : a + b + 1;
}
static_assert(productOf(0, 2) == 2 && productOf(1, 1) == 3 && productOf(1, 2) == 4 &&
              productOf(2, 2) == 5);

[[nodiscard]] constexpr int64_t productOf(const FitMoments& moments, size_t i, size_t j) {
  const size_t place = productOf(placeOf(i), placeOf(j));
  if (isOfY(i) != isOfY(j)) return moments.xy[place];
  return isOfY(i) ? moments.yy[place] : moments.xx[place];
}

[[nodiscard]] constexpr int64_t meanOf(int64_t sum, int64_t count, int places) {
  constexpr int64_t kUnit = int64_t{1} << kMeanBits;
  const int64_t scaled =
      magnitude(sum) < (int64_t{1} << 50) ? sum * kUnit / count : sum / larger(count / kUnit, 1);
  return scaled / (places == 0 ? 1 : places == 1 ? kSlopeUnitPx : kSlopeUnitPx * kSlopeUnitPx);
}

/// The shared change of brightness is eliminated: it takes the means out of all products.
constexpr void normalise(const FitMoments& moments, FitEquations& e) {
  const int64_t count = larger(moments.pixels, 1);
  const int64_t known = count * 256 / (count + kSteadyPixels);
  for (size_t i = 0; i < kUnknowns; ++i)
    e.gradient[i] =
        meanOf(isOfY(i) ? moments.y[placeOf(i)] : moments.x[placeOf(i)], count, placesOf(i));
  const int64_t residual = meanOf(moments.r, count, 0);
  const auto common = [&](int64_t a, int64_t b) { return ((a * b) >> kMeanBits) * known / 256; };
  for (size_t i = 0; i < kUnknowns; ++i) {
    for (size_t j = i; j < kUnknowns; ++j) {
      e.products[i][j] = meanOf(productOf(moments, i, j), count, placesOf(i) + placesOf(j)) -
                         common(e.gradient[i], e.gradient[j]);
      e.products[j][i] = e.products[i][j];
    }
    const int64_t product = isOfY(i) ? moments.yr[placeOf(i)] : moments.xr[placeOf(i)];
    e.right[i] = -2 * (meanOf(product, count, placesOf(i)) - common(e.gradient[i], residual));
  }
  // A residual in 1/256 squared is 2^16 of a grey level squared.
  const int64_t mean = residual >> kMeanBits;
  e.variance = larger(moments.rr / count - (mean * mean >> 8) * known / 256, kLeastVariance);
}

/// By how many bits a number is wider than `bits`.
[[nodiscard]] constexpr int excessBits(int64_t number, int bits) {
  const int excess = bitWidth(static_cast<uint64_t>(number)) - bits;
  return excess < 0 ? 0 : excess;
}

/// So much of the weight falls on a pixel, in the products' unit.
[[nodiscard]] constexpr int64_t perPixel(int64_t weight, int64_t variance, int64_t pixels) {
  return 2 * weight * variance / larger(pixels, 1);
}

constexpr void addExpectations(const MotionFit& fit, const MotionPrior& prior, int64_t pixels,
                               FitEquations& e) {
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

/// Of at most 30 bits, its shape kept.
[[nodiscard]] constexpr Information informationOf(const FitEquations& e, int64_t pixels) {
  constexpr int kMostBits = 30;
  const auto known = [&](int64_t product) {
    return pixels * product / (kCorrelation * e.variance / 4);
  };
  const Information i{known(e.products[0][0]), known(e.products[0][1]), known(e.products[1][1])};
  const int shift = excessBits(larger(i.xx, i.yy), kMostBits);
  return {i.xx >> shift, i.xy >> shift, i.yy >> shift};
}
}  // namespace detail

/// Solves (xx xy; xy yy) · step = right, 0 where that has no single answer. All numbers are scaled
/// down to 30 bits together, so that the products fit.
[[nodiscard]] constexpr Step solveStep(int64_t xx, int64_t xy, int64_t yy, Step right) {
  using detail::larger, detail::magnitude;
  const int shift = detail::excessBits(
      larger(larger(xx, yy), larger(magnitude(right.x), magnitude(right.y))), 30);
  const int64_t a = xx >> shift, b = xy >> shift, c = yy >> shift;
  const int64_t u = right.x >> shift, v = right.y >> shift;
  const int64_t determinant = a * c - b * b;
  if (determinant <= 0) return {};
  return {divideRounded(c * u - b * v, determinant), divideRounded(a * v - b * u, determinant)};
}

/// The lesser of the two eigenvalues.
[[nodiscard]] constexpr int64_t leastInformation(const Information& i) {
  if (i.xx == 0 || i.yy == 0) return 0;
  const int64_t sum = i.xx + i.yy, diff = i.xx - i.yy;
  const auto root = static_cast<int64_t>(
      integerSqrt(static_cast<uint64_t>(diff * diff) + 4 * static_cast<uint64_t>(i.xy * i.xy)));
  return detail::larger(sum - root, 0) / 2;
}

/// Into e.step.
constexpr void solve(FitEquations& e) {
  for (size_t i = 0; i < kUnknowns; ++i) e.step[i] = 0;
  for (int turn = 0; turn < detail::kTurns; ++turn)
    for (size_t i = 0; i < kUnknowns; i += 2) {
      Step right{e.right[i], e.right[i + 1]};
      for (size_t j = 0; j < kUnknowns; ++j) {
        if (j / 2 == i / 2) continue;
        right.x -= e.products[i][j] * e.step[j];
        right.y -= e.products[i + 1][j] * e.step[j];
      }
      const Step result =
          solveStep(e.products[i][i], e.products[i][i + 1], e.products[i + 1][i + 1], right);
      e.step[i] = std::clamp<int64_t>(result.x, -kFine, kFine);
      e.step[i + 1] = std::clamp<int64_t>(result.y, -kFine, kFine);
    }
}

/// Where a fit comes from, and how far it may go.
struct FitStart {
  Point at;       ///< 1/256 px; from there less than 1.5 px.
  int reach = 0;  ///< Of the plane, in pixels.
};

/// A step of a fit by what was summed up at it; whether that was short enough to be the last one.
/// information, misfit, pixels and seen are those of before. e: scratch.
constexpr bool takeStep(const FitMoments& moments, const FitStart& start, const MotionPrior& prior,
                        FitEquations& e, MotionFit& fit) {
  detail::normalise(moments, e);
  fit.pixels = static_cast<uint32_t>(moments.pixels);
  fit.seen = static_cast<uint32_t>(moments.seen);
  fit.misfit = moments.misfit / detail::larger(moments.seen, 1);
  fit.information = detail::informationOf(e, moments.pixels);
  detail::addExpectations(fit, prior, moments.pixels, e);
  solve(e);
  const int most = start.reach * kFine;
  const auto moved = [&](int at, int64_t by, int origin) {
    const int near =
        std::clamp(at + static_cast<int>(by), origin - kFine * 3 / 2, origin + kFine * 3 / 2);
    return std::clamp(near, -most, most);
  };
  fit.at = {moved(fit.at.x, e.step[0], start.at.x), moved(fit.at.y, e.step[1], start.at.y)};
  bool isSettled = true;
  for (size_t i = 0; i < kUnknowns; ++i) {
    if (i >= 2)
      fit.slopes[i - 2] =
          std::clamp(fit.slopes[i - 2] + static_cast<int>(e.step[i]), -kFine, +kFine);
    isSettled = isSettled && detail::magnitude(e.step[i]) <= detail::kSettled;
  }
  return isSettled;
}

}  // namespace rg::motion
