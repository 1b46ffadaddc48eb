// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/pixel.hpp"
#include "core/segmentation/colour_cells.hpp"
#include "core/segmentation/colour_links.hpp"
#include "core/segmentation/segmentation.hpp"
#include "tests/core/scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace rg {
namespace {

using namespace scenes;
using segmentation::ColourSpace;

std::shared_ptr<const segmentation::Labels> divide(std::shared_ptr<const Picture> picture,
                                                   ColourSpace space, int similarity,
                                                   int minAreaPx = 20, int threads = 1) {
  segmentation::Params params{segmentation::Scope::Frame, similarity, minAreaPx, 65535};
  params.space = space;
  auto labels =
      segmentation::makeStage(contextWith(threads))->process(std::move(picture), nullptr, params);
  EXPECT_TRUE(labels);
  return *labels;
}

std::shared_ptr<const Picture> halves(Rgb left, Rgb right) {
  return paint({40, 20}, [=](int x, int) { return x < 28 ? left : right; });
}

TEST(ColourSpace, HsvJoinsNeighboursOfOneHueAcrossTheEndsOfTheCircle) {
  const auto reds = halves({200, 10, 0}, {200, 0, 10});
  EXPECT_EQ(divide(reds, ColourSpace::Rgb, 4)->count, 2u);
  EXPECT_EQ(divide(reds, ColourSpace::Hsv, 4)->count, 1u);
}

TEST(ColourSpace, HsvPartsWhatDiffersInOneOfItsChannelsOnly) {
  EXPECT_EQ(divide(halves({90, 30, 30}, {30, 90, 30}), ColourSpace::Hsv, 35)->count, 2u);
  EXPECT_EQ(divide(halves({120, 60, 60}, {120, 100, 100}), ColourSpace::Hsv, 8)->count, 2u);
  EXPECT_EQ(divide(halves({120, 60, 60}, {60, 30, 30}), ColourSpace::Hsv, 8)->count, 2u);
}

TEST(ColourSpace, AGreyPictureIsTheSameInBoth) {
  const auto noise = greyNoise({70, 50}, 3);
  const auto byRgb = divide(noise, ColourSpace::Rgb, 20),
             byHsv = divide(noise, ColourSpace::Hsv, 20);
  EXPECT_GT(byRgb->count, 1u);
  EXPECT_EQ(byHsv->count, byRgb->count);
  EXPECT_TRUE(areEqual(byHsv->ids, byRgb->ids));
}

/// Hue as 256ths of the circle, saturation and value, from the textbook.
struct Hsv {
  double hue = -1, saturation = 0, value = 0;
};

Hsv hsvOf(int red, int green, int blue) {
  const int most = std::max({red, green, blue}), chroma = most - std::min({red, green, blue});
  Hsv hsv{-1, most > 0 ? 255.0 * chroma / most : 0, static_cast<double>(most)};
  if (chroma < segmentation::kLeastChroma) return hsv;
  const double turn = most == red     ? double(green - blue) / chroma
                      : most == green ? 2 + double(blue - red) / chroma
                                      : 4 + double(red - green) / chroma;
  hsv.hue = std::fmod(turn + 6, 6) / 6 * 256;
  return hsv;
}

double distance(const Hsv& a, const Hsv& b) {
  double hue = a.hue < 0 || b.hue < 0 ? 0 : std::abs(a.hue - b.hue);
  hue = std::min(hue, 256 - hue);
  return std::max({hue, std::abs(a.saturation - b.saturation), std::abs(a.value - b.value)});
}

/// Every pair of the smoothed picture, as the links have it and as the textbook: what lies within
/// two steps of the limit may be rounded to either side.
TEST(ColourSpace, LinksAreThoseOfTheTextbooksHsv) {
  constexpr int kSimilarity = 30, kRounding = 2;
  const auto picture = colourNoise({61, 47}, 9);
  const Executor executor(2);
  segmentation::ColourCells cells;
  cells.build(*picture, {}, 1, executor);
  segmentation::ColourLinks links;
  links.build(cells.pixels(), {kSimilarity, false, {}, ColourSpace::Hsv}, executor);
  const auto& planes = cells.pixels().colours;
  const auto at = [&](int x, int y) {
    return hsvOf(planes[0].at(x, y), planes[1].at(x, y), planes[2].at(x, y));
  };
  int linked = 0, apart = 0;
  const auto expectLink = [&](bool isLinked, const Hsv& a, const Hsv& b) {
    const double d = distance(a, b);
    if (std::abs(d - kSimilarity) > kRounding) {
      EXPECT_EQ(isLinked, d <= kSimilarity) << d;
    }
    ++(isLinked ? linked : apart);
  };
  for (int y = 0; y < 47; ++y)
    for (int x = 0; x < 61; ++x) {
      const uint8_t bits = links.links(y)[x];
      if (x > 0) expectLink((bits & segmentation::kLinkedLeft) != 0, at(x - 1, y), at(x, y));
      if (y > 0) expectLink((bits & segmentation::kLinkedUp) != 0, at(x, y - 1), at(x, y));
    }
  EXPECT_GT(linked, 500);
  EXPECT_GT(apart, 500);
}

TEST(ColourSpace, HsvIsTheSameForAnyNumberOfThreadsAndInCells) {
  for (const int minAreaPx : {1, 40, 300}) {  // Pixels, and cells of 2 and 4.
    const auto one = divide(colourNoise({150, 90}, 4), ColourSpace::Hsv, 40, minAreaPx);
    const auto four = divide(colourNoise({150, 90}, 4), ColourSpace::Hsv, 40, minAreaPx, 4);
    EXPECT_GT(one->count, 1u);
    EXPECT_TRUE(areEqual(one->ids, four->ids));
  }
}

TEST(ColourSpace, TheForegroundIsDividedByHsvToo) {
  const auto picture = paint({60, 40}, [](int x, int y) {
    if (y < 8 || y >= 32) return Rgb{90, 90, 90};
    return x < 30 ? Rgb{90, 30, 30} : Rgb{30, 90, 30};
  });
  auto foreground = std::make_shared<background::Foreground>();
  foreground->size = picture->size();
  foreground->status = Status::Ok;
  foreground->mask.resize(foreground->size);
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 60; ++x)
      foreground->mask.at(x, y) =
          y >= 8 && y < 32 ? background::kForegroundPixel : background::kBackgroundPixel;
  foreground->picture = picture;
  segmentation::Params params{segmentation::Scope::Foreground, 35, 60, 65535};
  params.space = ColourSpace::Hsv;
  const auto labels = segmentation::makeStage(contextWith(1))->process(picture, foreground, params);
  ASSERT_TRUE(labels);
  EXPECT_EQ((*labels)->count, 2u);
  EXPECT_EQ((*labels)->ids.at(10, 4), segmentation::kNoRegion);
}

}  // namespace
}  // namespace rg
