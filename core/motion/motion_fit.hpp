// SPDX-License-Identifier: LGPL-2.1-or-later
// A region's motion to a fraction of a pixel, by least squares over its pixels (part of stage 4).
//
// The motion is taken to be linear in the position: a vector at the region's centroid, and slopes,
// which tell a turning or slanted surface from a shift that its best textured part would suggest.
// The brightness may change by an amount that the whole region shares. A step solves the normal
// equations of the pixels that fit; each 8x8 cell is seen at one displacement.
// Determinism: integers; blocks of two unknowns are solved in turn, a fixed number of times.
#pragma once

#include "core/motion/fit_moments.hpp"

#include <array>
#include <cstdint>
#include <span>

namespace rg::motion {

/// How narrowly a vector is known: a quadratic form, 1/256 px⁻², below 2^30.
struct Information {
  int64_t xx = 0, xy = 0, yy = 0;
};

struct Step {
  int64_t x = 0, y = 0;
};

/// Solves (xx xy; xy yy) · step = right, 0 where that has no single answer. All numbers are scaled
/// down to 30 bits together, so that the products fit.
[[nodiscard]] Step solveStep(int64_t xx, int64_t xy, int64_t yy, Step right);

/// The lesser of the two eigenvalues.
[[nodiscard]] int64_t leastInformation(const Information& information);

/// What is expected of a vector: that it lies at `at`, so narrowly in each direction.
struct MotionPrior {
  Point at;            ///< 1/256 px.
  int64_t weight = 0;  ///< 1/256 px⁻²; 0 = nothing is expected.
};

/// Whose motion is fitted.
struct FitRegion {
  std::span<const MatchedPart> parts;
  Point centroid;  ///< In pixels.
  int limit = 0;   ///< Of a fitting pixel's residual, 1/256 grey levels.
  int64_t pixels = 0;
};

struct MotionFit {
  Point at;                     ///< At the centroid, 1/256 px.
  std::array<int, 4> slopes{};  ///< Of x along x and y, of y along x and y: 1/256 px per 32 px.
  Information information;
  int64_t misfit = 0;   ///< Mean |residual|, limited: 1/256 grey levels.
  uint32_t pixels = 0;  ///< That fit.
  uint32_t seen = 0;    ///< That lie inside the previous frame, fitting or not.
};

/// At most `steps` steps from `start`, each of less than a pixel, until they are short. information
/// and misfit: before the last.
[[nodiscard]] MotionFit fitMotion(const FitRegion& region, const FitPlane& plane,
                                  const MotionFit& start, const MotionPrior& prior, int steps);

}  // namespace rg::motion
