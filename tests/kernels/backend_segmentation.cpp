// SPDX-License-Identifier: LGPL-2.1-or-later
// The segmentation's stage with a device: the same labels, whichever of its calls fails.
#include "tests/kernels/labelled_scene.hpp"
#include "tests/kernels/tested_device.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace rg::test {
namespace {

using background::Foreground;
using segmentation::Labels;
using segmentation::Params;
using segmentation::Scope;

std::unique_ptr<segmentation::Stage> makeStage(std::shared_ptr<Device> device) {
  return stageOn(segmentation::makeStage, std::move(device));
}

template <class T>
void expectSamePlane(const Image<T>& a, const Image<T>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (int y = 0; y < a.height(); ++y)
    ASSERT_TRUE(std::equal(a.row(y), a.row(y) + a.width(), b.row(y))) << "row " << y;
}

void expectSame(const Labels& a, const Labels& b) {
  ASSERT_EQ(a.count, b.count);
  ASSERT_EQ(a.scope, b.scope);
  ASSERT_EQ(a.status, b.status);
  expectSamePlane(a.ids, b.ids);
  expectSamePlane(a.hue, b.hue);
}

/// Every way through the stage: scopes, cells and pixels, few and many regions, hues.
std::vector<Params> allWays() {
  segmentation::HueRules byHue;
  byHue.background = segmentation::BackgroundHue::FromPeak;
  std::vector<Params> ways;
  for (const Scope scope : {Scope::Frame, Scope::Foreground, Scope::Areas})
    for (const int minAreaPx : {0, 1, 300, 1100})
      for (const int maxRegions : {5, 1024})
        for (const bool usesHue : {false, true})
          ways.push_back(
              {scope, 4, minAreaPx, maxRegions, usesHue ? byHue : segmentation::HueRules{}});
  for (const int minAreaPx : {1, 300})
    ways.push_back({Scope::Frame, 4, minAreaPx, 1024, byHue, segmentation::ColourSpace::Hsv});
  return ways;
}

TEST(SegmentationBackend, LabelsAreTheSameOnADevice) {
  const auto device = openTested();
  const auto cpu = makeStage(nullptr), gpu = makeStage(device);
  for (const Watched& watched : {Watched{true, false}, {false, false}, {true, true}}) {
    const auto seen = walkerSeen(20, watched);
    ASSERT_FALSE(seen->areas.empty());
    for (const Params& params : allWays()) {
      SCOPED_TRACE(std::to_string(static_cast<int>(params.scope)) + ", least area " +
                   std::to_string(params.minAreaPx));
      const auto expected = cpu->process(seen->picture, seen, params);
      const auto labels = gpu->process(seen->picture, seen, params);
      ASSERT_TRUE(expected && labels);
      ASSERT_GT((*expected)->count, 0u);
      ASSERT_NO_FATAL_FAILURE(expectSame(**labels, **expected));
    }
  }
  EXPECT_TRUE(device->isUp());
  expectNoFindings();
}

/// No model is lost with a device: labels come from the frame alone.
void failEachCall(const Params& params, Failure how) {
  const auto seen = walkerSeen(20, {false, false});
  const auto expected = makeStage(nullptr)->process(seen->picture, seen, params);
  uint64_t call = 0;
  for (bool hasFailed = true; hasFailed && !testing::Test::HasFailure();
       call += how == Failure::Hang ? 5 : 1) {
    SCOPED_TRACE("call " + std::to_string(call));
    const auto device = openTested();
    const auto gpu = makeStage(device);
    (void)gpu->process(seen->picture, seen, params);
    failCall(call, how);
    const auto labels = gpu->process(seen->picture, seen, params);
    ASSERT_TRUE(labels);
    ASSERT_NO_FATAL_FAILURE(expectSame(**labels, **expected));
    hasFailed = !device->isUp();
  }
  EXPECT_GT(call, 20u);
}

TEST(SegmentationBackend, AFailedCallChangesNoLabel) {
  if (!isHost()) GTEST_SKIP() << "a GPU does not fail when asked";
  for (const Params& params : {Params{Scope::Foreground, 4, 300, 1024, {}},
                               Params{Scope::Frame, 4, 1, 50, {}, segmentation::ColourSpace::Hsv}})
    for (const auto how : {Failure::Call, Failure::Loss, Failure::Hang}) failEachCall(params, how);
}

/// What the stage before has left on the device is not sent again, and pixels of another device
/// come by way of the host.
TEST(SegmentationBackend, StagesShareADeviceOrNone) {
  if (!isHost()) GTEST_SKIP() << "a GPU does not fail when asked";
  const Params params{Scope::Foreground, 4, 300, 1024, {}};
  const auto there = openTested();
  const auto seen = walkerSeen(20, {}, there);
  const auto expected = makeStage(nullptr)->process(seen->picture, seen, params);
  const auto countAllocations = [&](const std::shared_ptr<Device>& device) {
    const auto stage = makeStage(device);
    const int64_t before = test::countAllocations();
    const auto labels = stage->process(seen->picture, seen, params);
    EXPECT_TRUE(labels);
    expectSame(**labels, **expected);
    return test::countAllocations() - before;
  };
  const int64_t shared = countAllocations(openTested(there));
  // Luma, three colours and the mask.
  EXPECT_EQ(countAllocations(openTested()) - shared, 5);
  EXPECT_EQ(countAllocations(openTested(there)), shared);
}

}  // namespace
}  // namespace rg::test
