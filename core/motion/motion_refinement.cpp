// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/motion/motion_refinement.hpp"

#include "core/base/pixel.hpp"

#include <algorithm>
#include <cstdlib>
#include <utility>

namespace rg::motion {
namespace {

constexpr int kTrialSteps = 2;
constexpr int kOwnSteps = 2;
constexpr int kPriorSteps = 3;
/// Pixels fit when their residual is at most so many times the mean, and kLeastLimit more.
constexpr int64_t kFitFactor = 3;
constexpr int64_t kLeastLimit = 2 * kFine;
constexpr int kFinePerUnit = kFine / kMotionUnit;
/// A consensus nearer than that needs no fit of its own: 1/4 px.
constexpr int64_t kNear = kFine / 8;
constexpr int64_t kQuarter = kFine / 4;
constexpr int64_t kHalf = kFine / 2;

int64_t squaredDistance(Point a, Point b) {
  const int64_t dx = a.x - b.x, dy = a.y - b.y;
  return dx * dx + dy * dy;
}

/// A reliability, now that the pixels have been fitted: up to kGain times as much where they fit,
/// little where they don't, less where the neighbours expect another vector, if only so far:
/// neighbours of another object do so rightly. None where more than a quarter of the region has no
/// match inside the previous frame.
int judge(int reliability, const FitRegion& region, const MotionFit& fit,
          const MotionPrior& prior) {
  constexpr int64_t kMisfit = kFine * 3 / 2, kGain = 4;
  if (reliability == 0) return 0;
  if (fit.seen * int64_t{4} < region.pixels * int64_t{3}) return 0;
  int64_t left = kGain * reliability;
  for (int i = 0; i < 2; ++i) left = left * kMisfit / (kMisfit + fit.misfit);
  if (prior.weight > 0) {
    const auto apart =
        static_cast<int64_t>(integerSqrt(static_cast<uint64_t>(squaredDistance(fit.at, prior.at))));
    left = left * kQuarter / (kQuarter + std::min(apart, kHalf));
  }
  return static_cast<int>(std::min<int64_t>(left, kFullReliability));
}

/// By how much a misfit may differ by chance: it shrinks with the number of pixels, but where
/// another shift matches nearly as well, the surface of sums says little at all.
int64_t slackOf(const MotionFit& own, const MotionPrior& prior, int reliability) {
  constexpr int64_t kChance = 12, kFull = 4 * 256;
  constexpr int kAmbiguous = kFullReliability / 10;
  const auto root =
      static_cast<int64_t>(integerSqrt(uint64_t{256} * 256 * std::max(own.pixels, 1u)));
  const int64_t ambiguous = std::max(0, kAmbiguous - reliability) * 256 / (10 * kAmbiguous);
  const int64_t share = kChance * 256 * 256 / root + ambiguous;
  return (own.misfit + kFine) * share / 256 * std::min(prior.weight, kFull) / kFull;
}

/// What of the slack a vector has used up by its distance from the prior, half of it at 1 px.
int64_t penalty(Point at, const MotionPrior& prior, int64_t slack) {
  const int64_t distance = squaredDistance(at, prior.at);
  return slack * distance / (distance + int64_t{kFine} * kFine);
}

/// A region of which nothing is matched moves as its neighbours expect.
MotionFit withoutPixels(const MotionFit& own, const MotionPrior& prior) {
  MotionFit fit = own;
  if (prior.weight > 0) fit.at = prior.at;
  return fit;
}

}  // namespace

void MotionRefinement::run(const graph::Graph& graph, const MatchedBlocks& blocks,
                           const Picture& before, const PaddedLuma& previous,
                           const Executor& executor, std::span<RegionMotion> motion) {
  graph_ = &graph;
  blocks_ = &blocks;
  smooth(before, previous.reach(), executor);
  planes_ = {FitPlane{graph.picture->luma(), &previous},
             FitPlane{smoothCurrent_.inside(), &smoothPrevious_}};
  alone_.resize(motion.size());
  own_.resize(motion.size());
  const auto count = static_cast<int>(motion.size());
  executor.forEach(count, [&](int index) {
    const auto i = static_cast<size_t>(index);
    own_[i] = {};
    if (motion[i].sad == kNotMatched) return;
    alone_[i] = fitAlone(regionOf(i, motion), motion[i]);
    const Information& known = alone_[i].fit.information;
    const int64_t trust = motion[i].reliability;
    own_[i] = {alone_[i].fit.at,
               {known.xx * trust / kFullReliability, known.xy * trust / kFullReliability,
                known.yy * trust / kFullReliability}};
  });
  const std::span<const MotionPrior> priors = consensus_.run(graph, own_, executor);
  executor.forEach(count, [&](int index) {
    const auto i = static_cast<size_t>(index);
    RegionMotion& result = motion[i];
    if (result.sad == kNotMatched) return;
    const FitRegion region = regionOf(i, motion);
    const MotionFit fit = fitTogether(region, alone_[i], priors[i], result.reliability);
    result.reliability = static_cast<uint16_t>(judge(result.reliability, region, fit, priors[i]));
    result.dx = static_cast<int>(divideRounded(fit.at.x, kFinePerUnit));
    result.dy = static_cast<int>(divideRounded(fit.at.y, kFinePerUnit));
  });
}

// What was the current picture last time is mostly the previous one now, or still the current one.
void MotionRefinement::smooth(const Picture& before, int reach, const Executor& executor) {
  const bool hasCurrent = smoothOf_ == graph_->picture && smoothCurrent_.reach() == reach;
  if (!hasCurrent) std::swap(smoothCurrent_, smoothPrevious_);
  if (hasCurrent || smoothOf_.get() != &before || smoothPrevious_.reach() != reach)
    smoothPrevious_.buildSmooth(before.luma(), reach, executor);
  if (hasCurrent) return;
  smoothOf_ = graph_->picture;
  smoothCurrent_.buildSmooth(smoothOf_->luma(), reach, executor);
}

FitRegion MotionRefinement::regionOf(size_t i, std::span<const RegionMotion> motion) const {
  const graph::Region& region = graph_->regions[i];
  const std::span<const MatchedPart> parts =
      blocks_->partsOf(segmentation::RegionLabel::ofIndex(i));
  int64_t pixels = 0;
  for (const MatchedPart& part : parts) pixels += part.pixels();
  const int64_t mean = static_cast<int64_t>(motion[i].sad) * kFine / std::max<int64_t>(pixels, 1);
  const auto limit = std::min<int64_t>(kFitFactor * mean + kLeastLimit, kMostLimit);
  return {parts, {region.centroidX >> 8, region.centroidY >> 8}, static_cast<int>(limit), pixels};
}

MotionRefinement::Candidate MotionRefinement::fitAlone(const FitRegion& region,
                                                       const RegionMotion& motion) const {
  MotionFit start;
  start.at = {motion.dx * kFinePerUnit, motion.dy * kFinePerUnit};
  Candidate best{start, 0};
  if (region.parts.empty()) return best;
  int64_t known = -1;
  for (size_t i = 0; i < planes_.size(); ++i) {
    const auto plane = static_cast<uint8_t>(i);
    const MotionFit fit = fitMotion(region, planes_[plane], start, {}, kTrialSteps);
    const int64_t least = leastInformation(fit.information);
    if (least <= known) continue;
    known = least;
    best = {fit, plane};
  }
  return best;
}

MotionFit MotionRefinement::fitTogether(const FitRegion& region, const Candidate& own,
                                        const MotionPrior& prior, int reliability) const {
  if (region.parts.empty()) return withoutPixels(own.fit, prior);
  const FitPlane& plane = planes_[own.plane];
  const MotionFit mine = fitMotion(region, plane, own.fit, prior, kOwnSteps);
  if (squaredDistance(own.fit.at, prior.at) <= kNear * kNear || prior.weight == 0) return mine;
  MotionFit start;
  start.at = prior.at;
  const MotionFit theirs = fitMotion(region, plane, start, prior, kPriorSteps);
  const int64_t slack = slackOf(own.fit, prior, reliability);
  return theirs.misfit + penalty(theirs.at, prior, slack) <=
                 mine.misfit + penalty(mine.at, prior, slack)
             ? theirs
             : mine;
}

}  // namespace rg::motion
