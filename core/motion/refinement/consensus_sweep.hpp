// SPDX-License-Identifier: LGPL-2.1-or-later
// A region's turn in the search for a consensus (part of stage 4): one arithmetic for the CPU and
// for devices.
// Determinism: integers; a sweep reads what the sweep before wrote.
#pragma once

#include "core/motion/refinement/fit_step.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace rg::motion {

/// What a region saw of its own motion.
struct SeenMotion {
  Point at;                 ///< 1/256 px.
  Information information;  ///< All 0: nothing.
};

struct MotionNeighbour {
  uint32_t region = 0;
  int32_t weight = 0;  ///< A share of 2^16.
};
/// Vectors that regions come to.
struct MotionBelief {
  Point at;
  int32_t trust = 0;  ///< 0 … 256.
};

/// What a sweep reads and writes. Of region i: neighbours[starts[i]] and counts[i] − 1 behind it,
/// the [i] of the others.
struct ConsensusSweep {
  const uint32_t *starts, *counts;
  const MotionNeighbour* neighbours;
  const SeenMotion* own;
  const int32_t* ownTrust;
  const MotionBelief* before;
  MotionBelief* after;
  MotionPrior* priors;  ///< Stay as they are where nobody expects anything.

  [[nodiscard]] constexpr const MotionNeighbour& neighbour(size_t region, uint32_t i) const {
    return neighbours[starts[region] + i];
  }
};

inline constexpr uint32_t kMostNeighbours = 16;
/// Bounds on the time: of more than 8192 regions fewer sweeps are made, among fewer neighbours.
inline constexpr size_t kMostSweeps = 8, kMostVisits = 65536;
[[nodiscard]] constexpr size_t sweepsFor(size_t regions) {
  const size_t sweeps = kMostVisits / (regions == 0 ? 1 : regions);
  return sweeps < 1 ? 1 : sweeps < kMostSweeps ? sweeps : kMostSweeps;
}

// No references to constants: a device has none of the host's.
namespace detail {
inline constexpr int64_t kOne = 256;
/// Neighbours are expected to differ by half a pixel: a weight of 4 px⁻².
inline constexpr int64_t kLikeness = 4 * kOne;
/// Neighbours a pixel apart agree half.
inline constexpr int64_t kAgreement = int64_t{kFine} * kFine;
inline constexpr int64_t kLeastTrust = 3;
inline constexpr int64_t kFarthest = int64_t{2} * kMostReach * kFine;

/// kOne where the points are one, half of it where they are a pixel apart.
[[nodiscard]] constexpr int64_t agreement(Point a, Point b) {
  const int64_t dx = a.x - b.x, dy = a.y - b.y;
  return kOne * kAgreement / (kAgreement + dx * dx + dy * dy);
}

/// weight / (weight + unit), of kOne.
[[nodiscard]] constexpr int32_t trustOf(int64_t weight, int64_t unit) {
  return static_cast<int32_t>(kOne * weight / (weight + unit));
}

/// The vector between the two that both together ask for.
[[nodiscard]] constexpr Point combine(const SeenMotion& own, const MotionPrior& prior) {
  const Information& i = own.information;
  const Step step = solveStep(i.xx + prior.weight, i.xy, i.yy + prior.weight,
                              {i.xx * (own.at.x - prior.at.x) + i.xy * (own.at.y - prior.at.y),
                               i.xy * (own.at.x - prior.at.x) + i.yy * (own.at.y - prior.at.y)});
  const auto moved = [](int at, int64_t by) {
    return at + static_cast<int>(by < -kFarthest ? -kFarthest : by > kFarthest ? kFarthest : by);
  };
  return {moved(prior.at.x, step.x), moved(prior.at.y, step.y)};
}
}  // namespace detail

/// How far what a region saw itself can be trusted, 0 … 256.
[[nodiscard]] constexpr int32_t ownTrustOf(const SeenMotion& own) {
  return detail::trustOf(leastInformation(own.information), detail::kLikeness);
}

/// How much a vector is at odds with what the region saw and what its neighbours have; below 2^26.
[[nodiscard]] constexpr int64_t disagreement(const ConsensusSweep& s, size_t region, Point at) {
  using namespace detail;
  constexpr int64_t kOwnShare = 77;  // Of kOne: 0.3.
  const SeenMotion& own = s.own[region];
  const int64_t dx = at.x - own.at.x, dy = at.y - own.at.y;
  const Information& i = own.information;
  // Quadratic form in units of kLikeness, 2^16 = one px².
  const int64_t form = (i.xx * dx * dx + 2 * i.xy * dx * dy + i.yy * dy * dy) / kLikeness;
  int64_t sum = kOwnShare * trustOf(larger(form, 0), kAgreement) * kOne;
  for (uint32_t k = 0; k < s.counts[region]; ++k) {
    const MotionNeighbour& n = s.neighbour(region, k);
    const MotionBelief& belief = s.before[n.region];
    sum += n.weight * (belief.trust + kLeastTrust) / kOne * (kOne - agreement(at, belief.at));
  }
  return sum;
}

/// The vectors round a centre, and how much they weigh.
struct ConsensusSums {
  int64_t weight = 0, x = 0, y = 0;
};
constexpr void addNeighbour(const ConsensusSweep& s, const MotionNeighbour& n, Point centre,
                            ConsensusSums& sums) {
  using namespace detail;
  const MotionBelief& belief = s.before[n.region];
  const int64_t fit = agreement(centre, belief.at);
  const int64_t share = n.weight * (belief.trust + kLeastTrust) / kOne * fit / kOne * fit / kOne;
  sums.weight += share;
  sums.x += share * (belief.at.x - centre.x);
  sums.y += share * (belief.at.y - centre.y);
}

/// Writes what a region expects and believes after the sweep.
constexpr void conclude(const ConsensusSweep& s, size_t region, Point centre,
                        const ConsensusSums& sums) {
  using namespace detail;
  MotionBelief after = s.before[region];
  if (sums.weight != 0) {
    const Point mean{centre.x + static_cast<int>(divideRounded(sums.x, sums.weight)),
                     centre.y + static_cast<int>(divideRounded(sums.y, sums.weight))};
    // Shares of kOne² to 1/256 px⁻².
    const int64_t expected = larger(sums.weight * kLikeness / (kOne * kOne), 1);
    const MotionPrior prior{mean, expected};
    s.priors[region] = prior;
    after.at = combine(s.own[region], prior);
    const int32_t own = s.ownTrust[region];
    const int64_t known = kLikeness * own / (kOne + 1 - own);
    after.trust = trustOf(known + expected * 7 / 10, kLikeness);
  }
  s.after[region] = after;
}

}  // namespace rg::motion
