// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/motion/motion.hpp"

#include "core/base/memory/pool.hpp"
#include "core/base/renewed_stage.hpp"
#include "core/motion/matched_blocks.hpp"
#include "core/motion/motion_estimate.hpp"
#include "core/motion/motion_refinement.hpp"
#include "core/motion/padded_luma.hpp"
#include "core/motion/shift_search.hpp"

#include <algorithm>
#include <utility>

namespace rg::motion {
namespace {

class CpuMotion : public Stage {
 public:
  explicit CpuMotion(Context context) : context_(std::move(context)) {}

  Result<std::shared_ptr<const Motion>> process(std::shared_ptr<const graph::Graph> graph,
                                                const Params& params) override;
  void reset(Reset) override { previous_.reset(); }

 private:
  void match(const graph::Graph& graph, const Params& params, Motion& motion);

  Context context_;
  std::shared_ptr<const Picture> previous_;
  SearchedPicture searched_;
  MatchedBlocks blocks_;
  std::vector<uint8_t> isStill_;  ///< By region: none of its matched pixels has changed.
  std::vector<SearchScratch> scratch_;
  MotionRefinement refinement_;
  Pool<Motion> pool_;
};

Result<std::shared_ptr<const Motion>> CpuMotion::process(std::shared_ptr<const graph::Graph> graph,
                                                         const Params& params) {
  const auto motion = pool_.take();
  motion->size = graph->size;
  motion->status = Status::Skipped;
  motion->regions.assign(graph->regions.size(), {});
  motion->matchedBlocks = motion->stillBlocks = 0;
  if (graph->status != Status::Skipped) {
    std::shared_ptr<const Picture> picture = graph->picture;
    if (previous_ && previous_->size() == picture->size()) {
      match(*graph, params, *motion);
      motion->status = graph->status;
    }
    previous_ = std::move(picture);
  }
  motion->graph = std::move(graph);
  return std::shared_ptr<const Motion>(motion);
}

void CpuMotion::match(const graph::Graph& graph, const Params& params, Motion& motion) {
  const int maxShift = std::clamp(params.maxShiftPx, 1, kMostReach - 1);
  const segmentation::Labels& labels = *graph.labels;
  blocks_.find(graph, *context_.cpu);
  if (blocks_.parts().empty()) return;
  // A ring of shifts beyond is seen, too.
  searched_.build(previous_->luma(), maxShift + 1, *context_.cpu);
  scratch_.resize(static_cast<size_t>(context_.cpu->threads()));
  isStill_.assign(motion.regions.size(), 0);
  context_.cpu->forEach(static_cast<int>(labels.count), [&](int index, int thread) {
    const auto i = static_cast<size_t>(index);
    const auto label = segmentation::RegionLabel::ofIndex(i);
    const auto parts = blocks_.partsOf(label);
    if (parts.empty()) return;
    isStill_[i] = isUnchanged(parts, graph.picture->luma(), previous_->luma());
    const ShiftRange range = isStill_[i] != 0 ? kStillRange : ShiftRange{maxShift, maxShift + 1};
    const FoundShift found = searchShifts(parts, graph.picture->luma(), searched_, range,
                                          scratch_[static_cast<size_t>(thread)]);
    const GradientProducts& gradients = blocks_.gradientsOf(label);
    motion.regions[i] =
        estimateMotion(found, {gradients.xx, gradients.xy, gradients.yy, blocks_.pixelsOf(label)});
  });
  for (const MatchedPart& part : blocks_.parts()) {
    motion.matchedBlocks += part.pixels() / kBlockWidth;
    if (isStill_[part.label.index()] != 0) motion.stillBlocks += part.pixels() / kBlockWidth;
  }
  if (params.isSubpixel)
    refinement_.run(graph, blocks_, *previous_, searched_.luma, *context_.cpu, motion.regions);
}

}  // namespace

std::unique_ptr<Stage> makeStage(Context context) {
  return std::make_unique<RenewedStage<Stage, CpuMotion>>(std::move(context));
}

}  // namespace rg::motion
