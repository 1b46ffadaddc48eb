// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/tracking/scene_scale.hpp"

#include <gtest/gtest.h>

#include <random>

namespace rg {
namespace {

constexpr int kPx = 16;
constexpr Size kFrame{768, 576};

objects::Extent extent(int widthPx, int heightPx) {
  return {widthPx * kPx, heightPx * kPx};
}

/// Samples come from twenty things in turn.
uint64_t thing(int sample) {
  return static_cast<uint64_t>((sample + 100) % 20);
}

TEST(SceneScale, SaysNothingBeforeItHasSeenEnough) {
  objects::SceneScale scale;
  scale.reset(kFrame);
  EXPECT_FALSE(scale.isKnown());
  EXPECT_EQ(scale.at(300).height, 0);
  for (int i = 0; i < 5; ++i) scale.learn(thing(i), 300 + i, extent(30, 80));
  EXPECT_FALSE(scale.isKnown());
}

TEST(SceneScale, OneSizeInOneBandIsThatSizeEverywhere) {
  objects::SceneScale scale;
  scale.reset(kFrame);
  for (int i = 0; i < 20; ++i) scale.learn(thing(i), 300, extent(30, 80));
  ASSERT_TRUE(scale.isKnown());
  EXPECT_TRUE(scale.isUniform());
  for (const int row : {0, 300, 575}) {
    EXPECT_EQ(scale.at(row).height, 80 * kPx);
    EXPECT_EQ(scale.at(row).width, 30 * kPx);
  }
}

/// Heights of row / 4 + 10 px, a share of them wrong.
objects::SceneScale lineWithOutliers(int wrongOfTen) {
  std::mt19937 random(7);
  std::uniform_int_distribution<int> row(200, 560), noise(-2, 2), tenth(0, 9), any(10, 300);
  objects::SceneScale scale;
  scale.reset(kFrame);
  for (int i = 0; i < 300; ++i) {
    const int foot = row(random);
    const int height = foot / 4 + 10 + noise(random);
    scale.learn(thing(i), foot,
                tenth(random) < wrongOfTen ? extent(any(random), any(random))
                                           : extent(height * 2 / 5, height));
  }
  return scale;
}

TEST(SceneScale, LearnsALine) {
  const objects::SceneScale scale = lineWithOutliers(0);
  for (const int row : {220, 380, 540})
    EXPECT_NEAR(scale.at(row).height, (row / 4 + 10) * kPx, 4 * kPx);
}

TEST(SceneScale, ATenthOfNonsenseChangesLittle) {
  const objects::SceneScale scale = lineWithOutliers(1);
  for (const int row : {220, 380, 540})
    EXPECT_NEAR(scale.at(row).height, (row / 4 + 10) * kPx, 10 * kPx);
}

TEST(SceneScale, ThingsOfAllSizesAreNotUniform) {
  objects::SceneScale scale;
  scale.reset(kFrame);
  for (int i = 0; i < 40; ++i) scale.learn(thing(i), 300, extent(30, i % 2 == 0 ? 40 : 100));
  ASSERT_TRUE(scale.isKnown());
  EXPECT_FALSE(scale.isUniform());
}

TEST(SceneScale, ThingsOfOneHeightAndOfAllWidthsAreNotUniform) {
  objects::SceneScale scale;
  scale.reset(kFrame);
  for (int i = 0; i < 40; ++i) scale.learn(thing(i), 300, extent(i % 2 == 0 ? 30 : 140, 80));
  EXPECT_FALSE(scale.isUniform());
}

TEST(SceneScale, ThingsOfTwoWidthsAreNotUniform) {
  objects::SceneScale scale;
  scale.reset({640, 480});
  for (int i = 0; i < 60; ++i)
    scale.learn(static_cast<uint64_t>(i % 24), 200, {(i % 3 == 0 ? 55 : 30) * 16, 60 * 16});
  EXPECT_TRUE(scale.isKnown());
  EXPECT_FALSE(scale.isUniform());
}

TEST(SceneScale, OneThingAloneSaysNothingOfOthers) {
  objects::SceneScale scale;
  scale.reset(kFrame);
  for (int i = 0; i < 40; ++i) scale.learn(7, 300, extent(30, 80));
  EXPECT_TRUE(scale.isKnown());
  EXPECT_FALSE(scale.isUniform());
}

TEST(SceneScale, AFewThingsThatAreAlikeMayBeSoByChance) {
  objects::SceneScale scale;
  scale.reset(kFrame);
  for (int i = 0; i < 21; ++i)
    scale.learn(static_cast<uint64_t>(i % 7), 300 + i % 3, extent(30, 80));
  EXPECT_TRUE(scale.isKnown());
  EXPECT_FALSE(scale.isUniform());
  scale.learn(7, 300, extent(30, 80));
  EXPECT_TRUE(scale.isUniform());
}

TEST(SceneScale, AnUnknownWidthLeavesTheWidthAlone) {
  objects::SceneScale scale;
  scale.reset(kFrame);
  for (int i = 0; i < 12; ++i) scale.learn(thing(i), 300, extent(30, 80));
  for (int i = 0; i < 8; ++i) scale.learn(thing(i), 300, extent(0, 80));
  EXPECT_EQ(scale.at(300).width, 30 * kPx);
}

TEST(SceneScale, ExtremeRowsAndSizesAreFine) {
  objects::SceneScale scale;
  scale.reset({1, 1});
  for (int i = -50; i < 50; ++i) scale.learn(thing(i), i, extent(1 + (i & 3), 1 + (i & 7)));
  EXPECT_GT(scale.at(-1000).height, 0);
  EXPECT_GT(scale.at(100000).height, 0);
}

}  // namespace
}  // namespace rg
