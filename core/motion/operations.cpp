// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/motion/operations.hpp"

#include "core/motion/motion_estimate.hpp"

namespace rg::motion {

void Operations::searchShifts(const MatchedFrames& frames, const WholeShifts& out) {
  padLuma(frames);
  searched_.boxes.build(searched_.luma, executor_);
  scratch_.resize(static_cast<size_t>(executor_.threads()));
  const ImageView<const uint8_t> luma = frames.current.luma(), before = frames.previous.luma();
  executor_.forEach(static_cast<int>(out.motion.size()), [&](int index, int thread) {
    const auto i = static_cast<size_t>(index);
    const auto label = segmentation::RegionLabel::ofIndex(i);
    const auto parts = frames.blocks.partsOf(label);
    if (parts.empty()) return;
    out.isStill[i] = isUnchanged(parts, luma, before);
    ShiftRange range =
        out.isStill[i] != 0 ? kStillRange : ShiftRange{frames.maxShiftPx, frames.maxShiftPx + 1};
    if (!out.elsewhere.empty()) range.mostSum = static_cast<uint32_t>(out.elsewhere[i].sad);
    const FoundShift found =
        motion::searchShifts(parts, luma, searched_, range, scratch_[static_cast<size_t>(thread)]);
    if (!found.isWithin) return;
    const GradientProducts& gradients = frames.blocks.gradientsOf(label);
    out.take(i, estimateMotion(found, {gradients.xx, gradients.xy, gradients.yy,
                                       frames.blocks.pixelsOf(label)}));
  });
}

void Operations::refine(const graph::Graph& graph, const MatchedFrames& frames,
                        std::span<RegionMotion> motion) {
  refinement_.run(graph, frames.blocks, frames.previous, searched_.luma, executor_, motion);
}

void Operations::matchAllPixels(const graph::Graph& graph, const Picture& previous, int maxShiftPx,
                                std::span<RegionMotion> motion) {
  const ShiftRange range{maxShiftPx, maxShiftPx + 1};
  literalLuma_.build(previous.luma(), range.reach, executor_);
  literalScratch_.resize(static_cast<size_t>(executor_.threads()));
  executor_.forEach(static_cast<int>(motion.size()), [&](int index, int thread) {
    const auto i = static_cast<size_t>(index);
    motion[i] = motion::matchAllPixels(graph.runs.of(i), graph.picture->luma(), literalLuma_, range,
                                       literalScratch_[static_cast<size_t>(thread)]);
  });
}

}  // namespace rg::motion
