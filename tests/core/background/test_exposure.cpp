// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/light/exposure.hpp"
#include "tests/core/staged_scene.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace rg {
namespace {

using background::GainSums;
using background::kLeastGain;
using background::kMostGain;
using background::kNoGain;
using background::kSameGain;
using background::LevelMap;
using test::marksOf;
using test::Stage;
using test::StagedScene;
using test::Take;
using test::Texture;
using test::walkerAt;

TEST(Exposure, TheGainIsTheMedianByWeight) {
  GainSums sums;
  EXPECT_EQ(medianGain(sums), kNoGain);
  sums.weight[600] = 10;
  sums.weight[300] = 4;
  sums.weight[700] = 5;
  EXPECT_EQ(medianGain(sums), 600);
  sums.weight[kMostGain + 1] = 30;
  EXPECT_EQ(medianGain(sums), kNoGain);
}

TEST(Exposure, LightThatIsNotTheSameEverywhereIsNoGain) {
  GainSums sums;
  for (int gain = kSameGain; gain < kMostGain; gain += 16) sums.weight[gain] = 7;
  EXPECT_EQ(medianGain(sums), kNoGain);
}

TEST(Exposure, TheSameGainChangesNoLevel) {
  const LevelMap map = background::withoutGain(kSameGain);
  for (int level = 0; level < 256; ++level) EXPECT_EQ(map[static_cast<size_t>(level)], level);
}

TEST(Exposure, AGainIsTakenBack) {
  for (int gain = kLeastGain; gain <= kMostGain; gain += 16) {
    const LevelMap map = background::withoutGain(gain);
    EXPECT_TRUE(std::is_sorted(map.begin(), map.end())) << gain;
    for (int level = 0; level < 256; ++level) {
      const int shown = (level * gain + kSameGain / 2) / kSameGain;
      if (shown > GainSums::kClipped) break;
      EXPECT_LE(std::abs(map[static_cast<size_t>(shown)] - level), 1) << gain << ' ' << level;
    }
  }
}

TEST(Exposure, AGainIsGiven) {
  EXPECT_EQ(background::withGain(3 * kSameGain / 2)[100], 150);
  EXPECT_EQ(background::withGain(3 * kSameGain / 2)[200], 255);
  EXPECT_EQ(background::withGain(kLeastGain)[100], 50);
}

TEST(Exposure, WhatIsClippedLiesBetweenTheLeastThatItCanBeAndWhite) {
  EXPECT_EQ(background::withoutGain(kMostGain)[255], (128 + 255) / 2);
  EXPECT_EQ(background::withoutGain(kLeastGain)[255], 255);
}

/// Up and down by a quarter within 7 s, with a walker in view.
TEST(Exposure, AHuntingGainLeavesTheWalkerAndNothingElse) {
  for (const Texture texture : {Texture::Tiles, Texture::Stone, Texture::Ramp, Texture::Stripes}) {
    SCOPED_TRACE(static_cast<int>(texture));
    StagedScene scene({texture, 3, 7});
    scene.showFor(50, {});
    constexpr int kFrames = 180;
    int found = 0;
    double wrong = 0;
    for (int i = 0; i < kFrames; ++i) {
      Take take{walkerAt(i % 60), 100, {}, false};
      const int along = (i + kFrames / 4) % kFrames;
      take.gainPercent = 75 + 50 * std::min(along, kFrames - along) / (kFrames / 2);
      const auto shown = scene.show(take);
      EXPECT_NE(shown->scene.event, background::SceneEvent::LightSwitched) << "frame " << i;
      found += marksOf(*shown, take.walker).foundPercent;
      wrong += marksOf(*shown, take.walker).falsePercent;
    }
    EXPECT_GE(found, 85 * kFrames);
    EXPECT_LT(wrong, 0.5 * kFrames);
  }
}

/// Three octaves in 16 s, up or down, with a walker in view from the middle on.
void expectOnlyTheWalker(const Stage& stage, bool brightens) {
  SCOPED_TRACE(::testing::Message() << stage << (brightens ? ", brightens" : ", darkens"));
  StagedScene scene(stage);
  constexpr int kFrames = 400;
  const auto gainAt = [&](int frame) {
    const double octaves = 3.0 * (brightens ? frame - kFrames : -frame) / kFrames;
    return static_cast<int>(std::lround(140 * std::exp2(octaves)));
  };
  scene.showFor(50, {{}, gainAt(0), {}, false});
  double wrong = 0;
  int found = 0;
  for (int i = 0; i < kFrames; ++i) {
    Take take{{}, gainAt(i), {}, false};
    if (i >= kFrames / 2) take.walker = walkerAt(i % 60);
    const auto shown = scene.show(take);
    EXPECT_NE(shown->scene.event, background::SceneEvent::CameraMoved) << "frame " << i;
    const auto marks = marksOf(*shown, take.walker);
    found += marks.foundPercent;
    wrong += marks.falsePercent;
  }
  EXPECT_GE(found, 85 * kFrames / 2);
  EXPECT_LT(wrong, 0.5 * kFrames);
}

TEST(Exposure, LightThatGoesOnIsFollowedAsFarAsItGoes) {
  for (const Texture texture : {Texture::Tiles, Texture::Stone, Texture::Ramp, Texture::Stripes})
    for (const bool brightens : {true, false}) expectOnlyTheWalker({texture, 1, 7}, brightens);
}

}  // namespace
}  // namespace rg
