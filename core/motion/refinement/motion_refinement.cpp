// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/motion/refinement/motion_refinement.hpp"

#include <utility>

namespace rg::motion {
namespace {

FitRegion fitRegionOf(const RefinedRegion& region, const MatchedBlocks& blocks, size_t i) {
  return {blocks.partsOf(segmentation::RegionLabel::ofIndex(i)), region.centroid, region.limit};
}

}  // namespace

void MotionRefinement::run(const graph::Graph& graph, const MatchedBlocks& blocks,
                           const Picture& before, const PaddedLuma& previous,
                           const Executor& executor, std::span<RegionMotion> motion) {
  smooth(graph, before, previous.reach(), executor);
  planes_ = {FitPlane{graph.picture->luma(), &previous},
             FitPlane{smoothCurrent_.inside(), &smoothPrevious_}};
  alone_.resize(motion.size());
  own_.resize(motion.size());
  const auto count = static_cast<int>(motion.size());
  executor.forEach(count, [&](int index) {
    const auto i = static_cast<size_t>(index);
    own_[i] = {};
    Candidate& alone = alone_[i];
    alone.region = refinedRegion(graph, blocks, motion, i);
    if (alone.region.isFound == 0) return;
    fitAlone(fitRegionOf(alone.region, blocks, i), alone);
    own_[i] = seenMotion(alone.fit, alone.region.reliability);
  });
  const std::span<const MotionPrior> priors = consensus_.run(graph, own_, executor);
  executor.forEach(count, [&](int index) {
    const auto i = static_cast<size_t>(index);
    const Candidate& alone = alone_[i];
    if (alone.region.isFound == 0) return;
    const MotionFit fit = fitTogether(fitRegionOf(alone.region, blocks, i), alone, priors[i]);
    takeOver(alone.region, fit, priors[i], motion[i]);
  });
}

// What was the current picture last time is mostly the previous one now, or still the current one.
void MotionRefinement::smooth(const graph::Graph& graph, const Picture& before, int reach,
                              const Executor& executor) {
  const bool hasCurrent = smoothOf_ == graph.picture && smoothCurrent_.reach() == reach;
  if (!hasCurrent) std::swap(smoothCurrent_, smoothPrevious_);
  if (hasCurrent || smoothOf_.get() != &before || smoothPrevious_.reach() != reach)
    smoothPrevious_.buildSmooth(before.luma(), reach, executor);
  if (hasCurrent) return;
  smoothOf_ = graph.picture;
  smoothCurrent_.buildSmooth(smoothOf_->luma(), reach, executor);
}

void MotionRefinement::fitAlone(const FitRegion& region, Candidate& own) const {
  MotionFit start;
  start.at = own.region.at;
  own.fit = start;
  own.plane = 0;
  if (region.parts.empty()) return;
  int64_t known = -1;
  for (size_t i = 0; i < planes_.size(); ++i) {
    const MotionFit fit = fitMotion(region, planes_[i], start, {}, kTrialSteps);
    const int64_t least = leastInformation(fit.information);
    if (least <= known) continue;
    known = least;
    own.fit = fit;
    own.plane = static_cast<uint8_t>(i);
  }
}

MotionFit MotionRefinement::fitTogether(const FitRegion& region, const Candidate& own,
                                        const MotionPrior& prior) const {
  if (region.parts.empty()) return own.fit;
  const FitPlane& plane = planes_[own.plane];
  const MotionFit mine = fitMotion(region, plane, own.fit, prior, kOwnSteps);
  if (!asksForFit(own.fit, prior)) return mine;
  MotionFit start;
  start.at = prior.at;
  const MotionFit theirs = fitMotion(region, plane, start, prior, kPriorSteps);
  return isTheirsBetter(own.fit, mine, theirs, prior, own.region.reliability) ? theirs : mine;
}

}  // namespace rg::motion
