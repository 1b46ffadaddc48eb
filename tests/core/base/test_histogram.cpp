// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/light/light_switch.hpp"
#include "core/background/models/frame_difference.hpp"
#include "core/base/histogram.hpp"
#include "tests/support/text_picture.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace rg {
namespace {

TEST(Histogram, CountsEveryPixelOnceForAnyThreads) {
  Image<uint8_t> image({67, 131});
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x) image.at(x, y) = static_cast<uint8_t>(x * 7 + y * 3);
  const Histogram one = countLevels(image, Executor(1));
  EXPECT_EQ(one, countLevels(image, Executor(2)));
  uint64_t total = 0;
  for (const uint32_t count : one) total += count;
  EXPECT_EQ(total, 67u * 131u);
}

TEST(Histogram, QuantilesScanUpwards) {
  Histogram histogram{};
  histogram[10] = 3;
  histogram[20] = 1;
  EXPECT_EQ(quantile(histogram, 128), 10);
  EXPECT_EQ(quantile(histogram, 192), 10);
  EXPECT_EQ(quantile(histogram, 256), 20);
}

TEST(Histogram, TheThresholdLiesAtTheFootOfTheNoise) {
  Histogram histogram{};
  // Noise falls from 0 to 5, motion is thin and wide.
  for (size_t i = 0; i < 6; ++i) histogram[i] = static_cast<uint32_t>(6000 - 1000 * i);
  for (size_t i = 6; i < 120; ++i) histogram[i] = 5;
  EXPECT_EQ(differenceThreshold(histogram, 0), 6);
  EXPECT_EQ(differenceThreshold(histogram, 25), 25);
}

TEST(Histogram, AStillPictureKeepsTheLeastThreshold) {
  Histogram histogram{};
  histogram[0] = 1000;
  EXPECT_EQ(differenceThreshold(histogram, 12), 12);
  EXPECT_GE(differenceThreshold(Histogram{}, 12), 12);
}

TEST(FrameDifference, TakesTheChannelThatChangedMost) {
  const auto a = test::makePicture({2, 1}, [](int, int) { return test::Rgb{10, 20, 30}; });
  const auto b = test::makePicture({2, 1}, [](int x, int) {
    return x == 0 ? test::Rgb{10, 25, 0} : test::Rgb{255, 20, 30};
  });
  Image<uint8_t> out;
  background::differ(*a, *b, Executor(1), out);
  EXPECT_EQ(out.at(0, 0), 30);
  EXPECT_EQ(out.at(1, 0), 245);
}

TEST(LightSwitch, MatchingAHistogramToItselfChangesNothing) {
  Histogram histogram{};
  for (size_t i = 0; i < 256; i += 5) histogram[i] = static_cast<uint32_t>(10 + i);
  const background::LevelMap map = background::matchLevels(histogram, histogram);
  for (size_t i = 0; i < 256; i += 5) EXPECT_EQ(map[i], i);
}

TEST(LightSwitch, FindsAGain) {
  Histogram dark{}, bright{};
  for (size_t i = 0; i < 100; ++i) {
    dark[i] = 7;
    bright[2 * i] = 7;
  }
  const background::LevelMap map = background::matchLevels(dark, bright);
  for (size_t i = 0; i < 100; ++i) EXPECT_EQ(map[i], 2 * i);
  EXPECT_TRUE(std::is_sorted(map.begin(), map.end()));
}

TEST(Histogram, ContrastThresholdIsAnEighthOfTheMiddleRange) {
  Histogram histogram{};
  for (size_t level = 20; level < 220; ++level) histogram[level] = 5;
  EXPECT_EQ(contrastThreshold(histogram, 12), 19);  // (199 - 40) / 8
  EXPECT_EQ(contrastThreshold(histogram, 30), 30);
  EXPECT_EQ(contrastThreshold(Histogram{}, 12), 12);
}

}  // namespace
}  // namespace rg
