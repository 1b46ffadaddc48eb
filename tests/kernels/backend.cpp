// SPDX-License-Identifier: LGPL-2.1-or-later
// Whole stages with a device: the same results, whichever of its calls fails.
#include "tests/core/staged_scene.hpp"
#include "tests/kernels/tested_device.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>
#include <vector>

namespace rg::test {
namespace {

using background::Foreground;
using background::SceneEvent;

void expectSame(const Foreground& a, const Foreground& b, int frame) {
  SCOPED_TRACE("frame " + std::to_string(frame));
  ASSERT_EQ(a.size, b.size);
  ASSERT_EQ(a.status, b.status);
  const bool isLost = a.scene.event == SceneEvent::ModelLost;
  ASSERT_EQ(isLost ? SceneEvent::None : a.scene.event, b.scene.event);
  ASSERT_EQ(a.scene.shift, b.scene.shift);
  ASSERT_EQ(a.scene.isDark, b.scene.isDark);
  for (int y = 0; y < a.size.height; ++y)
    ASSERT_TRUE(std::equal(a.mask.row(y), a.mask.row(y) + a.size.width, b.mask.row(y)))
        << "row " << y;
  ASSERT_EQ(a.areas, b.areas);
}

background::Params quick(background::Method method) {
  background::Params params;
  params.method = method;
  params.trainingFrames = method == background::Method::Paper ? 3 : 10;
  params.absorbTimeS = 1;
  return params;
}
const background::Params kQuick = quick(background::Method::Hybrid);
/// The other methods, each in its ways.
const std::vector<background::Params> kOthers = [] {
  std::vector<background::Params> others{quick(background::Method::Paper)};
  others.push_back(others.back());
  others.back().findsShadows = false;
  others.back().threshold = 15;
  others.push_back(quick(background::Method::FrameDifference));
  others.push_back(others.back());
  others.back().search = background::SearchScope::Frame;
  others.back().thresholdFrom = background::ThresholdSource::Frame;
  others.back().searchInterval = 1;
  return others;
}();

/// A walker that stops, a push, a gain that hunts, light, night: every decision of the method is
/// taken.
Take takeAt(int frame) {
  Take take;
  if (frame >= 2) take.walker = walkerAt(std::min(frame - 2, 40));
  if (frame >= 30 && frame < 34) take.push = {3, 2};
  if (frame >= 40 && frame < 60) take.gainPercent = 100 + 2 * std::min(frame - 40, 60 - frame);
  if (frame >= 60) take.gainPercent = 160;
  if (frame >= 75) take.gainPercent = frame < 80 ? 4 : 160;
  take.isGrey = frame >= 90;
  return take;
}

TEST(BackgroundBackend, BackgroundIsTheSameOnADevice) {
  const auto device = openTested();
  StagedScene cpu({}, kQuick), gpu({}, kQuick, device);
  std::vector<SceneEvent> seen;
  for (int frame = 0; frame < 100 && !HasFatalFailure(); ++frame) {
    const auto expected = cpu.show(takeAt(frame));
    seen.push_back(expected->scene.event);
    expectSame(*gpu.show(takeAt(frame)), *expected, frame);
  }
  EXPECT_TRUE(device->isUp());
  expectNoFindings();
  for (const SceneEvent event :
       {SceneEvent::CameraShaken, SceneEvent::LightSwitched, SceneEvent::TooDark,
        SceneEvent::BrightAgain, SceneEvent::ColourSwitched})
    EXPECT_TRUE(std::count(seen.begin(), seen.end(), event)) << static_cast<int>(event);
}

/// A frame in which a walker is well in view, and how many are looked at behind one that failed.
constexpr int kWalking = 5, kAfter = 3;

/// Fails the calls of a frame in turn, in a stream of its own each time, and compares that frame
/// and those behind it. Of a frame that comes late each run takes others: those before it take
/// long.
void failCalls(int frame, Failure how, const background::Params& params,
               const std::vector<std::shared_ptr<const Foreground>>& expected) {
  const int64_t before = countAllocations();
  std::mt19937 random(std::random_device{}());
  const uint64_t mostStep = frame < kWalking ? 1 : 7;
  uint64_t call = 0;
  for (bool hasFailed = true; hasFailed && !::testing::Test::HasFailure();
       call += 1 + random() % mostStep) {
    SCOPED_TRACE("call " + std::to_string(call));
    const auto device = openTested();
    StagedScene gpu({}, params, device);
    for (int i = 0; i < frame; ++i) (void)gpu.show(takeAt(i));
    failCall(call, how);
    const auto shown = gpu.show(takeAt(frame));
    hasFailed = !device->isUp();
    if (hasFailed) {
      expectSame(*shown, *expected[static_cast<size_t>(frame)], frame);
      EXPECT_EQ(shown->scene.event == SceneEvent::ModelLost, how != Failure::Call);
      for (int i = frame + 1; i < frame + kAfter; ++i)
        expectSame(*gpu.show(takeAt(i)), *expected[static_cast<size_t>(i)], i);
    }
  }
  const bool isHybrid = params.method == background::Method::Hybrid;
  // The first frames of the other methods only train.
  EXPECT_GT(call, isHybrid ? 20u : frame < kWalking ? 3u : 15u);
  EXPECT_EQ(countAllocations(), before);
}

/// What the CPU shows of the first frames; it forgets everything before frame `forgotten`.
std::vector<std::shared_ptr<const Foreground>> shownByCpu(const background::Params& params,
                                                          int forgotten) {
  StagedScene cpu({}, params);
  std::vector<std::shared_ptr<const Foreground>> shown;
  for (int i = 0; i < kWalking + kAfter; ++i) {
    if (i == forgotten) cpu.forget();
    shown.push_back(cpu.show(takeAt(i)));
  }
  return shown;
}

TEST(BackgroundBackend, AFailedCallChangesNoFrame) {
  if (!isHost()) GTEST_SKIP() << "a GPU does not fail when asked";
  const auto expected = shownByCpu(kQuick, 0);
  for (const int frame : {0, 1, kWalking}) failCalls(frame, Failure::Call, kQuick, expected);
}

/// The frame is the first of a model that starts with it, and says so.
TEST(BackgroundBackend, ALostDeviceOrOneThatHangsCostsTheModelOnly) {
  if (!isHost()) GTEST_SKIP() << "a GPU does not fail when asked";
  const auto expected = shownByCpu(kQuick, kWalking);
  for (const auto how : {Failure::Loss, Failure::Hang}) failCalls(kWalking, how, kQuick, expected);
}

TEST(BackgroundBackend, EachOtherMethodIsTheSameOnADevice) {
  for (const background::Params& params : kOthers) {
    const auto device = openTested();
    StagedScene cpu({}, params), gpu({}, params, device);
    uint64_t foregroundPx = 0;
    for (int frame = 0; frame < 75 && !HasFatalFailure(); ++frame) {
      const auto expected = cpu.show(takeAt(frame));
      expectSame(*gpu.show(takeAt(frame)), *expected, frame);
      foregroundPx += expected->scene.foregroundPx;
    }
    EXPECT_TRUE(device->isUp());
    EXPECT_GT(foregroundPx, 1000u);
    expectNoFindings();
  }
}

TEST(BackgroundBackend, AFailureInAnotherMethodCostsNoMoreThanTheModel) {
  if (!isHost()) GTEST_SKIP() << "a GPU does not fail when asked";
  for (const background::Params& params : kOthers) {
    const auto expected = shownByCpu(params, 0), renewed = shownByCpu(params, kWalking);
    for (const int frame : {1, kWalking}) failCalls(frame, Failure::Call, params, expected);
    failCalls(kWalking, Failure::Loss, params, renewed);
  }
}

}  // namespace
}  // namespace rg::test
