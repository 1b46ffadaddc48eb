// SPDX-License-Identifier: LGPL-2.1-or-later
// The graph's and the motion's stage with a device: the same, whichever of its calls fails, and
// even when it is lost.
#include "core/graph/graph.hpp"
#include "core/motion/motion.hpp"
#include "tests/kernels/labelled_scene.hpp"
#include "tests/kernels/tested_device.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <memory>
#include <tuple>
#include <vector>

namespace rg::test {
namespace {

using graph::Graph;
using motion::Motion;
using segmentation::Labels;

/// Labels of frames in which a walker goes, of all of the frame or of the foreground only.
std::vector<std::shared_ptr<const Labels>> walk(segmentation::Scope scope, bool isGrey,
                                                int maxRegions) {
  const auto stage = stageOn(segmentation::makeStage, nullptr);
  std::vector<std::shared_ptr<const Labels>> labels;
  for (const int step : {20, 22, 22, 25}) {
    const auto seen = walkerSeen(step, {true, isGrey});
    labels.push_back(*stage->process(seen->picture, seen, {scope, 4, 60, maxRegions, {}}));
  }
  return labels;
}

void expectSame(const Graph& a, const Graph& b) {
  ASSERT_EQ(a.regions.size(), b.regions.size());
  for (size_t i = 0; i < a.regions.size(); ++i) {
    const graph::Region &r = a.regions[i], &s = b.regions[i];
    ASSERT_EQ(std::tuple(r.areaPx, r.box, r.centroidX, r.centroidY, r.colour),
              std::tuple(s.areaPx, s.box, s.centroidX, s.centroidY, s.colour));
  }
  ASSERT_EQ(a.arcs.size(), b.arcs.size());
  for (size_t i = 0; i < a.arcs.size(); ++i)
    ASSERT_EQ(std::tuple(a.arcs[i].a, a.arcs[i].b, a.arcs[i].borderPx, a.arcs[i].contrast),
              std::tuple(b.arcs[i].a, b.arcs[i].b, b.arcs[i].borderPx, b.arcs[i].contrast));
  ASSERT_EQ(a.runs.starts, b.runs.starts);
  ASSERT_EQ(a.runs.list.size(), b.runs.list.size());
  for (size_t i = 0; i < a.runs.list.size(); ++i) {
    const Run &r = a.runs.list[i], &s = b.runs.list[i];
    ASSERT_EQ(std::tuple(r.y, r.begin, r.end), std::tuple(s.y, s.begin, s.end));
  }
}

void expectSame(const Motion& a, const Motion& b) {
  ASSERT_EQ(a.status, b.status);
  ASSERT_EQ(std::tuple(a.matchedBlocks, a.stillBlocks), std::tuple(b.matchedBlocks, b.stillBlocks));
  ASSERT_EQ(a.regions.size(), b.regions.size());
  for (size_t i = 0; i < a.regions.size(); ++i) {
    const motion::RegionMotion &r = a.regions[i], &s = b.regions[i];
    ASSERT_EQ(std::tuple(r.dx, r.dy, r.sad, r.reliability),
              std::tuple(s.dx, s.dy, s.sad, s.reliability))
        << "region " << i;
  }
}

/// Both stages on one device.
struct Chained {
  std::unique_ptr<graph::Stage> graphs;
  std::unique_ptr<motion::Stage> motions;
  explicit Chained(const std::shared_ptr<Device>& first, const std::shared_ptr<Device>& second)
      : graphs(stageOn(graph::makeStage, first)), motions(stageOn(motion::makeStage, second)) {}

  std::shared_ptr<const Motion> show(const std::shared_ptr<const Labels>& labels,
                                     Connectivity connectivity = Connectivity::Four,
                                     const motion::Params& params = {}) {
    return *motions->process(*graphs->process(labels, {connectivity}), params, {});
  }
};

TEST(MotionBackend, GraphsAndVectorsAreTheSameOnADevice) {
  const auto device = openTested(), other = openTested(device);
  Chained cpu(nullptr, nullptr), gpu(device, other);
  size_t moving = 0;
  for (const bool isGrey : {false, true})
    for (const auto scope : {segmentation::Scope::Frame, segmentation::Scope::Foreground})
      for (const int maxShiftPx : {2, 3, 20})
        for (const auto& labels : walk(scope, isGrey, 400)) {
          const auto connectivity = maxShiftPx == 3 ? Connectivity::Eight : Connectivity::Four;
          const auto method = maxShiftPx == 2 ? motion::Method::Literal : motion::Method::Refined;
          const motion::Params params{maxShiftPx, !isGrey, method};
          const auto expected = cpu.show(labels, connectivity, params);
          const auto found = gpu.show(labels, connectivity, params);
          ASSERT_NO_FATAL_FAILURE(expectSame(*found->graph, *expected->graph));
          ASSERT_NO_FATAL_FAILURE(expectSame(*found, *expected));
          for (const auto& region : found->regions) moving += region.dx != 0;
        }
  EXPECT_GT(moving, 20u);
  EXPECT_TRUE(device->isUp() && other->isUp());
  expectNoFindings();
}

/// In a stream of its own each.
void failEachCall(const std::vector<std::shared_ptr<const Labels>>& labels,
                  const motion::Params& params) {
  Chained cpu(nullptr, nullptr);
  std::vector<std::shared_ptr<const Motion>> expected;
  for (const auto& frame : labels) expected.push_back(cpu.show(frame, Connectivity::Four, params));
  for (const auto how : {Failure::Call, Failure::Loss, Failure::Hang}) {
    uint64_t call = 0;
    for (bool hasFailed = true; hasFailed && !testing::Test::HasFailure();
         call += how == Failure::Hang ? 3 : 1) {
      SCOPED_TRACE("call " + std::to_string(call));
      const auto device = openTested(), other = openTested(device);
      Chained gpu(device, other);
      (void)gpu.show(labels[0], Connectivity::Four, params);
      failCall(call, how);
      for (size_t i = 1; i < labels.size() - 1; ++i) {
        const auto found = gpu.show(labels[i], Connectivity::Four, params);
        ASSERT_NO_FATAL_FAILURE(expectSame(*found->graph, *expected[i]->graph));
        ASSERT_NO_FATAL_FAILURE(expectSame(*found, *expected[i]));
      }
      hasFailed = !device->isUp() || !other->isUp();
    }
    EXPECT_GT(call, 30u);
  }
}

TEST(MotionBackend, NeitherAFailedCallNorALostDeviceChangesAnything) {
  if (!isHost()) GTEST_SKIP() << "a GPU does not fail when asked";
  const auto labels = walk(segmentation::Scope::Frame, false, 16);
  for (const auto method : {motion::Method::Refined, motion::Method::Literal})
    failEachCall(labels, {method == motion::Method::Literal ? 1 : 4, true, method});
}

}  // namespace
}  // namespace rg::test
