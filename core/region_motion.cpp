// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/region_motion.hpp"

#include "core/block_matching.hpp"
#include "core/fit_sums.hpp"
#include "core/matched_blocks.hpp"
#include "core/motion_estimate.hpp"
#include "core/motion_refinement.hpp"
#include "core/pool.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

namespace rg {
namespace {

constexpr uint32_t kPartsPerChunk = 16;
/// Sums are kept for one batch of chunks only: whatever the number of regions, this many bytes.
constexpr size_t kBatchBytes = size_t{4} << 20;
constexpr size_t kMostChunksInBatch = 256;

/// Parts first … last − 1 of the sorted list, all of one label: a task's work.
struct Chunk {
  uint32_t first = 0;
  uint32_t last = 0;
};

/// Chunks first … last − 1 of a batch that belong to one region.
struct Group {
  size_t first = 0;
  size_t last = 0;
};

GradientSums gradientsOf(std::span<const MatchedPart> parts, ImageView<const uint8_t> luma) {
  const GradientProducts sums = sumGradients(parts, luma);
  GradientSums gradients{sums.xx, sums.xy, sums.yy, 0};
  for (const MatchedPart& part : parts) gradients.pixels += part.pixels();
  return gradients;
}

bool isUnchanged(std::span<const MatchedPart> parts, ImageView<const uint8_t> luma,
                 ImageView<const uint8_t> previous) {
  return std::all_of(parts.begin(), parts.end(), [&](const MatchedPart& part) {
    bool isSame = true;
    forBlocks(part, [&](int x, int y) {
      isSame = isSame && std::memcmp(luma.row(y) + x, previous.row(y) + x, kBlockWidth) == 0;
    });
    return isSame;
  });
}

class CpuMotion : public MotionStage {
 public:
  explicit CpuMotion(Context context) : context_(std::move(context)) {}

  Result<std::shared_ptr<const Motion>> process(std::shared_ptr<const Graph> graph,
                                                const MotionParams& params) override;
  void reset(Reset) override { previous_.reset(); }

 private:
  void match(const Graph& graph, const MotionParams& params, Motion& motion);
  void findStill(const Labels& labels, Motion& motion);
  void cutChunks();
  void matchBatch(size_t first, size_t last, const Labels& labels);
  void closeBatch(size_t first, size_t last, Motion& motion);
  void addToCarry(const Group& group);
  [[nodiscard]] RegionMotion closeGroup(const Group& group);

  [[nodiscard]] uint16_t labelOf(size_t chunk) const {
    return blocks_.parts()[chunks_[chunk].first].label;
  }
  [[nodiscard]] std::span<uint32_t> sumsOf(size_t slot) {
    return {sums_.data() + slot * shifts_, shifts_};
  }

  Context context_;
  std::shared_ptr<const Picture> previous_;
  PaddedLuma padded_;
  MatchedBlocks blocks_;
  std::vector<uint8_t> isStill_;  ///< By label: none of its matched pixels has changed.
  std::vector<Chunk> chunks_;
  std::vector<Group> groups_;
  int maxShift_ = 0;
  int reach_ = 0;  ///< A ring of shifts beyond.
  size_t shifts_ = 0;
  std::vector<uint32_t> sums_;           ///< By chunk of the batch, then by shift.
  std::vector<GradientSums> gradients_;  ///< By chunk of the batch.
  std::vector<MatchScratch> scratch_;
  std::vector<uint64_t> carry_;  ///< Sums of the region that the batch before left open.
  GradientSums carriedGradients_;
  MotionRefinement refinement_;
  Pool<Motion> pool_;
};

Result<std::shared_ptr<const Motion>> CpuMotion::process(std::shared_ptr<const Graph> graph,
                                                         const MotionParams& params) {
  const auto motion = pool_.take();
  motion->size = graph->size;
  motion->status = Status::Skipped;
  motion->regions.assign(graph->regions.size(), {});
  motion->matchedBlocks = motion->stillBlocks = 0;
  if (graph->status != Status::Skipped) {
    std::shared_ptr<const Picture> picture = graph->labels->picture;
    if (previous_ && previous_->size() == picture->size()) {
      match(*graph, params, *motion);
      motion->status = graph->status;
    }
    previous_ = std::move(picture);
  }
  motion->graph = std::move(graph);
  return std::shared_ptr<const Motion>(motion);
}

void CpuMotion::match(const Graph& graph, const MotionParams& params, Motion& motion) {
  maxShift_ = std::clamp(params.maxShiftPx, 1, kMostReach - 1);
  reach_ = maxShift_ + 1;
  shifts_ = static_cast<size_t>(shiftCount(reach_));
  const Labels& labels = *graph.labels;
  blocks_.find(graph, *context_.cpu);
  if (blocks_.parts().empty()) return;
  padded_.build(previous_->luma(), reach_, *context_.cpu);
  scratch_.resize(static_cast<size_t>(context_.cpu->threads()));
  findStill(labels, motion);
  cutChunks();
  const size_t slots = std::min(kMostChunksInBatch, kBatchBytes / (shifts_ * sizeof(uint32_t)));
  sums_.resize(slots * shifts_);
  gradients_.resize(slots);
  carry_.assign(shifts_, 0);
  carriedGradients_ = {};
  for (size_t first = 0; first < chunks_.size(); first += slots) {
    const size_t last = std::min(first + slots, chunks_.size());
    matchBatch(first, last, labels);
    closeBatch(first, last, motion);
  }
  if (params.isSubpixel)
    refinement_.run(graph, blocks_, *previous_, padded_, *context_.cpu, motion.regions);
}

// Where nothing changed no shift is better than none, and of the others only the nearest count.
void CpuMotion::findStill(const Labels& labels, Motion& motion) {
  isStill_.assign(size_t{labels.count} + 1, 0);
  context_.cpu->forEach(static_cast<int>(labels.count), [&](int i, int thread) {
    const auto label = static_cast<uint32_t>(i) + 1;
    const auto parts = blocks_.partsOf(label);
    const ImageView<const uint8_t> luma = labels.picture->luma();
    if (parts.empty() || !isUnchanged(parts, luma, previous_->luma())) return;
    isStill_[label] = 1;
    std::array<uint32_t, shiftCount(1)> sums{};
    addParts(parts, luma, {padded_, 1}, scratch_[static_cast<size_t>(thread)], sums);
    motion.regions[label - 1] =
        estimateMotion(std::span<const uint32_t>(sums), 1, 0, gradientsOf(parts, luma));
  });
  for (const MatchedPart& part : blocks_.parts()) {
    motion.matchedBlocks += part.pixels() / kBlockWidth;
    if (isStill_[part.label] != 0) motion.stillBlocks += part.pixels() / kBlockWidth;
  }
}

void CpuMotion::cutChunks() {
  const std::span<const MatchedPart> parts = blocks_.parts();
  chunks_.clear();
  const auto count = static_cast<uint32_t>(parts.size());
  for (uint32_t first = 0; first < count;) {
    uint32_t last = first + 1;
    while (last < count && last - first < kPartsPerChunk && parts[last].label == parts[first].label)
      ++last;
    if (isStill_[parts[first].label] == 0) chunks_.push_back({first, last});
    first = last;
  }
}

void CpuMotion::matchBatch(size_t first, size_t last, const Labels& labels) {
  const ImageView<const uint8_t> luma = labels.picture->luma();
  context_.cpu->forEach(static_cast<int>(last - first), [&](int i, int thread) {
    const auto slot = static_cast<size_t>(i);
    const Chunk& chunk = chunks_[first + slot];
    const auto parts = blocks_.parts().subspan(chunk.first, chunk.last - chunk.first);
    std::fill(sumsOf(slot).begin(), sumsOf(slot).end(), 0u);
    addParts(parts, luma, {padded_, reach_}, scratch_[static_cast<size_t>(thread)], sumsOf(slot));
    gradients_[slot] = gradientsOf(parts, luma);
  });
}

// A region may begin in an earlier batch and end in a later one: its sums are carried on.
void CpuMotion::closeBatch(size_t first, size_t last, Motion& motion) {
  groups_.clear();
  for (size_t chunk = first; chunk < last; ++chunk) {
    if (groups_.empty() || labelOf(chunk) != labelOf(chunk - 1))
      groups_.push_back({chunk - first, chunk - first});
    ++groups_.back().last;
  }
  const bool isCarried = first > 0 && labelOf(first) == labelOf(first - 1);
  const bool goesOn = last < chunks_.size() && labelOf(last) == labelOf(last - 1);
  size_t begin = 0, end = groups_.size();
  if (isCarried) {
    addToCarry(groups_.front());
    begin = 1;
    if (goesOn && end == 1) return;
    motion.regions[labelOf(first) - 1u] =
        estimateMotion(std::span<const uint64_t>(carry_), reach_, maxShift_, carriedGradients_);
    std::fill(carry_.begin(), carry_.end(), 0u);
    carriedGradients_ = {};
  }
  if (goesOn) addToCarry(groups_[--end]);
  context_.cpu->forEach(static_cast<int>(end - begin), [&](int i) {
    const Group& group = groups_[begin + static_cast<size_t>(i)];
    motion.regions[labelOf(first + group.first) - 1u] = closeGroup(group);
  });
}

void CpuMotion::addToCarry(const Group& group) {
  for (size_t slot = group.first; slot < group.last; ++slot) {
    const std::span<const uint32_t> sums = sumsOf(slot);
    for (size_t i = 0; i < shifts_; ++i) carry_[i] += sums[i];
    add(carriedGradients_, gradients_[slot]);
  }
}

/// A batch's chunks have less than 2^20 pixels: their sums fit 32 bits.
RegionMotion CpuMotion::closeGroup(const Group& group) {
  const std::span<uint32_t> total = sumsOf(group.first);
  for (size_t slot = group.first + 1; slot < group.last; ++slot) {
    const std::span<const uint32_t> sums = sumsOf(slot);
    for (size_t i = 0; i < shifts_; ++i) total[i] += sums[i];
    add(gradients_[group.first], gradients_[slot]);
  }
  return estimateMotion(total, reach_, maxShift_, gradients_[group.first]);
}

}  // namespace

std::unique_ptr<MotionStage> makeMotionStage(Context context) {
  return std::make_unique<CpuMotion>(std::move(context));
}

}  // namespace rg
