// SPDX-License-Identifier: LGPL-2.1-or-later
// What is fitted of a region, and which of its fits counts (part of stage 4): one arithmetic for
// the CPU and for devices.
#pragma once

#include "core/base/pixel.hpp"
#include "core/motion/motion.hpp"
#include "core/motion/refinement/consensus_sweep.hpp"

#include <cstdint>

namespace rg::motion {

inline constexpr int kTrialSteps = 2, kOwnSteps = 2, kPriorSteps = 3;
inline constexpr int kFinePerUnit = kFine / kMotionUnit;

/// A region before its motion is fitted.
struct RefinedRegion {
  Point centroid;  ///< In pixels.
  Point at;        ///< Its vector so far, 1/256 px.
  int limit = 0;   ///< Of a fitting pixel's residual, 1/256 grey levels.
  int pixels = 0;  ///< That are matched.
  int reliability = 0;
  uint8_t isFound = 0;  ///< Not kNotMatched.
};

/// centroid: in 1/256 px, as the graph has it. pixels: that are matched.
[[nodiscard]] constexpr RefinedRegion refinedRegion(const RegionMotion& motion, Point centroid,
                                                    uint32_t pixels) {
  // Pixels fit when their residual is at most so many times the mean, and kLeastLimit more.
  constexpr int64_t kFitFactor = 3, kLeastLimit = 2 * kFine;
  RefinedRegion region{{centroid.x >> 8, centroid.y >> 8},
                       {motion.dx * kFinePerUnit, motion.dy * kFinePerUnit},
                       0,
                       static_cast<int>(pixels),
                       motion.reliability,
                       1};
  if (motion.sad == kNotMatched) region.isFound = 0;
  const int64_t mean = static_cast<int64_t>(motion.sad) * kFine / detail::larger(region.pixels, 1);
  const int64_t limit = kFitFactor * mean + kLeastLimit;
  region.limit = limit < kMostLimit ? static_cast<int>(limit) : kMostLimit + 0;
  return region;
}

[[nodiscard]] constexpr int64_t squaredDistance(Point a, Point b) {
  const int64_t dx = a.x - b.x, dy = a.y - b.y;
  return dx * dx + dy * dy;
}

/// What a region says of its motion, of its own.
[[nodiscard]] constexpr SeenMotion seenMotion(const MotionFit& fit, int reliability) {
  const Information& known = fit.information;
  const int64_t trust = reliability;
  return {fit.at,
          {known.xx * trust / kFullReliability, known.xy * trust / kFullReliability,
           known.yy * trust / kFullReliability}};
}

/// A consensus nearer than 1/8 px needs no fit of its own.
[[nodiscard]] constexpr bool asksForFit(const MotionFit& own, const MotionPrior& prior) {
  constexpr int64_t kNear = kFine / 8;
  return prior.weight != 0 && squaredDistance(own.at, prior.at) > kNear * kNear;
}

/// By how much a misfit may differ by chance: it shrinks with the number of pixels, but where
/// another shift matches nearly as well, the surface of sums says little at all.
[[nodiscard]] constexpr int64_t slackOf(const MotionFit& own, const MotionPrior& prior,
                                        int reliability) {
  constexpr int64_t kChance = 12, kFull = 4 * 256;
  constexpr int kAmbiguous = kFullReliability / 10;
  const auto root =
      static_cast<int64_t>(integerSqrt(uint64_t{256} * 256 * (own.pixels == 0 ? 1 : own.pixels)));
  const int64_t ambiguous = detail::larger(0, kAmbiguous - reliability) * 256 / (10 * kAmbiguous);
  const int64_t share = kChance * 256 * 256 / root + ambiguous;
  const int64_t weight = prior.weight < kFull ? prior.weight : kFull + 0;
  return (own.misfit + kFine) * share / 256 * weight / kFull;
}

/// The consensus wins where it explains the pixels as well as the region's own vector does, up to
/// what chance leaves. own: of the region alone; mine and theirs: from there and from the prior.
[[nodiscard]] constexpr bool isTheirsBetter(const MotionFit& own, const MotionFit& mine,
                                            const MotionFit& theirs, const MotionPrior& prior,
                                            int reliability) {
  const int64_t slack = slackOf(own, prior, reliability);
  // What of the slack a vector has used up by its distance from the prior, half of it at 1 px.
  const auto cost = [&](const MotionFit& fit) {
    const int64_t distance = squaredDistance(fit.at, prior.at);
    return fit.misfit + slack * distance / (distance + int64_t{kFine} * kFine);
  };
  return cost(theirs) <= cost(mine);
}

/// A reliability, now that the pixels have been fitted: up to kGain times as much where they fit,
/// little where they don't, less where the neighbours expect another vector, if only so far:
/// neighbours of another object do so rightly. None where more than a quarter of the region has no
/// match inside the previous frame.
[[nodiscard]] constexpr int judge(const RefinedRegion& region, const MotionFit& fit,
                                  const MotionPrior& prior) {
  constexpr int64_t kMisfit = kFine * 3 / 2, kGain = 4, kQuarter = kFine / 4, kHalf = kFine / 2;
  if (region.reliability == 0) return 0;
  if (fit.seen * int64_t{4} < region.pixels * int64_t{3}) return 0;
  int64_t left = kGain * region.reliability;
  for (int i = 0; i < 2; ++i) left = left * kMisfit / (kMisfit + fit.misfit);
  if (prior.weight > 0) {
    const auto apart =
        static_cast<int64_t>(integerSqrt(static_cast<uint64_t>(squaredDistance(fit.at, prior.at))));
    left = left * kQuarter / (kQuarter + (apart < kHalf ? apart : kHalf + 0));
  }
  return left < kFullReliability ? static_cast<int>(left) : kFullReliability + 0;
}

/// `fit`: the last one. A region of which nothing is matched moves as its neighbours expect.
constexpr void takeOver(const RefinedRegion& region, MotionFit fit, const MotionPrior& prior,
                        RegionMotion& motion) {
  if (region.pixels == 0 && prior.weight > 0) fit.at = prior.at;
  motion.reliability = static_cast<uint16_t>(judge(region, fit, prior));
  motion.dx = static_cast<int>(divideRounded(fit.at.x, kFinePerUnit));
  motion.dy = static_cast<int>(divideRounded(fit.at.y, kFinePerUnit));
}

}  // namespace rg::motion
