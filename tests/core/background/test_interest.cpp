// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/background.hpp"
#include "core/background/interest.hpp"
#include "core/segmentation/segmentation.hpp"
#include "tests/core/scenes.hpp"
#include "tests/support/text_picture.hpp"

#include <gtest/gtest.h>

namespace rg {
namespace {

using Lines = std::vector<std::string>;

Lines draw(std::string_view text, Size size, ImageView<const uint8_t> picture = {}) {
  const auto polygons = background::parsePolygons(text);
  EXPECT_TRUE(polygons) << (polygons ? "" : polygons.error().message);
  Image<uint8_t> interest(size);
  background::drawInterest(*polygons, picture, interest);
  return test::textOf(interest);
}

TEST(Interest, IsTheWholeFrameWithoutAPolygon) {
  EXPECT_EQ(draw("", {3, 2}), (Lines{"###", "###"}));
  EXPECT_EQ(draw(" ; ", {3, 1}), (Lines{"###"}));
}

TEST(Interest, TakesPixelsWhoseCentresLieInside) {
  EXPECT_EQ(draw("0,0.5 1,0.5 1,1 0,1", {4, 4}), (Lines{"....", "....", "####", "####"}));
  EXPECT_EQ(draw("0,0 1,1 0,1", {4, 4}), (Lines{"....", "#...", "##..", "###."}));
  EXPECT_EQ(draw("0.2,0 0.8,0 0.8,1 0.2,1", {5, 1}), (Lines{".###."}));
}

TEST(Interest, CutsOutWhatIsExcludedWhereverItIsNamed) {
  EXPECT_EQ(draw("exclude 0,0 0.5,0 0.5,1 0,1", {4, 2}), (Lines{"..##", "..##"}));
  EXPECT_EQ(draw("exclude 0.25,0 0.5,0 0.5,1 0.25,1;0,0 1,0 1,1 0,1", {4, 1}), (Lines{"#.##"}));
}

TEST(Interest, UnitesPolygonsAndFollowsTheEvenOddRule) {
  EXPECT_EQ(draw("0,0 0.25,0 0.25,1 0,1; 0.75,0 1,0 1,1 0.75,1", {4, 1}), (Lines{"#..#"}));
  // A band that crosses itself: its middle is covered twice.
  EXPECT_EQ(draw("0,0 1,0 1,1 0.25,1 0.25,0 0.5,0 0.5,1 0,1", {4, 1}), (Lines{"#.##"}));
}

TEST(Interest, FitsAPictureToTheFrameAndTakesItsWhite) {
  const Image<uint8_t> picture = test::drawMask({"#.", ".#"});
  EXPECT_EQ(draw("", {4, 4}, picture), (Lines{"##..", "##..", "..##", "..##"}));
  EXPECT_EQ(draw("0,0 1,0 1,0.5 0,0.5", {4, 4}, picture), (Lines{"##..", "##..", "....", "...."}));
}

TEST(Interest, NamesWhatItCanNotRead) {
  for (const char* text :
       {"0,0 1,1", "0,0 1,0 1,2", "0,0 1,0 1", "a,b c,d e,f", "0,0 1,0 exclude 1,1",
        "0,0 1,0 nan,1", "exclude", "0,0 1,0 1,1,1", "-0.1,0 1,0 1,1"}) {
    const auto polygons = background::parsePolygons(text);
    ASSERT_FALSE(polygons) << text;
    EXPECT_NE(polygons.error().message.find("exclude 0.4,0.6"), std::string::npos);
  }
}

TEST(Interest, BoundsThePointsOfAllPolygonsTogether) {
  const auto textOf = [](size_t polygons, size_t points) {
    std::string text;
    for (size_t i = 0; i < polygons; ++i) {
      for (size_t k = 0; k < points; ++k) text += k % 2 == 0 ? "0,0.25 " : "1,0.75 ";
      text += i % 2 == 0 ? ";" : "; exclude ";
    }
    return text.substr(0, text.find_last_of(';'));
  };
  EXPECT_TRUE(background::parsePolygons(textOf(1, background::kMostInterestPoints)));
  EXPECT_TRUE(background::parsePolygons(textOf(background::kMostInterestPoints / 4, 4)));
  for (const std::string& text :
       {textOf(1, background::kMostInterestPoints + 1),
        textOf(background::kMostInterestPoints / 4 + 1, 4),
        "0,0 1,0 1,1" + std::string(background::kMostInterestBytes, ' ')}) {
    const auto polygons = background::parsePolygons(text);
    ASSERT_FALSE(polygons);
    EXPECT_NE(polygons.error().message.find("name it as mask"), std::string::npos);
  }
}

TEST(Interest, QuotesTheBeginningOfALongText) {
  std::string text = "0,0 1,1 ";
  for (int i = 0; i < 1000; ++i) text += "\u00e4";
  const std::string message = background::parsePolygons(text).error().message;
  EXPECT_LT(message.size(), 300u);
  EXPECT_NE(message.find("\u00e4... is no area"), std::string::npos) << message;
}

/// A square that appears on a wall whose left half only is of interest.
class InterestInTheStages : public ::testing::TestWithParam<background::Method> {
 protected:
  static constexpr Size kSize{64, 48};

  std::shared_ptr<const background::Foreground> show(const Box& thing, bool isLimited) {
    const auto picture = scenes::paint(kSize, [&](int x, int y) {
      return thing.contains({x, y}) ? scenes::Rgb{220, 40, 40} : scenes::Rgb{90, 100, 90};
    });
    background::Params params;
    params.method = GetParam();
    params.trainingFrames = 4;
    if (isLimited) {
      auto interest = std::make_shared<Image<uint8_t>>(kSize);
      background::drawInterest(*background::parsePolygons("0,0 0.5,0 0.5,1 0,1"), {}, *interest);
      params.interest = std::move(interest);
    }
    return *stage_->process(picture, params, {40'000'000 * frame_++, true});
  }

 private:
  std::unique_ptr<background::Stage> stage_ = background::makeStage(scenes::contextWith(1));
  int frame_ = 0;
};

TEST_P(InterestInTheStages, NothingOutsideIsForegroundAndItChangesAtOnce) {
  for (int i = 0; i < 20; ++i) show({}, false);
  const Box across{24, 16, 16, 16};
  const auto limited = show(across, true);
  ASSERT_EQ(limited->areas.size(), 1u);
  EXPECT_EQ(limited->areas[0].right(), 32);
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 32; x < kSize.width; ++x)
      ASSERT_EQ(limited->mask.at(x, y), background::kBackgroundPixel);
  const auto whole = show({26, 16, 16, 16}, false);
  ASSERT_GE(whole->areas.size(), 1u);
  EXPECT_GT(whole->areas.back().right(), 32);
}

TEST_P(InterestInTheStages, NothingOutsideGetsARegionInAnyScope) {
  for (int i = 0; i < 20; ++i) show({}, true);
  const auto foreground = show({24, 16, 16, 16}, true);
  const auto stage = segmentation::makeStage(scenes::contextWith(1));
  for (const segmentation::Scope scope :
       {segmentation::Scope::Frame, segmentation::Scope::Foreground, segmentation::Scope::Areas}) {
    segmentation::Params params;
    params.scope = scope;
    const auto labels = *stage->process(foreground->picture, foreground, params);
    EXPECT_GE(labels->count, 1u);
    for (int y = 0; y < kSize.height; ++y)
      for (int x = 32; x < kSize.width; ++x)
        ASSERT_EQ(labels->ids.at(x, y), segmentation::kNoRegion);
  }
}

INSTANTIATE_TEST_SUITE_P(Methods, InterestInTheStages,
                         ::testing::Values(background::Method::Hybrid, background::Method::Paper,
                                           background::Method::FrameDifference));

}  // namespace
}  // namespace rg
