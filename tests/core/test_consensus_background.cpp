// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/consensus_background.hpp"
#include "core/light_switch.hpp"
#include "core/still_parts.hpp"
#include "tests/support/text_picture.hpp"

#include <gtest/gtest.h>

namespace rg {
namespace {

using test::makeGreyPicture;
using test::makePicture;
using test::Rgb;

SmoothPicture smoothed(const Picture& picture, int threads = 1) {
  SmoothPicture out;
  smooth(picture, Executor(threads), out);
  return out;
}

SmoothPicture flat(Size size, int level) {
  return smoothed(*makeGreyPicture(size, [&](int, int) { return level; }));
}

ConsensusBackground started(const SmoothPicture& picture) {
  ConsensusBackground model;
  prepare(picture.size(), picture.channels, model);
  fillFrom(picture, Executor(1), model);
  return model;
}

Distances measured(const SmoothPicture& picture, const ConsensusBackground& model) {
  Distances out;
  measure(picture, model, Executor(1), out);
  return out;
}

TEST(SmoothPicture, WeighsOneTwoOneBothWays) {
  const auto picture =
      makeGreyPicture({5, 5}, [](int x, int y) { return x == 2 && y == 2 ? 160 : 0; });
  const auto out = smoothed(*picture);
  EXPECT_EQ(out.planes[0].at(2, 2), 40);
  EXPECT_EQ(out.planes[0].at(1, 2), 20);
  EXPECT_EQ(out.planes[0].at(3, 3), 10);
  EXPECT_EQ(out.planes[0].at(0, 2), 0);
}

TEST(SmoothPicture, KeepsAFlatPictureUpToItsBordersAtAnyWidth) {
  for (const Size size : {Size{1, 1}, Size{1, 9}, Size{257, 2}, Size{512, 1}}) {
    const auto out = flat(size, 255);
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) ASSERT_EQ(out.planes[0].at(x, y), 255);
  }
}

TEST(Consensus, AStartKnowsItsPicture) {
  const auto picture = flat({300, 3}, 90);
  const auto distances = measured(picture, started(picture));
  for (int x = 0; x < 300; ++x) EXPECT_EQ(distances.second.at(x, 1), 0);
}

TEST(Consensus, TheChannelThatIsFarthestCounts) {
  const auto before = smoothed(*makePicture({2, 2}, [](int, int) { return Rgb{100, 100, 100}; }));
  const auto after = smoothed(*makePicture({2, 2}, [](int, int) { return Rgb{104, 93, 121}; }));
  EXPECT_EQ(measured(after, started(before)).nearest.at(1, 1), 21);
}

TEST(Consensus, OneSampleIsNoMajority) {
  auto model = started(flat({1, 1}, 50));
  model.samples.at(0, 5) = 200;
  auto distances = measured(flat({1, 1}, 200), model);
  EXPECT_EQ(distances.nearest.at(0, 0), 0);
  EXPECT_EQ(distances.second.at(0, 0), 150);
  model.samples.at(0, 9) = 203;
  distances = measured(flat({1, 1}, 200), model);
  EXPECT_EQ(distances.second.at(0, 0), 3);
}

/// Learns a level in all pixels or none for some frames; returns the second distance after it.
int distanceAfter(uint8_t mask, uint32_t frames, int threads = 1) {
  const Size size{64, 40};
  auto model = started(flat(size, 50));
  const auto picture = flat(size, 120);
  Image<uint8_t> foreground(size), quiet(size);
  foreground.fill(mask);
  quiet.fill(0);
  const Distances distances = measured(picture, model);
  for (uint32_t frame = 1; frame <= frames; ++frame)
    learn(picture, {foreground, quiet, quiet}, distances, {frame, 8, false}, Executor(threads),
          model);
  int worst = 0;
  const Distances after = measured(picture, model);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) worst = std::max(worst, int{after.second.at(x, y)});
  return worst;
}

TEST(Consensus, LearnsBackgroundAndNothingElse) {
  EXPECT_EQ(distanceAfter(0, 150), 0);
  EXPECT_EQ(distanceAfter(255, 150), 70);
}

TEST(Consensus, ThreadsChangeNoSample) {
  const Size size{70, 64};
  const auto before = flat(size, 50);
  const auto after = smoothed(*makeGreyPicture(size, [](int x, int y) { return x * 3 + y; }), 2);
  Image<uint8_t> mask(size);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) mask.at(x, y) = (x / 5 + y / 7) % 3 == 0 ? 255 : 0;
  std::array<ConsensusBackground, 2> models{started(before), started(before)};
  for (int threads : {1, 2})
    for (uint32_t frame = 1; frame < 40; ++frame) {
      ConsensusBackground& model = models[static_cast<size_t>(threads - 1)];
      learn(after, {mask, mask, mask}, measured(after, model), {frame, 4, false}, Executor(threads),
            model);
    }
  for (int row = 0; row < models[0].samples.height(); ++row)
    ASSERT_EQ(std::memcmp(models[0].samples.row(row), models[1].samples.row(row), 70), 0) << row;
}

TEST(Consensus, BrightNoisyAndRestlessPixelsAreToleratedFurther) {
  const auto dark = flat({1, 1}, 0), bright = flat({1, 1}, 255);
  auto model = started(dark);
  model.noise.fill(0);
  Image<uint8_t> radii;
  findRadii(dark, model, {8, 64}, Executor(1), radii);
  EXPECT_EQ(radii.at(0, 0), 8);
  findRadii(bright, model, {8, 64}, Executor(1), radii);
  EXPECT_EQ(radii.at(0, 0), 8 + 63);
  model.noise.fill(40);  // Five grey levels.
  model.unrest.fill(255);
  findRadii(dark, model, {8, 64}, Executor(1), radii);
  EXPECT_EQ(radii.at(0, 0), 8 + 10 + 15);
  findRadii(bright, model, {250, 255}, Executor(1), radii);
  EXPECT_EQ(radii.at(0, 0), 255);
}

TEST(Consensus, RelightingMapsEverySample) {
  auto model = started(flat({5, 2}, 60));
  LevelMaps maps{};
  maps[0].fill(0);
  maps[0][60] = 150;
  relight(maps, Executor(1), model);
  EXPECT_EQ(measured(flat({5, 2}, 150), model).second.at(4, 1), 0);
}

/// A square of 8x8 at 40 on a wall of 160, in the model, in the picture, or in both.
SmoothPicture square(bool isThere) {
  return smoothed(*makeGreyPicture({24, 24}, [&](int x, int y) {
    return isThere && x >= 8 && x < 16 && y >= 8 && y < 16 ? 40 : 160;
  }));
}

uint32_t ghostPixels(bool inModel, bool inPicture, int age) {
  const auto picture = square(inPicture);
  auto model = started(square(inModel));
  Image<uint8_t> mask({24, 24}), radii({24, 24}), ghosts({24, 24});
  for (int y = 0; y < 24; ++y)
    for (int x = 0; x < 24; ++x) mask.at(x, y) = x >= 8 && x < 16 && y >= 8 && y < 16 ? 255 : 0;
  radii.fill(10);
  StillPixels still;
  prepare({24, 24}, 1, still);
  still.ages.fill(0);
  still.fresh.fill(0);
  for (int i = 0; i < age; ++i) followStill(picture, mask, radii, Executor(1), still);
  StillScratch scratch;
  return findGhosts(picture, model, mask, still, 10, scratch, ghosts);
}

TEST(StillParts, WhatTheModelShowsAloneIsAGhost) {
  EXPECT_EQ(ghostPixels(true, false, 10), 64u);
}

TEST(StillParts, WhatThePictureShowsIsAnObject) {
  EXPECT_EQ(ghostPixels(false, true, 100), 0u);
}

TEST(StillParts, NoVerdictBeforeItsAge) {
  EXPECT_EQ(ghostPixels(true, false, 9), 0u);
}

TEST(StillParts, AChangeOfColourMakesYoung) {
  const Size size{1, 1};
  StillPixels still;
  prepare(size, 1, still);
  still.ages.fill(0);
  still.fresh.fill(0);
  Image<uint8_t> mask(size), radii(size);
  mask.fill(255);
  radii.fill(10);
  const auto age = [&](int level) {
    followStill(flat(size, level), mask, radii, Executor(1), still);
    return int{still.ages.at(0, 0)};
  };
  EXPECT_EQ(age(100), 1);
  EXPECT_EQ(age(110), 2);
  EXPECT_EQ(age(90), 3);
  EXPECT_EQ(age(111), 2);
  EXPECT_EQ(age(111), 1);
  EXPECT_EQ(age(111), 1);  // Its new colour.
  EXPECT_EQ(age(111), 2);
  mask.fill(0);
  EXPECT_EQ(age(111), 0);
}

}  // namespace
}  // namespace rg
