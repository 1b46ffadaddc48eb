// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/tracking/looks/appearance.hpp"

#include <gtest/gtest.h>

#include <set>

namespace rg {
namespace {

objects::LookCounts plain(uint8_t bin, uint32_t samples = 10) {
  objects::LookCounts counts;
  for (auto& band : counts.bins) band[bin] = samples;
  return counts;
}

TEST(Appearance, EveryColourHasABin) {
  for (int red = 0; red < 256; red += 15)
    for (int green = 0; green < 256; green += 15)
      for (int blue = 0; blue < 256; blue += 15)
        ASSERT_LT(objects::colourBin(red, green, blue), objects::kColourBins);
}

TEST(Appearance, AHueIsInTheTwelfthOfTheCircleThatADivisionTells) {
  for (int low = 0; low < 200; low += 3)
    for (int chroma = 12; chroma + low < 256; ++chroma)
      for (int middle = 0; middle <= chroma; middle += 1 + chroma / 40) {
        const int high = low + chroma;
        if (8 * chroma < high) continue;
        const int strong = 3 * chroma > high;
        // From red by yellow, and from red by magenta.
        const int up = (2 * middle + chroma / 2) / chroma;
        const int down = (-2 * middle + chroma / 2 + 12 * chroma) / chroma % 12;
        ASSERT_EQ(objects::colourBin(high, low + middle, low), up * 2 + strong);
        ASSERT_EQ(objects::colourBin(high, low, low + middle), down * 2 + strong);
      }
}

TEST(Appearance, GreysDifferByBrightnessAndColoursByHue) {
  EXPECT_NE(objects::colourBin(20, 20, 20), objects::colourBin(220, 220, 220));
  const std::set<int> bins{objects::colourBin(200, 20, 20), objects::colourBin(20, 200, 20),
                           objects::colourBin(20, 20, 200), objects::colourBin(200, 200, 20),
                           objects::colourBin(90, 90, 90)};
  EXPECT_EQ(bins.size(), 5u);
  EXPECT_EQ(objects::colourBin(200, 20, 20), objects::colourBin(100, 10, 10));
}

TEST(Appearance, ALookIsAllLikeItselfAndNothingLikeAnother) {
  objects::Look red, blue;
  objects::learn(red, plain(objects::colourBin(200, 20, 20)));
  objects::learn(blue, plain(objects::colourBin(20, 20, 200)));
  EXPECT_EQ(objects::similarity(red, red), objects::kFullMatch);
  EXPECT_EQ(objects::similarity(red, blue), 0);
}

TEST(Appearance, TheSameColoursInOtherPlacesAreAnotherLook) {
  objects::LookCounts redAboveBlue, blueAboveRed;
  redAboveBlue.bins[0][1] = redAboveBlue.bins[2][9] = 5;
  blueAboveRed.bins[0][9] = blueAboveRed.bins[2][1] = 5;
  objects::Look a, b;
  objects::learn(a, redAboveBlue);
  objects::learn(b, blueAboveRed);
  EXPECT_EQ(objects::similarity(a, b), 0);
}

TEST(Appearance, WithoutCommonBandsNothingIsSaid) {
  EXPECT_EQ(objects::similarity(objects::Look{}, objects::Look{}), objects::kFullMatch / 2);
}

TEST(Appearance, ALookFollowsSlowChange) {
  objects::Look look, now;
  objects::learn(look, plain(3));
  objects::learn(now, plain(5));
  for (int i = 0; i < 60; ++i) objects::learn(look, plain(5));
  EXPECT_GT(objects::similarity(look, now), objects::kFullMatch * 95 / 100);
}

TEST(Appearance, AnEmptyFrameTeachesNothing) {
  objects::Look look;
  objects::learn(look, objects::LookCounts{});
  EXPECT_EQ(look.frames, 0u);
}

}  // namespace
}  // namespace rg
