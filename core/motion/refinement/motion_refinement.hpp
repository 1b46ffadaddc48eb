// SPDX-License-Identifier: LGPL-2.1-or-later
// From whole-pixel vectors of the regions to fractions of a pixel, with what the neighbours say
// where a region says little itself (part of stage 4).
//
// Each region is fitted from its own vector, on the luma or the smoothed luma, whichever tells
// more: fine texture drowns in noise on the one side, and is smoothed away on the other. Then all
// look for a consensus (core/motion/refinement/motion_consensus.hpp), and each is fitted again with
// it as its prior, from its own vector and, where the consensus is elsewhere, from there. Which of
// the fits counts, core/motion/refinement/refinement_rules.hpp says.
// Determinism: integers; regions depend on each other through the consensus only.
#pragma once

#include "core/base/picture.hpp"
#include "core/motion/matched_blocks.hpp"
#include "core/motion/motion.hpp"
#include "core/motion/refinement/motion_consensus.hpp"
#include "core/motion/refinement/motion_fit.hpp"
#include "core/motion/refinement/refinement_rules.hpp"

#include <array>
#include <memory>
#include <span>
#include <vector>

namespace rg::motion {

/// What is fitted of the region of index i, whose whole-pixel vector is motion[i].
[[nodiscard]] inline RefinedRegion refinedRegion(const graph::Graph& graph,
                                                 const MatchedBlocks& blocks,
                                                 std::span<const RegionMotion> motion, size_t i) {
  const graph::Region& region = graph.regions[i];
  return refinedRegion(motion[i], {region.centroidX, region.centroidY},
                       blocks.pixelsOf(segmentation::RegionLabel::ofIndex(i)));
}

class MotionRefinement {
 public:
  /// `previous`: the luma of the frame before, padded. Replaces the vectors in `motion`, whole
  /// pixels; regions without matched blocks take over the consensus. Those that are kNotMatched
  /// stay so, and say nothing to their neighbours.
  void run(const graph::Graph& graph, const MatchedBlocks& blocks, const Picture& before,
           const PaddedLuma& previous, const Executor& executor, std::span<RegionMotion> motion);

 private:
  struct Candidate {
    RefinedRegion region;
    MotionFit fit;
    uint8_t plane = 0;
  };

  void smooth(const graph::Graph& graph, const Picture& before, int reach,
              const Executor& executor);
  void fitAlone(const FitRegion& region, Candidate& own) const;
  [[nodiscard]] MotionFit fitTogether(const FitRegion& region, const Candidate& own,
                                      const MotionPrior& prior) const;

  PaddedLuma smoothCurrent_, smoothPrevious_;
  std::shared_ptr<const Picture> smoothOf_;  ///< Whose smooth luma smoothCurrent_ holds.
  std::array<FitPlane, 2> planes_;
  std::vector<Candidate> alone_;
  std::vector<SeenMotion> own_;
  MotionConsensus consensus_;
};

}  // namespace rg::motion
