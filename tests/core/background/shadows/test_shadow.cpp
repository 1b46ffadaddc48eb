// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/shadows/cast_shadows.hpp"
#include "core/background/shadows/shadow.hpp"
#include "tests/support/text_picture.hpp"

#include <gtest/gtest.h>

namespace rg {
namespace {

using test::drawBits;
using test::makePicture;
using test::Rgb;
using test::textOf;

/// A wall with a pattern of 8 grey levels.
Rgb wall(int x, int y) {
  const int level = 150 + 8 * ((x / 2 + y / 3) % 3);
  return {static_cast<uint8_t>(level), static_cast<uint8_t>(level - 10),
          static_cast<uint8_t>(level - 20)};
}

template <class ColourOf>
int shadowPixels(Size size, const ColourOf& colourOf, int threads = 1) {
  const auto before = makePicture(size, wall);
  const auto now = makePicture(size, colourOf);
  BitMask mask(size), shadow(size);
  mask.clear();
  for (int y = 0; y < size.height; ++y) setColumns(mask.row(y), 0, size.width, true);
  const auto planes = [](const Picture& p) {
    return background::ColourPlanes{p.red(), p.green(), p.blue()};
  };
  background::findShadows(planes(*now), planes(*before), mask, Executor(threads), shadow);
  return static_cast<int>(countSet(shadow));
}

Rgb scaled(Rgb colour, int percent) {
  return {static_cast<uint8_t>(colour.red * percent / 100),
          static_cast<uint8_t>(colour.green * percent / 100),
          static_cast<uint8_t>(colour.blue * percent / 100)};
}

TEST(Shadow, ADarkenedBackgroundIsShadow) {
  const Size size{20, 12};
  EXPECT_EQ(shadowPixels(size, [](int x, int y) { return scaled(wall(x, y), 70); }), 240);
}

TEST(Shadow, TheBackgroundItselfAndLightAreNot) {
  const Size size{20, 12};
  EXPECT_EQ(shadowPixels(size, wall), 0);
  EXPECT_EQ(shadowPixels(size, [](int x, int y) { return scaled(wall(x, y), 130); }), 0);
}

TEST(Shadow, NearlyBlackIsNot) {
  EXPECT_EQ(shadowPixels({20, 12}, [](int x, int y) { return scaled(wall(x, y), 25); }), 0);
}

TEST(Shadow, AnotherColourIsNot) {
  EXPECT_EQ(shadowPixels({20, 12}, [](int, int) { return Rgb{150, 100, 40}; }), 0);
}

TEST(Shadow, AnotherTextureIsNot) {
  const auto striped = [](int x, int y) { return scaled(wall(x, y), x % 4 < 2 ? 55 : 85); };
  EXPECT_EQ(shadowPixels({20, 12}, striped), 0);
}

TEST(Shadow, OnePixelAndThinFramesWork) {
  const auto dark = [](int x, int y) { return scaled(wall(x, y), 70); };
  EXPECT_EQ(shadowPixels({1, 1}, dark), 1);
  EXPECT_EQ(shadowPixels({1, 40}, dark), 40);
  EXPECT_EQ(shadowPixels({600, 1}, dark), 600);
}

TEST(Shadow, ThreadsChangeNothing) {
  const auto mixed = [](int x, int y) { return scaled(wall(x, y), 40 + (x * 7 + y * 3) / 9 % 60); };
  EXPECT_EQ(shadowPixels({270, 90}, mixed, 1), shadowPixels({270, 90}, mixed, 2));
}

using Lines = std::vector<std::string>;

Lines cast(const Lines& mask, const Lines& dark) {
  BitMask out = drawBits(dark);
  background::CastShadowScratch scratch;
  background::keepCastShadows(drawBits(mask), out, scratch);
  return textOf(out);
}

TEST(CastShadows, AFlatPartBesideTheFeetIsCast) {
  const Lines mask{".##....", ".##....", ".##....", ".##....", ".######"};
  const Lines dark{".......", ".......", ".......", ".......", "...####"};
  EXPECT_EQ(cast(mask, dark), dark);
}

TEST(CastShadows, ADarkCoatBetweenHeadAndLegsIsNot) {
  const Lines mask{".##.", ".##.", ".##.", ".##.", ".##."};
  const Lines dark{"....", "....", ".##.", ".##.", "...."};
  EXPECT_EQ(cast(mask, dark), Lines(5, "...."));
}

TEST(CastShadows, APartWithoutAnObjectIsNot) {
  const Lines mask{"....", ".##.", ".##."};
  EXPECT_EQ(cast(mask, mask), Lines(3, "...."));
}

TEST(CastShadows, AnObjectIsNotMostlyShadow) {
  const Lines mask{"#.......", "########", "########"};
  const Lines dark{"........", ".#######", ".#######"};
  EXPECT_EQ(cast(mask, dark), Lines(3, "........"));
}

}  // namespace
}  // namespace rg
