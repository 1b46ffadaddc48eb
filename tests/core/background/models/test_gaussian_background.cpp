// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/models/gaussian_background.hpp"
#include "core/base/time/frame_clock.hpp"
#include "tests/support/text_picture.hpp"

#include <gtest/gtest.h>

namespace rg {
namespace {

using test::makeGreyPicture;

background::GaussianBackground trained(std::initializer_list<int> levels) {
  const Executor executor(1);
  background::GaussianBackground model;
  for (const int level : levels) {
    const auto picture = makeGreyPicture({1, 1}, [&](int, int) { return level; });
    if (model.channels == 0) background::startTraining(*picture, model);
    background::train(*picture, executor, model);
  }
  background::finishTraining(executor, model);
  return model;
}

struct Verdict {
  bool simple, gaussian;
};

Verdict judge(const background::GaussianBackground& model, int level, int threshold) {
  const auto picture = makeGreyPicture({1, 1}, [&](int, int) { return level; });
  Image<uint8_t> simple, gaussian;
  background::testGaussian(*picture, model, threshold, Executor(1), simple, gaussian);
  return {simple.at(0, 0) == 255, gaussian.at(0, 0) == 255};
}

TEST(GaussianBackground, MeanAndVarianceAreExact) {
  const auto model = trained({90, 110, 90, 110});
  EXPECT_EQ(model.means[0].at(0, 0), 100 * 256);
  EXPECT_EQ(model.variances[0].at(0, 0), 100 * 16);
}

TEST(GaussianBackground, VarianceHasAFloorAndACeiling) {
  EXPECT_EQ(trained({50, 50, 50}).variances[0].at(0, 0), 4 * 16);
  EXPECT_EQ(trained({0, 255}).variances[0].at(0, 0), 3600 * 16);
}

TEST(GaussianBackground, OneFrameTrains) {
  EXPECT_EQ(trained({255}).means[0].at(0, 0), 255 * 256);
}

TEST(GaussianBackground, SimpleTestIsStrictlyAboveTheThreshold) {
  const auto model = trained({100});
  EXPECT_FALSE(judge(model, 140, 40).simple);
  EXPECT_TRUE(judge(model, 141, 40).simple);
  EXPECT_TRUE(judge(model, 59, 40).simple);
}

TEST(GaussianBackground, GaussianTestIsThreeDeviations) {
  const auto model = trained({90, 110});  // Deviation 10.
  EXPECT_FALSE(judge(model, 130, 40).gaussian);
  EXPECT_TRUE(judge(model, 131, 40).gaussian);
  EXPECT_TRUE(judge(model, 69, 40).gaussian);
}

TEST(GaussianBackground, ExtremesDoNotOverflow) {
  EXPECT_TRUE(judge(trained({0}), 255, 254).simple);
  EXPECT_TRUE(judge(trained({0}), 255, 254).gaussian);
  EXPECT_TRUE(judge(trained({255}), 0, 254).gaussian);
}

TEST(GaussianBackground, TheUpdateReachesAStepWithinItsDeadZone) {
  const Executor executor(1);
  auto model = trained({100});
  const auto picture = makeGreyPicture({1, 1}, [](int, int) { return 120; });
  Image<uint8_t> foreground({1, 1});
  foreground.fill(0);
  for (uint32_t frame = 0; frame < 3000; ++frame)
    background::updateGaussian(*picture, foreground,
                               {background::updateRate(256), background::updateRate(256), frame},
                               executor, model);
  EXPECT_NEAR(model.means[0].at(0, 0), 120 * 256, 128);
}

TEST(GaussianBackground, ForegroundIsLearntAtTheSlowRate) {
  const Executor executor(1);
  auto model = trained({100});
  const auto picture = makeGreyPicture({1, 1}, [](int, int) { return 200; });
  Image<uint8_t> foreground({1, 1});
  foreground.fill(255);
  for (uint32_t frame = 1; frame < 64; ++frame)
    background::updateGaussian(*picture, foreground,
                               {background::updateRate(4), background::updateRate(64 * 256), frame},
                               executor, model);
  EXPECT_EQ(model.means[0].at(0, 0), 100 * 256);
  background::updateGaussian(*picture, foreground,
                             {background::updateRate(4), background::updateRate(64 * 256), 64},
                             executor, model);
  EXPECT_EQ(model.means[0].at(0, 0), 100 * 256 + 100);
}

TEST(GaussianBackground, RatesArePowersOfTwoNearTheFrames) {
  EXPECT_EQ(background::updateRate(16).shift, 4);
  EXPECT_EQ(background::updateRate(250).shift, 8);
  EXPECT_EQ(background::updateRate(1024).shift, 8);
  EXPECT_EQ(background::updateRate(1024).period, 4u);
  EXPECT_EQ(background::updateRate(0).shift, 1);
  EXPECT_EQ(background::updateRate(INT64_MAX).shift, 8);
}

TEST(FrameClock, CountsFramesByTheStreamsOwnTimes) {
  FrameClock clock;
  EXPECT_EQ(clock.frames(1.0), 25);
  for (int i = 0; i < 5; ++i) clock.tick({i * 100'000'000, true});
  EXPECT_EQ(clock.frames(1.0), 10);
}

TEST(FrameClock, GapsAndStepsBackSayNothing) {
  FrameClock clock;
  clock.tick({0, true});
  clock.tick({100'000'000, true});
  clock.tick({90'000'000, true});
  clock.tick({90'000'000, true});
  clock.tick({9'000'000'000, true});
  clock.breakOff();
  clock.tick({9'500'000'000, true});
  EXPECT_EQ(clock.frames(1.0), 10);
  EXPECT_EQ(clock.frames(-1.0), 1);
  EXPECT_EQ(clock.frames(1e300), 10'000'000);
}

}  // namespace
}  // namespace rg
