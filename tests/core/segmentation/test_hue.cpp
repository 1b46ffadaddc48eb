// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/segmentation/hue.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace rg {
namespace {

TEST(Hue, FollowsTheHexagonToAStep) {
  for (int red = 0; red < 256; red += 15)
    for (int green = 0; green < 256; green += 15)
      for (int blue = 0; blue < 256; blue += 15) {
        const int largest = std::max({red, green, blue});
        const int chroma = largest - std::min({red, green, blue});
        const int hue = segmentation::hueOf(red, green, blue);
        if (chroma < segmentation::kLeastChroma) {
          EXPECT_EQ(hue, segmentation::kAchromatic);
          continue;
        }
        double exact = largest == red     ? double(green - blue) / chroma
                       : largest == green ? 2 + double(blue - red) / chroma
                                          : 4 + double(red - green) / chroma;
        if (exact < 0) exact += 6;
        EXPECT_LT(std::abs(hue - exact * segmentation::kHueSextant), 1.0)
            << red << ' ' << green << ' ' << blue;
        EXPECT_TRUE(hue >= 0 && hue < segmentation::kHueCount);
      }
}

TEST(Hue, DoesNotDependOnTheLight) {
  EXPECT_EQ(segmentation::hueOf(200, 100, 40), segmentation::hueOf(100, 50, 20));
}

TEST(Hue, DistanceGoesTheShorterWayRound) {
  EXPECT_EQ(segmentation::hueDistance(10, segmentation::kHueCount - 10), 20);
  EXPECT_EQ(segmentation::hueDistance(0, segmentation::kHueCount / 2), segmentation::kHueCount / 2);
}

TEST(HueBand, LiesRoundThePeakAndWrapsAtRed) {
  segmentation::HueHistogram histogram{};
  histogram[2] = 1000;
  histogram[700] = 300;
  const segmentation::HueBand band = segmentation::findBackgroundBand(histogram, 2000);
  EXPECT_TRUE(band.contains(2) && band.contains(0) && band.contains(segmentation::kHueCount - 10));
  EXPECT_FALSE(band.contains(700) || band.contains(40));
}

TEST(HueBand, OfEqualPeaksTheLowerHueWins) {
  segmentation::HueHistogram histogram{};
  histogram[1200] = histogram[300] = 500;
  EXPECT_TRUE(segmentation::findBackgroundBand(histogram, 1000).contains(300));
  EXPECT_FALSE(segmentation::findBackgroundBand(histogram, 1000).contains(1200));
}

TEST(HueBand, NeedsEnoughColourAndADistinctPeak) {
  segmentation::HueHistogram few{};
  few[100] = 10;
  EXPECT_EQ(segmentation::findBackgroundBand(few, 1000).count, 0);
  segmentation::HueHistogram even{};
  even.fill(7);
  EXPECT_EQ(segmentation::findBackgroundBand(even, 7 * segmentation::kHueCount).count, 0);
  EXPECT_EQ(segmentation::findBackgroundBand({}, 0).count, 0);
}

}  // namespace
}  // namespace rg
