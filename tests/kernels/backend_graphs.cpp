// SPDX-License-Identifier: LGPL-2.1-or-later
// All five stages on one stream of a device: what of a frame is launched as graphs, also after the
// size and the properties have changed, and that the objects are the CPU's.
#include "core/objects/objects.hpp"
#include "kernels/backend/gpu_device.hpp"
#include "tests/kernels/labelled_scene.hpp"
#include "tests/kernels/tested_device.hpp"

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace rg::test {
namespace {

using Counts = gpu::LaunchQueue::Counts;

constexpr size_t kStages = 5;
constexpr std::array<const char*, kStages> kNames{"background", "segmentation", "graph", "motion",
                                                  "objects"};

Counts countsOf(const std::shared_ptr<Device>& device) {
  return device == nullptr ? Counts{}
                           : dynamic_cast<const gpu::GpuDevice&>(*device).lane()->queue().counts();
}
Counts operator-(const Counts& a, const Counts& b) {
  return {a.single - b.single, a.inGraph - b.inGraph, a.made - b.made, a.updated - b.updated,
          a.launched - b.launched};
}

/// What is changed while it plays.
struct Ways {
  segmentation::Scope scope = segmentation::Scope::Foreground;
  int maxShiftPx = 6;
  int minAreaPx = 40;
};

/// The five stages, on devices that share a stream, or on the CPU.
class Chained {
 public:
  explicit Chained(const std::shared_ptr<Device>& first)
      : device_(first),
        scene_({}, quick(), first),
        labelling_(stageOn(segmentation::makeStage, beside())),
        graphs_(stageOn(graph::makeStage, beside())),
        motions_(stageOn(motion::makeStage, beside())),
        objects_(stageOn(objects::makeStage, beside())) {}

  std::shared_ptr<const objects::Objects> show(const Take& take, const Ways& ways) {
    begin_ = countsOf(device_);
    stage_ = 0;
    const auto seen = counted(scene_.show(take));
    const auto labels = counted(
        *labelling_->process(seen->picture, seen, {ways.scope, 8, ways.minAreaPx, 150, {}}));
    const auto graph = counted(*graphs_->process(labels, {}));
    const auto moved = counted(*motions_->process(graph, {ways.maxShiftPx}, {}));
    return counted(*objects_->process(moved, {}, {frame_++ * StagedScene::kFrameNs, true}));
  }
  /// Of the last frame, by stage.
  [[nodiscard]] const std::array<Counts, kStages>& counts() const { return counts_; }

 private:
  static background::Params quick() {
    background::Params params;
    params.trainingFrames = 2;
    return params;
  }
  [[nodiscard]] std::shared_ptr<Device> beside() const {
    return device_ == nullptr ? nullptr : openTested(device_);
  }
  template <class T>
  T counted(T result) {
    const Counts end = countsOf(device_);
    counts_.at(stage_++) = end - std::exchange(begin_, end);
    return result;
  }

  const std::shared_ptr<Device> device_;
  StagedScene scene_;
  std::unique_ptr<segmentation::Stage> labelling_;
  std::unique_ptr<graph::Stage> graphs_;
  std::unique_ptr<motion::Stage> motions_;
  std::unique_ptr<objects::Stage> objects_;
  int64_t frame_ = 0;
  Counts begin_;
  std::array<Counts, kStages> counts_;
  size_t stage_ = 0;
};

void expectSame(const objects::Objects& a, const objects::Objects& b) {
  ASSERT_EQ(a.objects.size(), b.objects.size());
  for (size_t i = 0; i < a.objects.size(); ++i) {
    ASSERT_EQ(a.objects[i].id, b.objects[i].id);
    ASSERT_EQ(a.objects[i].box, b.objects[i].box);
    ASSERT_EQ(a.objects[i].areaPx, b.objects[i].areaPx);
  }
}

/// Of the last frame of those that a walker goes through.
std::array<Counts, kStages> showWalk(Chained& cpu, Chained& gpu, const Ways& ways) {
  constexpr int kFrames = 12;
  for (int i = 0; i < kFrames && !testing::Test::HasFatalFailure(); ++i) {
    SCOPED_TRACE("frame " + std::to_string(i));
    Take take;
    if (i >= 2) take.walker = walkerAt(i);
    expectSame(*gpu.show(take, ways), *cpu.show(take, ways));
  }
  return gpu.counts();
}

/// The background's and the segmentation's are the most launches; what remains by itself is a
/// sequence of three at most.
TEST(GraphsBackend, AFrameLikeTheOnesBeforeItIsLaunchedAsGraphs) {
  const auto device = openTested();
  Chained cpu(nullptr), gpu(device);
  for (const Ways& ways : {Ways{}, Ways{segmentation::Scope::Foreground, 3, 80},
                           Ways{segmentation::Scope::Frame, 6, 40}}) {
    SCOPED_TRACE("shifts of up to " + std::to_string(ways.maxShiftPx));
    const auto counts = showWalk(cpu, gpu, ways);
    EXPECT_GT(counts[0].inGraph, 100u);
    EXPECT_GT(counts[1].inGraph, 20u);
    EXPECT_GT(counts[2].inGraph, 15u);
    EXPECT_GT(counts[3].inGraph, 10u);
    for (size_t i = 0; i < kStages; ++i) {
      SCOPED_TRACE(kNames.at(i));
      EXPECT_EQ(counts.at(i).made, 0u);
      EXPECT_LE(counts.at(i).updated, 20u);
      EXPECT_LE(counts.at(i).single, 20u);
    }
  }
  EXPECT_TRUE(device->isUp());
  expectNoFindings();
}

}  // namespace
}  // namespace rg::test
