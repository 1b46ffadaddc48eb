// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/segmentation/hue_decision.hpp"
#include "core/segmentation/segmentation.hpp"
#include "tests/core/scenes.hpp"

#include <gtest/gtest.h>

#include <random>

namespace rg {
namespace {

using scenes::Rgb;

constexpr Size kSize{160, 120};
constexpr Rgb kColours[] = {{200, 60, 50}, {60, 80, 200}, {190, 180, 40}, {170, 50, 180}};
const std::vector<Box> kThings{
    {10, 12, 30, 24}, {100, 20, 24, 36}, {30, 70, 40, 30}, {110, 80, 30, 26}};
constexpr Box kGreyThing{66, 10, 20, 20};

/// Coloured things and a grey one on a meadow of one hue. The light falls from 1 at the left to 0.5
/// at the right; noise of two grey levels.
std::shared_ptr<const Picture> meadow(unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> noise(0, 2);
  return scenes::paint(kSize, [&](int x, int y) {
    const int shade = 8 * ((x / 9 + y / 7) % 4);  // More or less of the same colour.
    Rgb colour{static_cast<uint8_t>(70 + shade / 2), static_cast<uint8_t>(140 + shade),
               static_cast<uint8_t>(60 + shade / 2)};
    for (size_t i = 0; i < kThings.size(); ++i)
      if (kThings[i].contains({x, y})) colour = kColours[i];
    if (kGreyThing.contains({x, y})) colour = {150, 150, 150};
    const double light = 1 - 0.5 * x / (kSize.width - 1);
    const auto lit = [&](int level) {
      return static_cast<uint8_t>(std::clamp(level * light + noise(random) + 0.5, 0.0, 255.0));
    };
    return Rgb{lit(colour.red), lit(colour.green), lit(colour.blue)};
  });
}

std::shared_ptr<const segmentation::Labels> segment(
    const segmentation::Params& params, int threads = 1,
    std::shared_ptr<const Picture> picture = meadow(3)) {
  return *segmentation::makeStage(scenes::contextWith(threads))->process(picture, nullptr, params);
}

bool isThing(int x, int y) {
  return std::any_of(kThings.begin(), kThings.end(), [&](const Box& box) {
    return box.contains({x, y});
  });
}

double measureF(const Image<uint8_t>& hue, const std::function<bool(int, int)>& truth) {
  int hits = 0, wrong = 0;
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x) {
      const bool isFound = hue.at(x, y) == segmentation::kObjectHue;
      hits += isFound && truth(x, y);
      wrong += isFound != truth(x, y);
    }
  return 2.0 * hits / (2 * hits + wrong);
}

TEST(HueDecision, FindsThingsOfOtherHuesInAnyLight) {
  for (const unsigned seed : {1u, 2u, 3u}) {
    segmentation::Params params;
    params.hue.background = segmentation::BackgroundHue::FromPeak;
    const auto labels = segment(params, 1, meadow(seed));
    EXPECT_GE(measureF(labels->hue, isThing), 0.98) << "seed " << seed;
    // Label 0 is the background, though the scope is the frame.
    EXPECT_EQ(labels->ids.at(2, 2), segmentation::kNoRegion);
    for (const Box& thing : kThings)
      EXPECT_NE(labels->ids.at(thing.x + 8, thing.y + 8), segmentation::kNoRegion);
    EXPECT_NE(labels->scope, segmentation::Scope::Frame);
  }
}

TEST(HueDecision, TellsPixelsWithoutColourApart) {
  segmentation::Params params;
  params.hue.background = segmentation::BackgroundHue::FromPeak;
  const auto labels = segment(params);
  int grey = 0, greyElsewhere = 0;
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x)
      if (labels->hue.at(x, y) == segmentation::kNoHue)
        ++(kGreyThing.contains({x, y}) ? grey : greyElsewhere);
  EXPECT_GE(grey * 100, 98 * kGreyThing.area());
  EXPECT_LE(greyElsewhere * 100, kSize.area());
}

TEST(HueDecision, TakesTheBackgroundsBandByHand) {
  segmentation::Params params;
  params.hue.background = segmentation::BackgroundHue::Given;
  params.hue.backgroundBand = *segmentation::parseHueBand("80-160");
  EXPECT_GE(measureF(segment(params)->hue, isThing), 0.98);
}

TEST(HueDecision, FollowsThingsOfOneColour) {
  segmentation::Params params;
  params.hue.objectBand = *segmentation::parseHueBand("345-15");
  const auto labels = segment(params);
  EXPECT_GE(measureF(labels->hue, [](int x, int y) { return kThings[0].contains({x, y}); }), 0.98);
  EXPECT_EQ(labels->ids.at(kThings[1].x + 8, kThings[1].y + 8), segmentation::kNoRegion);
  EXPECT_EQ(labels->ids.at(kGreyThing.x + 8, kGreyThing.y + 8), segmentation::kNoRegion);
}

TEST(HueDecision, LeavesPixelsWithoutColourToTheForeground) {
  const auto picture = meadow(5);
  auto foreground = std::make_shared<background::Foreground>();
  foreground->size = kSize;
  foreground->status = Status::Ok;
  foreground->mask.resize(kSize);
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x)
      foreground->mask.at(x, y) = kGreyThing.contains({x, y}) ? background::kForegroundPixel : 0;
  segmentation::Params params;
  params.hue.background = segmentation::BackgroundHue::FromPeak;
  const auto labels =
      *segmentation::makeStage(scenes::contextWith(1))->process(picture, foreground, params);
  EXPECT_NE(labels->ids.at(kGreyThing.x + 8, kGreyThing.y + 8), segmentation::kNoRegion);
  EXPECT_NE(labels->ids.at(kThings[0].x + 8, kThings[0].y + 8), segmentation::kNoRegion);
  EXPECT_EQ(labels->ids.at(2, 2), segmentation::kNoRegion);
}

TEST(HueDecision, IsTheSameForAnyNumberOfThreadsAndSize) {
  for (const Size size : {kSize, Size{1, 1}, {1, 9}, {9, 1}, {33, 65}}) {
    const auto picture = scenes::colourNoise(size, 9);
    segmentation::Params params;
    params.hue.background = segmentation::BackgroundHue::FromPeak;
    const auto one = segment(params, 1, picture);
    for (const int threads : {2, 4}) {
      const auto more = segment(params, threads, picture);
      EXPECT_TRUE(scenes::areEqual(one->ids, more->ids));
      for (int y = 0; y < size.height; ++y)
        EXPECT_TRUE(std::equal(one->hue.row(y), one->hue.row(y) + size.width, more->hue.row(y)));
    }
  }
}

TEST(HueDecision, SaysNothingUnlessAsked) {
  EXPECT_TRUE(segment({})->hue.size().isEmpty());
  EXPECT_EQ(segment({})->scope, segmentation::Scope::Frame);
}

TEST(HueDecision, SaysNothingOfGreyFrames) {
  segmentation::Params params;
  params.hue.background = segmentation::BackgroundHue::FromPeak;
  const auto labels = segment(params, 1, scenes::greyNoise({20, 20}, 1));
  for (int y = 0; y < 20; ++y)
    for (int x = 0; x < 20; ++x) ASSERT_EQ(labels->hue.at(x, y), segmentation::kNoHue);
}

TEST(HueBands, AreReadInDegrees) {
  EXPECT_EQ(*segmentation::parseHueBand(""), segmentation::HueBand{});
  EXPECT_EQ(*segmentation::parseHueBand("60-120"), (segmentation::HueBand{256, 257}));
  EXPECT_TRUE(segmentation::parseHueBand("350-10")->contains(0));
  EXPECT_FALSE(segmentation::parseHueBand("350-10")->contains(segmentation::kHueCount / 2));
  EXPECT_EQ(segmentation::parseHueBand("0-360")->count, segmentation::kHueCount);
  for (const char* text : {"red", "10", "-5-10", "10-400", "10-20-30", "1-"})
    EXPECT_FALSE(segmentation::parseHueBand(text)) << text;
}

}  // namespace
}  // namespace rg
