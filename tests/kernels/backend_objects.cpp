// SPDX-License-Identifier: LGPL-2.1-or-later
// The objects' stage with a device, before a still and before a moving camera: the same, whichever
// of its calls fails, and even when it is lost.
#include "core/objects/objects.hpp"
#include "tests/kernels/labelled_scene.hpp"
#include "tests/kernels/tested_device.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <memory>
#include <random>
#include <tuple>
#include <vector>

namespace rg::test {
namespace {

using motion::Motion;
using objects::Objects;

constexpr int kFrames = 14;

/// The motion of frames in which a walker goes, and the camera, too, where it is all of the frame.
std::vector<std::shared_ptr<const Motion>> walk(segmentation::Scope scope, bool isGrey) {
  background::Params params;
  params.trainingFrames = 2;
  StagedScene scene({}, params);
  const auto labelling = stageOn(segmentation::makeStage, nullptr);
  const auto graphs = stageOn(graph::makeStage, nullptr);
  const auto motions = stageOn(motion::makeStage, nullptr);
  const bool isMoving = scope == segmentation::Scope::Frame;
  Take take;
  take.isGrey = isGrey;
  if (!isMoving) (void)scene.showFor(4, take);
  std::vector<std::shared_ptr<const Motion>> moved;
  for (int i = 0; i < kFrames; ++i) {
    take.walker = walkerAt(10 + 2 * i);
    if (isMoving) take.push = {2 * i, i};
    const auto seen = scene.show(take);
    const auto labels = *labelling->process(seen->picture, seen, {scope, 8, 40, 150, {}});
    moved.push_back(*motions->process(*graphs->process(labels, {}), {6}, {}));
  }
  return moved;
}

void expectSame(const objects::Object& a, const objects::Object& b) {
  ASSERT_EQ(std::tuple(a.id, a.state, a.box, a.areaPx, a.ageFrames),
            std::tuple(b.id, b.state, b.box, b.areaPx, b.ageFrames));
  ASSERT_EQ(std::tuple(a.centroidX, a.centroidY, a.speedX, a.speedY),
            std::tuple(b.centroidX, b.centroidY, b.speedX, b.speedY));
  ASSERT_EQ(std::tuple(a.colour, a.parents, a.contour), std::tuple(b.colour, b.parents, b.contour));
}

void expectSame(const Objects& a, const Objects& b) {
  ASSERT_EQ(a.status, b.status);
  ASSERT_EQ(a.objects.size(), b.objects.size());
  for (size_t i = 0; i < a.objects.size(); ++i)
    ASSERT_NO_FATAL_FAILURE(expectSame(a.objects[i], b.objects[i]));
  ASSERT_EQ(std::tuple(a.regionObject, a.regionExpected, a.arcs, a.ground),
            std::tuple(b.regionObject, b.regionExpected, b.arcs, b.ground));
  const ImageView<const uint16_t> slots = a.slots, others = b.slots;
  ASSERT_EQ(slots.size, others.size);
  for (int y = 0; y < slots.height(); ++y)
    ASSERT_TRUE(std::equal(slots.row(y), slots.row(y) + slots.width(), others.row(y))) << y;
}

constexpr FrameTime timeOf(size_t frame) {
  return {static_cast<int64_t>(frame) * StagedScene::kFrameNs, true};
}

/// What the stage says of each frame up to the last one.
std::vector<std::shared_ptr<const Objects>> track(
    const std::vector<std::shared_ptr<const Motion>>& moved, const std::shared_ptr<Device>& device,
    const objects::Params& params = {}) {
  const auto stage = stageOn(objects::makeStage, device);
  std::vector<std::shared_ptr<const Objects>> told;
  for (size_t i = 0; i < moved.size(); ++i)
    told.push_back(*stage->process(moved[i], params, timeOf(i)));
  return told;
}

TEST(ObjectBackend, ObjectsAreTheSameOnADevice) {
  const auto device = openTested();
  int64_t pixels = 0, movers = 0;
  for (const bool isGrey : {false, true})
    for (const auto scope : {segmentation::Scope::Frame, segmentation::Scope::Foreground})
      for (const auto method : {objects::Method::Extended, objects::Method::Literal}) {
        objects::Params params;
        params.method = method;
        const auto moved = walk(scope, isGrey);
        const auto expected = track(moved, nullptr, params), found = track(moved, device, params);
        for (size_t i = 0; i < moved.size(); ++i) {
          SCOPED_TRACE("frame " + std::to_string(i));
          ASSERT_NO_FATAL_FAILURE(expectSame(*found[i], *expected[i]));
          for (const objects::Object& object : expected[i]->objects) pixels += object.areaPx;
          for (const objects::GroundEnergy& ground : expected[i]->ground)
            movers += ground.weight() < 0;
        }
      }
  EXPECT_GT(pixels, 5000);
  EXPECT_GT(movers, 0);
  EXPECT_TRUE(device->isUp());
  expectNoFindings();
}

/// Frames with movers before and behind the one that fails.
constexpr size_t kFaulty = 4, kAfter = 2;

/// Fails calls of a frame, and compares it and those behind it. Each run takes others: the frames
/// before it take long.
void failCalls(Failure how, std::vector<std::shared_ptr<const Motion>> moved) {
  moved.resize(kFaulty + 1 + kAfter);
  const auto expected = track(moved, nullptr);
  ASSERT_FALSE(expected[kFaulty]->objects.empty());
  std::mt19937 random(std::random_device{}());
  uint64_t call = 0;
  for (bool hasFailed = true; hasFailed && !::testing::Test::HasFailure();
       call += 1 + random() % 6) {
    SCOPED_TRACE("call " + std::to_string(call));
    const auto device = openTested();
    const auto stage = stageOn(objects::makeStage, device);
    for (size_t i = 0; i < moved.size(); ++i) {
      if (i == kFaulty) failCall(call, how);
      const auto found = *stage->process(moved[i], {}, timeOf(i));
      if (i < kFaulty) continue;
      ASSERT_NO_FATAL_FAILURE(expectSame(*found, *expected[i])) << "frame " << i;
      if (i == kFaulty) hasFailed = !device->isUp();
    }
  }
  EXPECT_GT(call, 10u);
}

TEST(ObjectBackend, NeitherAFailedCallNorALostDeviceChangesAnything) {
  if (!isHost()) GTEST_SKIP() << "a GPU does not fail when asked";
  for (const auto scope : {segmentation::Scope::Frame, segmentation::Scope::Foreground}) {
    const auto moved = walk(scope, false);
    for (const auto how : {Failure::Call, Failure::Loss, Failure::Hang}) failCalls(how, moved);
  }
}

}  // namespace
}  // namespace rg::test
