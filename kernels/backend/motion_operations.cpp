// SPDX-License-Identifier: LGPL-2.1-or-later
#include "kernels/backend/dispatcher.hpp"
#include "kernels/literal_search.hpp"
#include "kernels/motion_estimate.hpp"
#include "kernels/motion_refinement.hpp"
#include "kernels/shift_search.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace rg::gpu::motion {
namespace {

using rg::motion::FoundShift;
using rg::motion::GradientProducts;
using rg::motion::MatchedBlocks;
using rg::motion::MatchedFrames;
using rg::motion::MatchedPart;
using rg::motion::PaddedLuma;
using rg::motion::RegionMotion;
using rg::motion::ShiftRange;
using rg::motion::WholeShifts;
using Cpu = rg::motion::Operations;

class GpuOperations final : public Cpu, private Dispatcher {
 public:
  GpuOperations(GpuDevice& device, const Executor& executor) : Cpu(executor), Dispatcher(device) {}

  void searchShifts(const MatchedFrames& frames, const WholeShifts& out) override {
    listRegions(frames, out);
    isPaddedHere_ = regions_.empty();
    if (regions_.empty()) return Cpu::searchShifts(frames, out);
    runOrCatchUp([&] { searchOnDevice(frames, out); },
                 [&] {
                   Cpu::searchShifts(frames, out);
                   isPaddedHere_ = true;
                 });
  }
  void refine(const rg::graph::Graph& graph, const MatchedFrames& frames,
              std::span<RegionMotion> motion) override {
    const auto onDevice = [&] {
      refineOnDevice(graph, frames, motion);
      std::copy(motions_.begin(), motions_.end(), motion.begin());
    };
    runOrCatchUp(onDevice, [&] {
      if (!isPaddedHere_) padLuma(frames);
      Cpu::refine(graph, frames, motion);
    });
  }
  void matchAllPixels(const rg::graph::Graph& graph, const Picture& previous, int maxShiftPx,
                      std::span<RegionMotion> motion) override {
    if (motion.empty()) return;
    const auto onDevice = [&] {
      matchOnDevice(graph, previous, {maxShiftPx, maxShiftPx + 1});
      std::copy(motions_.begin(), motions_.end(), motion.begin());
    };
    runOrCatchUp(onDevice, [&] { Cpu::matchAllPixels(graph, previous, maxShiftPx, motion); });
  }

 private:
  /// Those that have matched blocks, which are all that a device is told of.
  void listRegions(const MatchedFrames& frames, const WholeShifts& out) {
    regions_.clear();
    gradients_.clear();
    starts_.assign(1, 0);
    for (uint32_t i = 0; i < out.motion.size(); ++i) {
      const auto label = rg::segmentation::RegionLabel::ofIndex(i);
      const size_t parts = frames.blocks.partsOf(label).size();
      if (parts == 0) continue;
      regions_.push_back(i);
      gradients_.push_back(frames.blocks.gradientsOf(label));
      starts_.push_back(starts_.back() + static_cast<uint32_t>(parts));
    }
  }

  void searchOnDevice(const MatchedFrames& frames, const WholeShifts& out) {
    const auto count = static_cast<int>(regions_.size());
    const std::span<const MatchedPart> parts = frames.blocks.parts();
    auto* still = scratch().take<uint8_t>(count);
    const MatchedRegions regions{sent(parts), sent(starts_), count, still};
    const GradientProducts* gradients = sent(gradients_);
    const ImageView<const uint8_t> luma = frames.current.readOn(device()).luma;
    const ImageView<const uint8_t> before = frames.previous.readOn(device()).luma;
    findStill(regions, luma, before, still, stream());
    const ShiftRange range{frames.maxShiftPx, frames.maxShiftPx + 1};
    auto* found = scratch().take<FoundShift>(count);
    rg::gpu::motion::searchShifts(regions, searched(luma, before, range.reach), range,
                                  sumsFor(range, count), found, stream());
    auto* motion = scratch().take<RegionMotion>(count);
    estimateMotion(regions, found, gradients, motion, stream());
    fetchLists(FetchedList<uint8_t>{still, static_cast<uint32_t>(count), stills_},
               FetchedList<RegionMotion>{motion, static_cast<uint32_t>(count), motions_});
    for (size_t i = 0; i < regions_.size(); ++i) {
      out.isStill[regions_[i]] = stills_[i];
      out.take(regions_[i], motions_[i]);
    }
  }

  /// Leaves in motions_ what it finds.
  void refineOnDevice(const rg::graph::Graph& graph, const MatchedFrames& frames,
                      std::span<const RegionMotion> motion) {
    listRefined(graph, frames.blocks, motion);
    const auto count = static_cast<int>(motion.size());
    const RefinedRegions regions{{sent(frames.blocks.parts()), sent(starts_), count},
                                 sent(refined_),
                                 scratch().take<FitState>(count)};
    const SeenPlanes planes = planesOf(frames);
    const SeenMotions seen{scratch().take<rg::motion::SeenMotion>(count),
                           scratch().take<int32_t>(count),
                           scratch().take<rg::motion::MotionBelief>(count),
                           scratch().take<rg::motion::MotionPrior>(count)};
    auto* refined = scratch().take<RegionMotion>(count);
    send(refined, motion.data(), motion.size_bytes());
    fitAlone(regions, planes, seen, stream());
    letBegin();
    // Meanwhile.
    neighbours_.find(graph);
    const bool hasAny = !neighbours_.list().empty();
    const NeighboursView neighbours{sent(neighbours_.starts()), sent(neighbours_.counts()),
                                    hasAny ? sent(neighbours_.list()) : nullptr};
    findConsensus(neighbours, seen, scratch().take<rg::motion::MotionBelief>(count), count,
                  stream());
    fitTogether(regions, planes, seen.priors, refined, stream());
    fetchLists(FetchedList<RegionMotion>{refined, static_cast<uint32_t>(count), motions_});
  }
  /// All of them.
  void listRefined(const rg::graph::Graph& graph, const MatchedBlocks& blocks,
                   std::span<const RegionMotion> motion) {
    refined_.clear();
    starts_.assign(1, 0);
    for (size_t i = 0; i < motion.size(); ++i) {
      refined_.push_back(rg::motion::refinedRegion(graph, blocks, motion, i));
      const auto label = rg::segmentation::RegionLabel::ofIndex(i);
      starts_.push_back(starts_.back() + static_cast<uint32_t>(blocks.partsOf(label).size()));
    }
  }
  [[nodiscard]] SeenPlanes planesOf(const MatchedFrames& frames) const {
    const ImageView<const uint8_t> luma = frames.current.readOn(device()).luma;
    const ImageView<const uint8_t> before = frames.previous.readOn(device()).luma;
    const int reach = frames.maxShiftPx + 1;
    const ImageView<uint8_t> smooth = smoothed(luma, reach).rows;
    const ImageView<const uint8_t> inside{smooth.row(reach) + reach, luma.size, smooth.strideBytes};
    return {{luma, padded(before, reach)}, {inside, smoothed(before, reach)}};
  }

  /// Leaves in motions_ what it finds.
  void matchOnDevice(const rg::graph::Graph& graph, const Picture& previous,
                     const ShiftRange& range) {
    list_.build(graph.runs.list, graph.runs.starts);
    const LiteralRegions regions{sent(graph.runs.list), sent(list_.chunks), list_};
    const PaddedView before = padded(previous.readOn(device()).luma, range.reach);
    const auto count = static_cast<uint32_t>(regions.count());
    const int most = mostRegions(range, regions.count());
    const LiteralSums sums{scratch().take<unsigned long long>(int64_t{shiftsOf(range)} * most),
                           most, scratch().take<rg::motion::GradientSums>(count)};
    auto* motion = scratch().take<RegionMotion>(count);
    rg::gpu::motion::matchAllPixels(regions, graph.picture->readOn(device()).luma, before, range,
                                    sums, motion, stream());
    fetchLists(FetchedList<RegionMotion>{motion, count, motions_});
  }

  [[nodiscard]] PaddedView roomFor(Size size, int reach) const {
    return {size, reach,
            scratchPlane<uint8_t>(
                {size.width + 2 * reach + PaddedLuma::kSlack, size.height + 2 * reach})};
  }
  [[nodiscard]] PaddedView padded(ImageView<const uint8_t> luma, int reach) const {
    const PaddedView room = roomFor(luma.size, reach);
    rg::gpu::motion::padLuma(luma, room, stream());
    return room;
  }
  [[nodiscard]] PaddedView smoothed(ImageView<const uint8_t> luma, int reach) const {
    const PaddedView room = roomFor(luma.size, reach);
    padSmooth(luma, room, stream());
    return room;
  }
  [[nodiscard]] SearchedPlanes searched(ImageView<const uint8_t> luma,
                                        ImageView<const uint8_t> before, int reach) const {
    const PaddedView previous = padded(before, reach);
    const BoxesView boxes{scratchPlane<uint16_t>(previous.rows.size)};
    sumBoxes(previous, boxes, stream());
    return {luma, previous, boxes};
  }

  /// As many regions at once as a number of sums allows.
  [[nodiscard]] static int mostRegions(const ShiftRange& range, int count) {
    constexpr int kMostSums = 1 << 23;
    return std::clamp(kMostSums / shiftsOf(range), 1, count);
  }
  /// Room for those.
  [[nodiscard]] ShiftSums sumsFor(const ShiftRange& range, int count) const {
    const int regions = mostRegions(range, count);
    const int64_t sums = int64_t{shiftsOf(range)} * regions;
    return {scratch().take<uint32_t>(sums), scratch().take<uint32_t>(sums), regions};
  }

  bool isPaddedHere_ = false;  ///< searchShifts() was the CPU's.
  rg::motion::MotionNeighbours neighbours_;
  std::vector<rg::motion::RefinedRegion> refined_;
  std::vector<uint32_t> regions_, starts_;
  std::vector<GradientProducts> gradients_;
  std::vector<uint8_t> stills_;
  std::vector<RegionMotion> motions_;
  LiteralList list_;
};

}  // namespace
}  // namespace rg::gpu::motion

template <>
std::unique_ptr<rg::motion::Operations> rg::gpu::operationsOn(GpuDevice& device,
                                                              const Executor& executor) {
  return std::make_unique<motion::GpuOperations>(device, executor);
}
