// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/light/exposure.hpp"
#include "tests/core/staged_scene.hpp"

#include <algorithm>
#include <cstdlib>

namespace rg {
namespace {

using background::GainSums;
using background::kLeastGain;
using background::kMostGain;
using background::kSameGain;
using background::LevelMap;
using test::marksOf;
using test::StagedScene;
using test::Take;
using test::Texture;
using test::walkerAt;

TEST(Exposure, TheGainIsTheMedianByWeight) {
  GainSums sums;
  EXPECT_EQ(medianGain(sums), kSameGain);
  sums.weight[600] = 10;
  sums.weight[300] = 4;
  sums.weight[700] = 5;
  EXPECT_EQ(medianGain(sums), 600);
  sums.weight[kMostGain + 1] = 30;
  EXPECT_EQ(medianGain(sums), kSameGain);
}

TEST(Exposure, LightThatIsNotTheSameEverywhereIsNoGain) {
  GainSums sums;
  for (int gain = kSameGain; gain < kMostGain; gain += 16) sums.weight[gain] = 7;
  EXPECT_EQ(medianGain(sums), kSameGain);
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

}  // namespace
}  // namespace rg
