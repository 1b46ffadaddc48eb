// SPDX-License-Identifier: LGPL-2.1-or-later
#include "kernels/backend/dispatcher.hpp"
#include "kernels/camera_warp.hpp"
#include "kernels/motion_evidence.hpp"
#include "kernels/object_pixels.hpp"
#include "kernels/region_comparison.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace rg::gpu::objects {
namespace {

using rg::objects::CarriedEvidence;
using rg::objects::ComparedFrame;
using rg::objects::ComparedRegions;
using rg::objects::KnownEvidence;
using rg::objects::ObjectPixels;
using rg::objects::ObjectSums;
using rg::objects::OwnedCells;
using Cpu = rg::objects::Operations;

class GpuOperations final : public Cpu, private Dispatcher {
 public:
  GpuOperations(GpuDevice& device, const Executor& executor) : Cpu(executor), Dispatcher(device) {}

  void expectFrame(const ComparedFrame& earlier, OwnMotionScratch& s) override {
    isExpectedHere_ = false;
    runOrCatchUp([&] { expectOnDevice(earlier, s); }, [&] { expectHere(earlier, s); });
  }
  void compareRegions(const ComparedRegions& regions, OwnMotionScratch& s) override {
    const auto onDevice = [&] {
      compareOnDevice(regions, s);
      std::copy(trials_.begin(), trials_.end(), s.trials.begin());
    };
    runOrCatchUp(onDevice, [&] {
      if (!isExpectedHere_) expectHere(regions.earlier, s);
      Cpu::compareRegions(regions, s);
    });
  }
  void carryEvidence(const KnownEvidence& known, const CarriedEvidence& carried) override {
    if (known.motion.regions.empty()) return Cpu::carryEvidence(known, carried);
    const auto onDevice = [&] {
      carryOnDevice(known, carried.gains);
      std::copy(sums_.begin(), sums_.end(), carried.sums.begin());
      std::copy(samples_.begin(), samples_.end(), carried.samples.begin());
    };
    runOrCatchUp(onDevice, [&] { Cpu::carryEvidence(known, carried); });
  }
  void addEvidence(const rg::graph::Graph& graph, std::span<const int16_t> density,
                   const Image<int16_t>& gains, Image<int16_t>& sum) override {
    if (density.empty()) return Cpu::addEvidence(graph, density, gains, sum);
    runOrCatchUp(
        [&] {
          const ImageView<const uint16_t> labels = graph.labels->ids.readOn(device());
          const int16_t* list = sent(density);
          const ImageView<const int16_t> from = gains.readOn(device());
          objects::addEvidence(labels, list, from, sum.writeOn(device()), stream());
          sum.readOnHost();
        },
        [&] { Cpu::addEvidence(graph, density, gains, sum); });
  }
  void findObjectPixels(const rg::graph::Graph& graph, std::span<const uint8_t> isBackground,
                        const OwnedCells& cells, const ObjectPixels& pixels) override {
    const bool hasAny = !pixels.sums.empty() && !isBackground.empty() && graph.picture != nullptr;
    if (!hasAny) return Cpu::findObjectPixels(graph, isBackground, cells, pixels);
    const auto onDevice = [&] {
      pixels.slots.resize(graph.size);
      findPixelsOnDevice(graph, isBackground, cells, pixels);
      pixels.slots.readOnHost();
      std::copy(objects_.begin(), objects_.end(), pixels.sums.begin());
    };
    runOrCatchUp(onDevice, [&] { Cpu::findObjectPixels(graph, isBackground, cells, pixels); });
  }

 private:
  void expectHere(const ComparedFrame& earlier, OwnMotionScratch& s) {
    Cpu::expectFrame(earlier, s);
    isExpectedHere_ = true;
  }

  void expectOnDevice(const ComparedFrame& earlier, OwnMotionScratch& s) {
    const Size size = earlier.picture.size();
    s.expected.resize(size);
    s.shown.resize({size.height, 1});
    const ImageView<const uint8_t> luma = earlier.picture.readOn(device()).luma;
    const ImageView<uint8_t> expected = s.expected.writeOn(device());
    warpByCamera(luma, earlier.camera, expected, s.shown.writeOn(device()).data, stream());
  }

  /// Leaves in trials_ what it finds.
  void compareOnDevice(const ComparedRegions& in, const OwnMotionScratch& s) {
    listRegions(in, s);
    const rg::graph::Graph& graph = *in.motion.graph;
    const auto count = static_cast<int>(regions_.size());
    const RegionList regions{sent(regions_), count, s.everyRow, s.hidesAny};
    const ComparedPictures pictures{graph.labels->ids.readOn(device()),
                                    graph.picture->readOn(device()).luma,
                                    s.expected.readOn(device()), s.shown.readOn(device()).data};
    const ComparisonView out{
        s.hidesAny ? scratch().take<uint32_t>(graph.size.area()) : nullptr,
        scratch().take<OwnMotionScratch::Sums>(int64_t{count} * OwnMotionScratch::kBands),
        scratch().take<OwnMotionScratch::Trial>(count)};
    objects::compareRegions(pictures, regions, out, stream());
    fetchLists(
        FetchedList<OwnMotionScratch::Trial>{out.trials, static_cast<uint32_t>(count), trials_});
  }
  void listRegions(const ComparedRegions& in, const OwnMotionScratch& s) {
    regions_.clear();
    for (size_t i = 0; i < s.trials.size(); ++i)
      regions_.push_back({s.trials[i].shift, in.own[i].shift, in.motion.graph->regions[i].box,
                          s.moves[i], s.mostLevels});
  }

  /// Leaves in sums_ and samples_ what they are.
  void carryOnDevice(const KnownEvidence& known, Image<int16_t>& gains) {
    const rg::graph::Graph& graph = *known.motion.graph;
    const auto count = static_cast<uint32_t>(known.motion.regions.size());
    const KnownView from{graph.labels->ids.readOn(device()),
                         graph.picture->readOn(device()).luma,
                         known.previous.readOn(device()).luma,
                         sent(known.motion.regions),
                         static_cast<int>(count),
                         known.gains.readOn(device()),
                         known.left};
    const CarriedView to{gains.writeOn(device()), scratch().take<int64_t>(count),
                         scratch().take<uint32_t>(count)};
    objects::carryEvidence(from, to, stream());
    gains.readOnHost();
    fetchLists(FetchedList<int64_t>{to.sums, count, sums_},
               FetchedList<uint32_t>{to.samples, count, samples_});
  }

  /// Leaves in objects_ what they are.
  void findPixelsOnDevice(const rg::graph::Graph& graph, std::span<const uint8_t> isBackground,
                          const OwnedCells& cells, const ObjectPixels& pixels) {
    listOwners(cells);
    const auto count = static_cast<uint32_t>(pixels.sums.size());
    const OwnedPixels owned{graph.labels->ids.readOn(device()),
                            sent(isBackground),
                            sent(owners_),
                            cells.grid.stepPx,
                            cells.grid.grid.width,
                            on().readRed(*graph.picture)};
    const ObjectPixelsView out{pixels.slots.writeOn(device()), scratch().take<ObjectSums>(count),
                               scratch().take<uint32_t>(count), static_cast<int>(count)};
    objects::findObjectPixels(owned, out, stream());
    fetchLists(FetchedList<ObjectSums>{out.sums, count, objects_});
  }
  /// Of cells that are no background.
  void listOwners(const OwnedCells& cells) {
    owners_.assign(static_cast<size_t>(cells.grid.grid.area()), 0);
    cells.grid.forForeground([&](size_t cell, int, int) { owners_[cell] = cells.owner[cell]; });
  }

  bool isExpectedHere_ = false;  ///< expectFrame() was the CPU's.
  std::vector<ComparedRegion> regions_;
  std::vector<OwnMotionScratch::Trial> trials_;
  std::vector<int64_t> sums_;
  std::vector<uint32_t> samples_;
  std::vector<uint16_t> owners_;
  std::vector<ObjectSums> objects_;
};

}  // namespace
}  // namespace rg::gpu::objects

template <>
std::unique_ptr<rg::objects::Operations> rg::gpu::operationsOn(GpuDevice& device,
                                                               const Executor& executor) {
  return std::make_unique<objects::GpuOperations>(device, executor);
}
