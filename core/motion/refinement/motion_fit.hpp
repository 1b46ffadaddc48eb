// SPDX-License-Identifier: LGPL-2.1-or-later
// A region's motion to a fraction of a pixel, by least squares over its pixels (part of stage 4).
//
// The motion is taken to be linear in the position: a vector at the region's centroid, and slopes,
// which tell a turning or slanted surface from a shift that its best textured part would suggest.
// The brightness may change by an amount that the whole region shares. A step
// (core/motion/refinement/fit_step.hpp) solves the normal equations of the pixels that fit; each
// 8x8 cell is seen at one displacement.
#pragma once

#include "core/motion/refinement/fit_step.hpp"

#include <span>

namespace rg::motion {

/// Whose motion is fitted.
struct FitRegion {
  std::span<const MatchedPart> parts;
  Point centroid;  ///< In pixels.
  int limit = 0;   ///< Of a fitting pixel's residual, 1/256 grey levels.
};

/// At most `steps` steps from `start`, each of less than a pixel, until they are short. information
/// and misfit: before the last.
[[nodiscard]] MotionFit fitMotion(const FitRegion& region, const FitPlane& plane,
                                  const MotionFit& start, const MotionPrior& prior, int steps);

}  // namespace rg::motion
