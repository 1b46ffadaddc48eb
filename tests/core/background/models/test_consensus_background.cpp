// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/ghosts/ghosts.hpp"
#include "core/background/light/light_switch.hpp"
#include "core/background/models/consensus_background.hpp"
#include "core/base/pixel.hpp"
#include "tests/core/simd_targets.hpp"
#include "tests/support/text_picture.hpp"

#include <gtest/gtest.h>

namespace rg {
namespace {

using test::makeGreyPicture;
using test::makePicture;
using test::Rgb;

background::SmoothPicture smoothed(const Picture& picture, int threads = 1) {
  background::SmoothPicture out;
  background::smooth(picture, Executor(threads), out);
  return out;
}

background::SmoothPicture flat(Size size, int level) {
  return smoothed(*makeGreyPicture(size, [&](int, int) { return level; }));
}

background::ConsensusBackground started(const background::SmoothPicture& picture) {
  background::ConsensusBackground model;
  background::prepare(picture.size(), picture.channels, model);
  background::fillFrom(picture, Executor(1), model);
  return model;
}

background::Verdicts judged(const background::SmoothPicture& picture,
                            const background::ConsensusBackground& model,
                            const background::Tolerance& tolerance, int threads = 1) {
  background::Verdicts out;
  background::judge(picture, model, tolerance, Executor(threads), out);
  return out;
}

/// Distance to the second nearest sample: the least tolerance that makes a pixel background.
int distance(const background::SmoothPicture& picture, background::ConsensusBackground& model,
             Point p = {}) {
  model.noise.fill(0);
  int least = 0;
  while (judged(picture, model, {least, 0}).raw.at(p.x, p.y)) ++least;
  return least;
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
  EXPECT_EQ(countSet(judged(picture, started(picture), {0, 0}).raw), 0u);
}

TEST(Consensus, TheChannelThatIsFarthestCounts) {
  const auto before = smoothed(*makePicture({2, 2}, [](int, int) { return Rgb{100, 100, 100}; }));
  const auto after = smoothed(*makePicture({2, 2}, [](int, int) { return Rgb{104, 93, 121}; }));
  auto model = started(before);
  EXPECT_EQ(distance(after, model, {1, 1}), 21);
}

TEST(Consensus, OneSampleIsNoMajority) {
  auto model = started(flat({1, 1}, 50));
  model.sample({0, 0}, 5, 0) = 200;
  EXPECT_EQ(distance(flat({1, 1}, 200), model), 150);
  model.sample({0, 0}, 9, 0) = 203;
  EXPECT_EQ(distance(flat({1, 1}, 200), model), 3);
}

TEST(Consensus, StrongPixelsAreTwoAndAHalfTimesAsFar) {
  auto model = started(flat({1, 1}, 50));
  model.noise.fill(0);
  const auto verdicts = [&](int level, int least) {
    const background::Verdicts out = judged(flat({1, 1}, level), model, {least, 0});
    return std::pair{out.raw.at(0, 0), out.strong.at(0, 0)};
  };
  EXPECT_EQ(verdicts(60, 10), std::pair(false, false));
  EXPECT_EQ(verdicts(61, 10), std::pair(true, false));
  EXPECT_EQ(verdicts(75, 10), std::pair(true, false));
  EXPECT_EQ(verdicts(76, 10), std::pair(true, true));
}

TEST(Consensus, FaintPixelsAreFartherThanSevenEighthsOfTheRadius) {
  auto model = started(flat({1, 1}, 50));
  model.noise.fill(0);
  const auto isFaint = [&](int level, int least) {
    return judged(flat({1, 1}, level), model, {least, 0}).faint.at(0, 0);
  };
  EXPECT_FALSE(isFaint(64, 16));
  EXPECT_TRUE(isFaint(65, 16));
  EXPECT_TRUE(isFaint(200, 16));
  EXPECT_FALSE(isFaint(54, 5));
  EXPECT_TRUE(isFaint(55, 5));
}

/// Learns a level in all pixels or none for some frames; returns those that don't know it then.
uint32_t strangersAfter(bool isForeground, uint32_t frames, int threads = 1) {
  const Size size{70, 40};
  auto model = started(flat(size, 50));
  const auto picture = flat(size, 120);
  BitMask foreground(size), quiet(size);
  foreground.clear();
  quiet.clear();
  for (int y = 0; y < size.height; ++y) setColumns(foreground.row(y), 0, size.width, isForeground);
  for (uint32_t frame = 1; frame <= frames; ++frame)
    background::learn(picture, {foreground, foreground, quiet, quiet, quiet}, {frame, 8, false},
                      Executor(threads), model);
  model.noise.fill(0);
  return countSet(judged(picture, model, {0, 0}).raw);
}

TEST(Consensus, LearnsBackgroundAndNothingElse) {
  EXPECT_EQ(strangersAfter(false, 150), 0u);
  EXPECT_EQ(strangersAfter(true, 150), 70u * 40u);
}

TEST(Consensus, NoiseIsNotLearntBesideTheForeground) {
  const Size size{64, 16};
  auto model = started(flat(size, 50));
  model.noise.fill(0);
  BitMask quiet(size), near(size);
  quiet.clear();
  near.clear();
  near.set(5, 3);
  for (uint32_t frame = 1; frame <= 16; ++frame)
    background::learn(flat(size, 60), {quiet, near, quiet, quiet, quiet}, {frame, 4096, false},
                      Executor(1), model);
  EXPECT_EQ(model.noise.at(5, 3), 0);
  EXPECT_GT(model.noise.at(6, 3), 0);
}

TEST(Consensus, TheRateIsThePartOfPixelsLearntInAFrame) {
  const Size size{640, 480};
  auto model = started(flat(size, 50));
  BitMask quiet(size);
  quiet.clear();
  const auto picture = flat(size, 120);
  background::learn(picture, {quiet, quiet, quiet, quiet, quiet}, {1, 10, false}, Executor(1),
                    model);
  int64_t learnt = 0;
  for (int row = 0; row < model.samples.height(); ++row)
    learnt +=
        std::count(model.samples.row(row), model.samples.row(row) + model.samples.width(), 120);
  // A tenth by itself and a tenth from a neighbour: 19200 dice for 16 columns, rolled twice.
  EXPECT_NEAR(static_cast<double>(learnt), 2 * 640 * 48, 0.15 * 2 * 640 * 48);
}

TEST(Consensus, RestlessPixelsLearnTwiceAsFast) {
  const Size size{640, 480};
  const auto picture = flat(size, 120);
  BitMask quiet(size);
  quiet.clear();
  std::array<int64_t, 2> learnt{};
  for (const int unrest : {100, 200}) {
    auto model = started(flat(size, 50));
    model.unrest.fill(static_cast<uint8_t>(unrest));
    background::learn(picture, {quiet, quiet, quiet, quiet, quiet}, {8, 10, false}, Executor(1),
                      model);
    for (int row = 0; row < model.samples.height(); ++row)
      learnt[unrest > 127] +=
          std::count(model.samples.row(row), model.samples.row(row) + model.samples.width(), 120);
  }
  EXPECT_NEAR(static_cast<double>(learnt[1]) / static_cast<double>(learnt[0]), 2, 0.2);
}

/// Of a pixel whose verdict flips in every frame.
int unrestAfter(int frames, bool wasCovered, uint32_t calmPeriod) {
  const Size size{8, 8};
  auto model = started(flat(size, 50));
  BitMask quiet(size), seen(size), covered(size);
  for (BitMask* mask : {&quiet, &seen, &covered}) mask->clear();
  seen.set(4, 4);
  if (wasCovered) covered.set(4, 4);
  for (uint32_t frame = 1; frame <= static_cast<uint32_t>(frames); ++frame)
    background::learn(flat(size, 50), {quiet, quiet, seen, covered, quiet},
                      {frame, 16, false, calmPeriod}, Executor(1), model);
  EXPECT_EQ(model.unrest.at(3, 4), 0);
  return model.unrest.at(4, 4);
}

TEST(Consensus, WhatAThingUncoversIsHalfAsRestless) {
  EXPECT_EQ(unrestAfter(3, false, 64), 48);
  EXPECT_EQ(unrestAfter(3, true, 64), 24);
  EXPECT_EQ(unrestAfter(100, true, 4096), 255);
}

TEST(Consensus, UnrestIsForgottenInTheTurnsThatTheRateNames) {
  // Row 4 has its turn in frames 4, 12, 20 or in 12 only.
  EXPECT_EQ(unrestAfter(10, true, 8), 72);
  EXPECT_EQ(unrestAfter(12, true, 8), 80);
  EXPECT_EQ(unrestAfter(12, true, 16), 88);
  EXPECT_EQ(unrestAfter(12, true, 32), 96);
}

/// A model that has seen some frames with foreground, restless and noisy pixels in them.
background::ConsensusBackground modelAfterFrames(const Executor& executor) {
  const Size size{270, 64};
  auto model = started(flat(size, 50));
  BitMask mask(size), before(size);
  mask.clear();
  before.clear();
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      if ((x / 5 + y / 7) % 3 == 0) mask.set(x, y);
  background::Verdicts verdicts;
  for (uint32_t frame = 1; frame < 40; ++frame) {
    const auto picture = smoothed(*makePicture(size, [&](int x, int y) {
      const auto level =
          static_cast<uint8_t>(x * 3 + y + static_cast<int>(mixHash(frame, 0, 0) % 40));
      return Rgb{level, static_cast<uint8_t>(y), 30};
    }));
    background::judge(picture, model, {8, 18}, executor, verdicts);
    background::learn(picture, {mask, mask, verdicts.raw, mask, before}, {frame, 4, frame < 5},
                      executor, model);
    std::swap(verdicts.raw, before);
  }
  return model;
}

void expectSameRows(const Image<uint8_t>& a, const Image<uint8_t>& b) {
  for (int y = 0; y < a.height(); ++y)
    ASSERT_EQ(std::memcmp(a.row(y), b.row(y), static_cast<size_t>(a.width())), 0) << "row " << y;
}

TEST(Consensus, TargetsAndThreadsChangeNoSample) {
  const background::ConsensusBackground expected = modelAfterFrames(Executor(1));
  test::forEachTargetAndThreads([&](const std::shared_ptr<const Executor>& executor) {
    const background::ConsensusBackground model = modelAfterFrames(*executor);
    expectSameRows(model.samples, expected.samples);
    expectSameRows(model.noise, expected.noise);
    expectSameRows(model.unrest, expected.unrest);
  });
}

TEST(Consensus, BrightNoisyAndRestlessPixelsAreToleratedFurther) {
  const auto dark = flat({1, 1}, 0), bright = flat({1, 1}, 255);
  auto model = started(dark);
  const auto radius = [&](const background::SmoothPicture& picture,
                          const background::Tolerance& tolerance) {
    return background::radiusAt(background::radiusRow(model, tolerance, 0),
                                picture.planes[0].at(0, 0), 0);
  };
  model.noise.fill(0);
  EXPECT_EQ(radius(dark, {8, 64}), 8);
  EXPECT_EQ(radius(bright, {8, 64}), 8 + 63);
  model.noise.fill(40);  // Five grey levels.
  model.unrest.fill(255);
  EXPECT_EQ(radius(dark, {8, 64}), 8 + 10 + 15);
  EXPECT_EQ(radius(bright, {250, 255}), 255);
}

TEST(Consensus, RelightingMapsEverySample) {
  auto model = started(flat({5, 2}, 60));
  background::LevelMaps maps{};
  maps[0].fill(0);
  maps[0][60] = 150;
  background::relight(maps, Executor(1), model);
  EXPECT_EQ(countSet(judged(flat({5, 2}, 150), model, {0, 0}).raw), 0u);
}

/// A square of 8x8 at 40 on a wall of 160, in the model, in the picture, or in both.
background::SmoothPicture square(bool isThere) {
  return smoothed(*makeGreyPicture({24, 24}, [&](int x, int y) {
    return isThere && x >= 8 && x < 16 && y >= 8 && y < 16 ? 40 : 160;
  }));
}

uint32_t ghostPixels(bool inModel, bool inPicture, int age) {
  const auto picture = square(inPicture);
  auto model = started(square(inModel));
  BitMask mask({24, 24}), ghosts({24, 24});
  mask.clear();
  for (int y = 8; y < 16; ++y) setColumns(mask.row(y), 8, 16, true);
  model.noise.fill(0);
  background::StillPixels still;
  background::prepare({24, 24}, 1, still);
  background::clear(still);
  for (int i = 0; i < age; ++i)
    background::followStill(picture, model, {10, 0}, mask, UINT16_MAX, Executor(1), still);
  background::StillScratch scratch;
  return background::findGhosts(picture, model, mask, still, 10, scratch, ghosts);
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
  background::StillPixels still;
  background::prepare(size, 1, still);
  background::clear(still);
  BitMask mask(size);
  mask.clear();
  mask.set(0, 0);
  auto model = started(flat(size, 0));
  model.noise.fill(0);
  const auto age = [&](int level) {
    background::followStill(flat(size, level), model, {10, 0}, mask, UINT16_MAX, Executor(1),
                            still);
    return int{still.ages.at(0, 0)};
  };
  EXPECT_EQ(age(100), 1);
  EXPECT_EQ(age(110), 2);
  EXPECT_EQ(age(90), 3);
  EXPECT_EQ(age(111), 2);
  EXPECT_EQ(age(111), 1);
  EXPECT_EQ(age(111), 1);  // Its new colour.
  EXPECT_EQ(age(111), 2);
  mask.clear();
  EXPECT_EQ(age(111), 0);
}

}  // namespace
}  // namespace rg
