// SPDX-License-Identifier: LGPL-2.1-or-later
// Things that shine in the dark, before pure black and before noise.
#include "core/background/background.hpp"
#include "tests/core/scenes.hpp"
#include "tests/support/value_of.hpp"

#include <gtest/gtest.h>

namespace rg {
namespace {

using background::SceneEvent;

constexpr Size kSize{160, 120};

/// A disc of a hundredth of the frame that moves over black, which may have noise.
std::shared_ptr<const Picture> discAt(int time, int noise) {
  const int left = 20 + 2 * time;
  return scenes::paintGrey(kSize, [=](int x, int y) {
    const int dx = x - left, dy = y - 60;
    if (dx * dx + dy * dy < 60) return uint8_t{220};
    const uint32_t dice =
        mixHash(static_cast<uint32_t>(x), static_cast<uint32_t>(y), static_cast<uint32_t>(time));
    return static_cast<uint8_t>(noise > 0 ? dice % static_cast<uint32_t>(noise + 1) : 0);
  });
}

std::shared_ptr<const background::Foreground> afterFrames(int frames, int noise) {
  const auto stage = background::makeStage({std::make_shared<const Executor>(1), nullptr});
  std::shared_ptr<const background::Foreground> last;
  for (int i = 0; i < frames; ++i)
    last = valueOf(stage->process(discAt(i, noise), {}, {i * 40'000'000LL, true}));
  return last;
}

TEST(Darkness, WhatShinesBeforeBlackIsFound) {
  const auto seen = afterFrames(30, 0);
  EXPECT_EQ(seen->status, Status::Ok);
  EXPECT_FALSE(seen->scene.isDark);
  ASSERT_EQ(seen->areas.size(), 1u);
  EXPECT_TRUE(seen->areas.front().contains({20 + 2 * 29, 60}));
}

TEST(Darkness, NoiseIsNotTakenForThingsWhereSomethingShines) {
  const auto seen = afterFrames(30, 8);
  EXPECT_TRUE(seen->scene.isDark);
  EXPECT_EQ(seen->scene.foregroundPx, 0u);
}

TEST(Darkness, PureBlackIsDark) {
  const auto stage = background::makeStage({std::make_shared<const Executor>(1), nullptr});
  const auto black = scenes::paintGrey(kSize, [](int, int) { return uint8_t{0}; });
  const auto seen = valueOf(stage->process(black, {}, {0, true}));
  EXPECT_EQ(seen->scene.event, SceneEvent::TooDark);
}

}  // namespace
}  // namespace rg
