// SPDX-License-Identifier: LGPL-2.1-or-later
// From the sums over a region's pixels to a step of the fit of its motion (part of stage 4): one
// arithmetic for the CPU, which does all in turn, and for devices, where threads share it.
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
  FitMoments means;  ///< In the moments' places: see detail::meanOf().
  std::array<Unknowns, kUnknowns> products;
  Unknowns right;  ///< In 1/256 px times products.
  Unknowns step;
  Information information;  ///< Of any width.
  int64_t priorWeight, slopeWeight;
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

/// What stands for moment number `i` in FitEquations::means: of misfits and squared residuals the
/// mean as it is; of the pixels, how well a shared change of brightness is known, in 1/256.
[[nodiscard]] constexpr int64_t meanOf(const FitMoments& moments, size_t i) {
  const int64_t sum = momentOf(moments, i);
  const int64_t count = larger(moments.pixels, 1);
  if (i < 18) return meanOf(sum, count, i % 6 == 0 ? 0 : i % 6 < 3 ? 1 : 2);
  if (i < 30) return meanOf(sum, count, i % 3 == 0 ? 0 : 1);
  if (i == 30) return count * 256 / (count + kSteadyPixels);
  if (i == 31) return sum;
  if (i == 32) return meanOf(sum, count, 0);
  return i == 33 ? sum / count : sum / larger(moments.seen, 1);
}

/// What a shared change of brightness explains of a product: it is eliminated.
[[nodiscard]] constexpr int64_t shared(const FitMoments& means, int64_t a, int64_t b) {
  return ((a * b) >> kMeanBits) * means.pixels / 256;
}
[[nodiscard]] constexpr int64_t gradientOf(const FitMoments& means, size_t unknown) {
  return isOfY(unknown) ? means.y[placeOf(unknown)] : means.x[placeOf(unknown)];
}
[[nodiscard]] constexpr int64_t productOf(const FitEquations& e, size_t i, size_t j) {
  return productOf(e.means, i, j) - shared(e.means, gradientOf(e.means, i), gradientOf(e.means, j));
}
[[nodiscard]] constexpr int64_t rightOf(const FitEquations& e, size_t i) {
  const int64_t product = isOfY(i) ? e.means.yr[placeOf(i)] : e.means.xr[placeOf(i)];
  return -2 * (product - shared(e.means, gradientOf(e.means, i), e.means.r));
}
/// Of a fitting pixel, 1/256 grey levels squared.
[[nodiscard]] constexpr int64_t varianceOf(const FitMoments& means) {
  // A residual in 1/256 squared is 2^16 of a grey level squared.
  const int64_t mean = means.r >> kMeanBits;
  return larger(means.rr - (mean * mean >> 8) * means.pixels / 256, kLeastVariance);
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

/// What is known of a product of the unknowns x and y.
[[nodiscard]] constexpr int64_t informationOf(int64_t product, int64_t variance, int64_t pixels) {
  return pixels * product / (kCorrelation * variance / 4);
}
/// Of at most 30 bits, its shape kept.
[[nodiscard]] constexpr Information narrowed(const Information& i) {
  constexpr int kMostBits = 30;
  const int shift = excessBits(larger(i.xx, i.yy), kMostBits);
  return {i.xx >> shift, i.xy >> shift, i.yy >> shift};
}
}  // namespace detail

/// Solves (xx xy; xy yy) · step = right for the step's x (unknown 0) or y (1), 0 where that has no
/// single answer. All numbers are scaled down to 30 bits together, so that the products fit.
[[nodiscard]] constexpr int64_t solveFor(size_t unknown, int64_t xx, int64_t xy, int64_t yy,
                                         const Step& right) {
  using detail::larger, detail::magnitude;
  const int shift = detail::excessBits(
      larger(larger(xx, yy), larger(magnitude(right.x), magnitude(right.y))), 30);
  const int64_t a = xx >> shift, b = xy >> shift, c = yy >> shift;
  const int64_t u = right.x >> shift, v = right.y >> shift;
  const int64_t determinant = a * c - b * b;
  if (determinant <= 0) return 0;
  return divideRounded(unknown == 0 ? c * u - b * v : a * v - b * u, determinant);
}
[[nodiscard]] constexpr Step solveStep(int64_t xx, int64_t xy, int64_t yy, const Step& right) {
  return {solveFor(0, xx, xy, yy, right), solveFor(1, xx, xy, yy, right)};
}

/// The lesser of the two eigenvalues.
[[nodiscard]] constexpr int64_t leastInformation(const Information& i) {
  if (i.xx == 0 || i.yy == 0) return 0;
  const int64_t sum = i.xx + i.yy, diff = i.xx - i.yy;
  const auto root = static_cast<int64_t>(
      integerSqrt(static_cast<uint64_t>(diff * diff) + 4 * static_cast<uint64_t>(i.xy * i.xy)));
  return detail::larger(sum - root, 0) / 2;
}

/// Where a fit comes from, and how far it may go.
struct FitStart {
  Point at;       ///< 1/256 px; from there less than 1.5 px.
  int reach = 0;  ///< Of the plane, in pixels.
};

/// A step of a fit by what was summed up at it, in parts that follow each other; the pieces of a
/// part come in any order, or at once.
struct FitStep {
  const FitMoments& moments;
  FitStart start;
  const MotionPrior& prior;
  FitEquations& e;  ///< Scratch.
  MotionFit& fit;   ///< Gets the step; information, misfit, pixels and seen are those of before it.

  static constexpr int kSolved = 4, kBlocks = kUnknowns / 2;
  static constexpr int kLast = kSolved + detail::kTurns * kBlocks, kParts = kLast + 1;

  [[nodiscard]] static constexpr size_t piecesOf(int part) {
    if (part == 0) return kMoments;
    if (part == 1) return kUnknowns * (kUnknowns + 1);
    if (part == 2) return 5;
    if (part == 3) return kUnknowns;
    return part < kLast ? 2 : kUnknowns + 1;
  }
  constexpr void run(int part, size_t piece) const {
    if (part == 0)
      momentOf(e.means, piece) = detail::meanOf(moments, piece);
    else if (part == 1)
      setUp(piece);
    else if (part == 2)
      weigh(piece);
    else if (part == 3)
      expect(piece);
    else if (part < kLast)
      solve(static_cast<size_t>((part - kSolved) % kBlocks) * 2, piece);
    else
      move(piece);
  }
  /// After all parts: whether the step was short enough to be the last one.
  [[nodiscard]] constexpr bool isSettled() const {
    bool isShort = true;
    for (size_t i = 0; i < kUnknowns; ++i)
      isShort = isShort && detail::magnitude(e.step[i]) <= detail::kSettled;
    return isShort;
  }

 private:
  constexpr void setUp(size_t piece) const {
    const size_t row = piece / kUnknowns, i = piece % kUnknowns;
    if (row < kUnknowns)
      e.products[row][i] = detail::productOf(e, row, i);
    else
      e.right[i] = detail::rightOf(e, i);
  }
  constexpr void weigh(size_t piece) const {
    const int64_t variance = detail::varianceOf(e.means), pixels = moments.pixels;
    const auto known = [&](int64_t product) {
      return detail::informationOf(product, variance, pixels);
    };
    if (piece == 0) e.information.xx = known(e.products[0][0]);
    if (piece == 1) e.information.xy = known(e.products[0][1]);
    if (piece == 2) e.information.yy = known(e.products[1][1]);
    if (piece == 3) e.priorWeight = detail::perPixel(prior.weight, variance, pixels);
    if (piece == 4) e.slopeWeight = detail::perPixel(detail::kSlopeWeight, variance, pixels);
  }
  constexpr void expect(size_t i) const {
    const int64_t weight = i < 2 ? e.priorWeight : e.slopeWeight;
    e.products[i][i] += weight + (i < 2 ? detail::kFlat : 0);
    e.right[i] += weight * (i == 0   ? prior.at.x - fit.at.x
                            : i == 1 ? prior.at.y - fit.at.y
                                     : -fit.slopes[i - 2]);
    e.step[i] = 0;
  }
  /// For one of two unknowns, with the others as they are.
  constexpr void solve(size_t first, size_t piece) const {
    Step right{e.right[first], e.right[first + 1]};
    for (size_t j = 0; j < kUnknowns; ++j) {
      if (j / 2 == first / 2) continue;
      right.x -= e.products[first][j] * e.step[j];
      right.y -= e.products[first + 1][j] * e.step[j];
    }
    const int64_t solved = solveFor(piece, e.products[first][first], e.products[first][first + 1],
                                    e.products[first + 1][first + 1], right);
    e.step[first + piece] = std::clamp<int64_t>(solved, -kFine, kFine);
  }
  constexpr void move(size_t piece) const {
    const int most = start.reach * kFine;
    const auto moved = [&](int at, int64_t by, int origin) {
      const int near =
          std::clamp(at + static_cast<int>(by), origin - kFine * 3 / 2, origin + kFine * 3 / 2);
      return std::clamp(near, -most, most);
    };
    if (piece == 0) fit.at.x = moved(fit.at.x, e.step[0], start.at.x);
    if (piece == 1) fit.at.y = moved(fit.at.y, e.step[1], start.at.y);
    if (piece >= 2 && piece < kUnknowns) {
      int& slope = fit.slopes[piece - 2];
      slope = std::clamp(slope + static_cast<int>(e.step[piece]), -kFine, +kFine);
    }
    if (piece < kUnknowns) return;
    fit.information = detail::narrowed(e.information);
    fit.misfit = e.means.misfit;
    fit.pixels = static_cast<uint32_t>(moments.pixels);
    fit.seen = static_cast<uint32_t>(moments.seen);
  }
};

}  // namespace rg::motion
