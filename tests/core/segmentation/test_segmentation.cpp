// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/segmentation/segmentation.hpp"
#include "tests/core/scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <queue>
#include <string>

namespace rg {
namespace {

using namespace scenes;

segmentation::Params withAreas(int minAreaPx, int maxRegions = 65535, int similarity = 2) {
  return {segmentation::Scope::Frame, similarity, minAreaPx, maxRegions};
}

std::shared_ptr<const segmentation::Labels> segment(
    std::shared_ptr<const Picture> picture, const segmentation::Params& params,
    std::shared_ptr<const background::Foreground> foreground = nullptr, int threads = 1) {
  auto result = segmentation::makeStage(contextWith(threads))->process(picture, foreground, params);
  EXPECT_TRUE(result);
  return *result;
}

std::shared_ptr<const background::Foreground> foregroundOf(
    std::shared_ptr<const Picture> picture, const std::function<bool(int, int)>& isForeground) {
  auto foreground = std::make_shared<background::Foreground>();
  foreground->size = picture->size();
  foreground->status = Status::Ok;
  foreground->mask.resize(foreground->size);
  for (int y = 0; y < foreground->size.height; ++y)
    for (int x = 0; x < foreground->size.width; ++x)
      foreground->mask.at(x, y) =
          isForeground(x, y) ? background::kForegroundPixel : background::kShadowPixel;
  foreground->picture = std::move(picture);
  return foreground;
}

/// Floods the components of `areJoined` on 4-neighbours; numbers them in raster order.
std::vector<int> flood(Size size, const std::function<bool(Point, Point)>& areJoined) {
  std::vector<int> numbers(static_cast<size_t>(size.area()), 0);
  const auto at = [&](Point p) -> int& {
    return numbers[static_cast<size_t>(p.y * size.width + p.x)];
  };
  int count = 0;
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      if (at({x, y}) != 0) continue;
      std::queue<Point> open({{x, y}});
      at({x, y}) = ++count;
      for (; !open.empty(); open.pop()) {
        const Point p = open.front();
        for (const Point q :
             {Point{p.x - 1, p.y}, Point{p.x + 1, p.y}, Point{p.x, p.y - 1}, Point{p.x, p.y + 1}}) {
          if (!boundsOf(size).contains(q) || at(q) != 0 || !areJoined(p, q)) continue;
          at(q) = count;
          open.push(q);
        }
      }
    }
  return numbers;
}

std::vector<uint32_t> areasOf(const segmentation::Labels& labels) {
  std::vector<uint32_t> areas(labels.count + 1, 0);
  for (int y = 0; y < labels.size.height; ++y)
    for (int x = 0; x < labels.size.width; ++x) ++areas[labels.ids.at(x, y)];
  return areas;
}

/// What every result promises: labels 1 … count in raster order, each of them one 4-connected part.
void expectSound(const segmentation::Labels& labels) {
  const auto parts = flood(labels.size, [&](Point p, Point q) {
    return labels.ids.at(p.x, p.y) == labels.ids.at(q.x, q.y);
  });
  uint32_t seen = 0;
  std::vector<int> partOf(labels.count + 1, 0);
  for (int y = 0; y < labels.size.height; ++y)
    for (int x = 0; x < labels.size.width; ++x) {
      const uint32_t id = labels.ids.at(x, y);
      ASSERT_LE(id, labels.count);
      if (id == segmentation::kNoRegion) continue;
      if (id > seen) {
        ASSERT_EQ(id, ++seen);
      }
      const int part = parts[static_cast<size_t>(y * labels.size.width + x)];
      if (partOf[id] == 0) partOf[id] = part;
      ASSERT_EQ(partOf[id], part) << "label " << id << " has two parts";
    }
  EXPECT_EQ(seen, labels.count);
}

constexpr Rgb kGrey{100, 100, 100}, kLight{180, 180, 180};

std::shared_ptr<const Picture> checkerboard(Size size) {
  return paint(size, [](int x, int y) { return (x + y) % 2 == 0 ? kGrey : kLight; });
}

TEST(Segmentation, BordersLieOnTheEdges) {
  const auto labels = segment(
      paint({40, 30},
            [](int x, int y) { return x >= 7 && x < 21 && y >= 5 && y < 18 ? kLight : kGrey; }),
      withAreas(20));
  ASSERT_EQ(labels->count, 2u);
  for (int y = 0; y < 30; ++y)
    for (int x = 0; x < 40; ++x) {
      const bool isCorner = (x == 7 || x == 20) && (y == 5 || y == 17);
      if (isCorner) continue;
      EXPECT_EQ(labels->ids.at(x, y), x >= 7 && x < 21 && y >= 5 && y < 18 ? 2 : 1)
          << x << ' ' << y;
    }
}

// Larger regions are grown from cells: their borders are as sharp, wherever they cross the cells.
TEST(Segmentation, BordersOfCellsLieOnTheEdgesToo) {
  const Box box{53, 38, 77, 61};
  const auto isNear = [](int x, int edge) { return std::abs(2 * x + 1 - 2 * edge) <= 3; };
  for (const int minArea : {20, 64, 256, 1024})
    for (const int contrast : {30, 100}) {
      const auto labels = segment(
          paint({200, 160},
                [&](int x, int y) {
                  const int noise =
                      static_cast<int>(
                          mixHash(static_cast<uint32_t>(x), static_cast<uint32_t>(y), 1) % 5) -
                      2;
                  const auto level =
                      static_cast<uint8_t>(100 + noise + (box.contains({x, y}) ? contrast : 0));
                  return Rgb{level, level, level};
                }),
          withAreas(minArea));
      expectSound(*labels);
      // Large regions are cut, but none lies on both sides.
      std::vector<int> sides(labels->count + 1, -1);
      for (int y = 0; y < 160; ++y)
        for (int x = 0; x < 200; ++x) {
          const bool isCorner = (isNear(x, box.x) || isNear(x, box.right())) &&
                                (isNear(y, box.y) || isNear(y, box.bottom()));
          int& side = sides[labels->ids.at(x, y)];
          if (isCorner) continue;
          if (side < 0) side = box.contains({x, y});
          EXPECT_EQ(side, box.contains({x, y})) << minArea << ": " << x << ' ' << y;
        }
    }
}

TEST(Segmentation, CellsReachTheLargestNumberToo) {
  for (const int minArea : {64, 256})
    for (const int maxRegions : {1, 3, 20}) {
      const auto labels = segment(colourNoise({320, 240}, 5), withAreas(minArea, maxRegions));
      EXPECT_EQ(labels->count, static_cast<uint32_t>(maxRegions));
      expectSound(*labels);
      for (const uint32_t area : areasOf(*labels))
        EXPECT_TRUE(area == 0 || area >= static_cast<uint32_t>(minArea));
    }
}

// The predicate once more, by its words, and a flood instead of runs.
TEST(Segmentation, GrowingEqualsAFloodOfThePredicate) {
  for (const int similarity : {1, 3, 9, 40}) {
    const Size size{41, 37};
    std::mt19937 random(static_cast<unsigned>(similarity));
    const auto picture = paintGrey(size, [&](int x, int y) {
      return static_cast<int>(120 + 60 * std::sin(x * 0.3) * std::cos(y * 0.21)) +
             static_cast<int>(random() % 12);
    });
    const auto level = [&](int x, int y) {
      return int{
          picture->luma().at(std::clamp(x, 0, size.width - 1), std::clamp(y, 0, size.height - 1))};
    };
    const auto half = [](int a, int b) { return (a + b + 1) / 2; };
    const auto down = [&](int x, int y) {
      return half(half(level(x, y - 1), level(x, y + 1)), level(x, y));
    };
    const auto smooth = [&](Point p) {
      return half(half(down(p.x - 1, p.y), down(p.x + 1, p.y)), down(p.x, p.y));
    };
    const auto expected = flood(
        size, [&](Point p, Point q) { return std::abs(smooth(p) - smooth(q)) <= similarity; });
    const auto labels = segment(picture, withAreas(1, 65535, similarity));
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x)
        ASSERT_EQ(labels->ids.at(x, y), expected[static_cast<size_t>(y * size.width + x)])
            << similarity << ' ' << x << ' ' << y;
  }
}

TEST(Segmentation, CombAndSpiralStayWhole) {
  const Size size{44, 44};
  const auto comb =
      segment(paint(size, [](int x, int y) { return y < 6 || x % 12 < 6 ? kLight : kGrey; }),
              withAreas(10));
  EXPECT_EQ(comb->count, 1u + 4u);  // The comb, and what lies between its five teeth.
  const auto spiral = segment(paint(size,
                                    [](int x, int y) {
                                      const double angle = std::atan2(y - 22, x - 22) / 6.2831853;
                                      const double turn = std::hypot(x - 22, y - 22) / 10 - angle;
                                      return turn - std::floor(turn) < 0.5 ? kLight : kGrey;
                                    }),
                              withAreas(10));
  expectSound(*spiral);
  EXPECT_LE(spiral->count, 8u);
}

TEST(Segmentation, RegionsKeepTheLeastArea) {
  for (const int minArea : {2, 17, 150}) {
    const auto labels = segment(colourNoise({90, 70}, 3), withAreas(minArea));
    expectSound(*labels);
    const auto areas = areasOf(*labels);
    EXPECT_GT(labels->count, 5u);
    for (uint32_t id = 1; id <= labels->count; ++id)
      EXPECT_GE(areas[id], static_cast<uint32_t>(minArea));
  }
}

TEST(Segmentation, ReachesButNeverExceedsTheLargestNumber) {
  for (const int maxRegions : {1, 2, 7, 300, 4000}) {
    const auto labels = segment(colourNoise({90, 70}, 5), withAreas(1, maxRegions, 1));
    EXPECT_EQ(labels->count, static_cast<uint32_t>(maxRegions));
    expectSound(*labels);
  }
  const auto many = segment(checkerboard({300, 300}), withAreas(1, 65535, 1));
  EXPECT_LE(many->count, 65535u);
  expectSound(*many);
}

TEST(Segmentation, ChequersAreOneRegionEachUntilTheyMustMerge) {
  const auto board =
      paint({32, 24}, [](int x, int y) { return (x / 8 + y / 8) % 2 == 0 ? kGrey : kLight; });
  EXPECT_EQ(segment(board, withAreas(20))->count, 12u);
  EXPECT_EQ(segment(board, withAreas(20, 5))->count, 5u);
}

TEST(Segmentation, LargeUniformRegionsAreCutAlongAGrid) {
  const auto labels = segment(paint({256, 128}, [](int, int) { return kGrey; }), withAreas(50));
  EXPECT_EQ(labels->count, 8u * 4u);
  for (const uint32_t area : areasOf(*labels)) EXPECT_TRUE(area == 0 || area == 32 * 32);
}

TEST(Segmentation, HueSeparatesWhatSimilarityWouldJoin) {
  const auto halves = [](Rgb left, Rgb right) {
    return paint({40, 20}, [=](int x, int) { return x < 28 ? left : right; });
  };
  const segmentation::Params loose = withAreas(1, 65535, 60);
  EXPECT_EQ(segment(halves({120, 60, 60}, {60, 120, 60}), loose)->count, 2u);
  EXPECT_EQ(segment(halves({120, 60, 60}, {180, 120, 120}), loose)->count, 1u);
  EXPECT_EQ(segment(halves({120, 120, 120}, {60, 60, 60}), loose)->count, 1u);
}

TEST(Segmentation, ForegroundScopeLabelsTheForegroundOnly) {
  const auto picture = paint({60, 40}, [](int, int) { return kGrey; });
  const auto isInside = [](int x, int y) {
    return y >= 10 && y < 20 && ((x >= 5 && x < 15) || (x >= 16 && x < 30));
  };
  segmentation::Params params = withAreas(0);
  params.scope = segmentation::Scope::Foreground;
  const auto labels = segment(picture, params, foregroundOf(picture, isInside));
  EXPECT_EQ(labels->count, 2u);  // One column of background keeps them apart.
  expectSound(*labels);
  for (int y = 0; y < 40; ++y)
    for (int x = 0; x < 60; ++x)
      EXPECT_EQ(labels->ids.at(x, y) != segmentation::kNoRegion, isInside(x, y)) << x << ' ' << y;
}

/// A frame of 80x60 with a thing whose middle the foreground misses; what is there has a grey level
/// of its own. Returns the pixels of the middle that got a region.
int64_t labelledInTheMiddle(uint8_t middle, const Box& gap) {
  const Box thing{20, 12, 40, 48};
  const auto picture = paint({80, 60}, [&](int x, int y) {
    if (!thing.contains({x, y})) return Rgb{190, 190, 190};
    return gap.contains({x, y}) ? Rgb{middle, middle, middle} : kGrey;
  });
  segmentation::Params params = withAreas(0);
  params.scope = segmentation::Scope::Foreground;
  const auto labels = segment(picture, params, foregroundOf(picture, [&](int x, int y) {
                                return thing.contains({x, y}) && !gap.contains({x, y});
                              }));
  expectSound(*labels);
  int64_t labelled = 0;
  for (int y = gap.y; y < gap.bottom(); ++y)
    for (int x = gap.x; x < gap.right(); ++x)
      labelled += labels->ids.at(x, y) != segmentation::kNoRegion;
  return labelled;
}

TEST(Segmentation, AForegroundsGapIsClosedWhereNoColourEnds) {
  const Box enclosed{32, 24, 16, 20}, open{32, 24, 16, 36};  // The second ends with the frame.
  for (const Box& gap : {enclosed, open}) {
    EXPECT_EQ(labelledInTheMiddle(kGrey.red, gap), gap.area());
    EXPECT_EQ(labelledInTheMiddle(190, gap), 0) << "the wall is seen through it";
  }
}

TEST(Segmentation, IsolatedForegroundNeverExceedsTheLargestNumber) {
  const auto picture = paint({60, 40}, [](int, int) { return kGrey; });
  const auto dots = foregroundOf(picture, [](int x, int y) { return x % 3 == 0 && y % 3 == 0; });
  segmentation::Params params = withAreas(0, 50);
  params.scope = segmentation::Scope::Foreground;
  const auto labels = segment(picture, params, dots);
  EXPECT_EQ(labels->count, 50u);
  expectSound(*labels);
}

TEST(Segmentation, EmptyForegroundGivesNoRegions) {
  const auto picture = colourNoise({30, 20}, 1);
  segmentation::Params params = withAreas(0);
  params.scope = segmentation::Scope::Foreground;
  const auto labels =
      segment(picture, params, foregroundOf(picture, [](int, int) { return false; }));
  EXPECT_EQ(labels->count, 0u);
  for (const uint32_t area : areasOf(*labels)) EXPECT_EQ(area, 600u);
}

TEST(Segmentation, ForegroundScopeWithoutForegroundNamesTheRemedy) {
  segmentation::Params params;
  params.scope = segmentation::Scope::Foreground;
  const auto result =
      segmentation::makeStage(contextWith(1))->process(greyNoise({8, 8}, 1), nullptr, params);
  ASSERT_FALSE(result);
  EXPECT_NE(result.error().message.find("bgremove"), std::string::npos);
}

TEST(Segmentation, SkippedGivesSkipped) {
  const auto picture = greyNoise({8, 8}, 1);
  auto foreground = std::make_shared<background::Foreground>();
  foreground->size = picture->size();
  const auto labels = segment(picture, {}, foreground);
  EXPECT_EQ(labels->status, Status::Skipped);
  EXPECT_EQ(labels->count, 0u);
}

TEST(Segmentation, TinyAndThinFramesWork) {
  for (const Size size : {Size{1, 1}, Size{1, 50}, Size{50, 1}, Size{2, 2}, Size{3, 200}}) {
    const auto labels = segment(colourNoise(size, 9), withAreas(0));
    EXPECT_GE(labels->count, 1u);
    expectSound(*labels);
    expectSound(*segment(colourNoise(size, 9), withAreas(1)));
  }
}

TEST(Segmentation, AStageMayBeReusedForAnySize) {
  const auto stage = segmentation::makeStage(contextWith(1));
  for (const Size size : {Size{120, 90}, Size{7, 5}, Size{200, 33}}) {
    const auto picture = colourNoise(size, 4);
    const auto reused = stage->process(picture, nullptr, {});
    ASSERT_TRUE(reused);
    EXPECT_TRUE(areEqual((*reused)->ids, segment(picture, {})->ids));
  }
}

TEST(Segmentation, ThreadsChangeNothing) {
  for (const Size size : {Size{201, 173}, Size{64, 300}}) {
    const auto noise = colourNoise(size, 8);
    const auto waves = paint(size, [](int x, int y) {
      return Rgb{static_cast<uint8_t>(128 + 100 * std::sin(x * 0.07)),
                 static_cast<uint8_t>(128 + 100 * std::sin(y * 0.05)),
                 static_cast<uint8_t>((x * y) / 64)};
    });
    for (const auto& picture : {noise, waves})
      for (const int minArea : {0, 1}) {
        segmentation::Params params = withAreas(minArea, 2000);
        EXPECT_TRUE(areEqual(segment(picture, params, nullptr, 1)->ids,
                             segment(picture, params, nullptr, 2)->ids));
        params.scope = segmentation::Scope::Foreground;
        const auto blob = foregroundOf(picture, [](int x, int y) { return x + y > 90 && y % 50; });
        EXPECT_TRUE(areEqual(segment(picture, params, blob, 1)->ids,
                             segment(picture, params, blob, 2)->ids));
      }
  }
}

}  // namespace
}  // namespace rg
