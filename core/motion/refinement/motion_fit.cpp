// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/motion/refinement/motion_fit.hpp"

namespace rg::motion {

MotionFit fitMotion(const FitRegion& region, const FitPlane& plane, const MotionFit& start,
                    const MotionPrior& prior, int steps) {
  MotionFit fit = start;
  FitEquations equations{};
  const FitStart from{start.at, plane.previous->reach()};
  for (int i = 0; i < steps; ++i) {
    const FitMoments moments =
        sumMoments(region.parts, plane, {fit.at, fit.slopes, region.centroid}, region.limit);
    const FitStep step{moments, from, prior, equations, fit};
    for (int part = 0; part < FitStep::kParts; ++part)
      for (size_t piece = 0; piece < FitStep::piecesOf(part); ++piece) step.run(part, piece);
    if (step.isSettled()) break;
  }
  return fit;
}

}  // namespace rg::motion
