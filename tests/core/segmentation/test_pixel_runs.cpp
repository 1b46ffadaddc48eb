// SPDX-License-Identifier: LGPL-2.1-or-later
// Components of runs and the borders between them, against a flood.
#include "core/base/pixel.hpp"
#include "core/segmentation/pixel_runs.hpp"
#include "tests/core/fills.hpp"
#include "tests/core/simd_targets.hpp"

#include <array>
#include <functional>
#include <map>
#include <utility>
#include <vector>

namespace rg {
namespace {

using test::hashOf;

constexpr Size kSizes[] = {{1, 1}, {1, 90}, {131, 1}, {64, 64}, {65, 130}, {200, 97}};

/// Labels 0 … 5 in patches of some pixels, and single ones in between.
Image<uint16_t> patches(Size size) {
  Image<uint16_t> labels(size);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      labels.at(x, y) = static_cast<uint16_t>(
          hashOf(x, y, 1) % 9 == 0 ? hashOf(x, y, 2) % 6 : hashOf(x / 9, y / 7, 3) % 6);
  return labels;
}

using IsLinked = std::function<bool(Point, Point)>;

/// Numbers of components in raster order of their first pixels; 0 where isIn() says no.
Image<int> flood(Size size, const std::function<bool(Point)>& isIn, const IsLinked& isLinked) {
  Image<int> numbers(size);
  numbers.fill(0);
  int count = 0;
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      if (!isIn({x, y}) || numbers.at(x, y) != 0) continue;
      std::vector<Point> open{{x, y}};
      numbers.at(x, y) = ++count;
      while (!open.empty()) {
        const Point p = open.back();
        open.pop_back();
        for (const Point q :
             {Point{p.x - 1, p.y}, Point{p.x + 1, p.y}, Point{p.x, p.y - 1}, Point{p.x, p.y + 1}}) {
          if (!boundsOf(size).contains(q) || !isIn(q) || numbers.at(q.x, q.y) != 0) continue;
          if (!isLinked(p, q)) continue;
          numbers.at(q.x, q.y) = count;
          open.push_back(q);
        }
      }
    }
  return numbers;
}

using Borders = std::map<std::pair<int, int>, uint32_t>;

Borders bordersOf(const Image<int>& numbers, const IsLinked& isPair) {
  Borders borders;
  const auto add = [&](Point p, Point q) {
    const int a = numbers.at(p.x, p.y), b = numbers.at(q.x, q.y);
    if (a != 0 && b != 0 && a != b && isPair(p, q)) ++borders[std::minmax(a, b)];
  };
  for (int y = 0; y < numbers.height(); ++y)
    for (int x = 0; x < numbers.width(); ++x) {
      if (x > 0) add({x - 1, y}, {x, y});
      if (y > 0) add({x, y - 1}, {x, y});
    }
  return borders;
}

void expectSame(const segmentation::PixelRuns& runs, const Image<int>& numbers,
                const Borders& right) {
  Image<int> found(numbers.size());
  found.fill(0);
  std::map<uint32_t, uint32_t> areas;
  for (int y = 0; y < numbers.height(); ++y)
    for (uint32_t i = runs.rowStart(y); i < runs.rowStart(y + 1); ++i)
      for (int x = runs.run(i).first; x < runs.run(i).last; ++x) {
        found.at(x, y) = static_cast<int>(runs.component(i)) + 1;
        ++areas[runs.part(i)];
      }
  for (int y = 0; y < numbers.height(); ++y)
    for (int x = 0; x < numbers.width(); ++x) ASSERT_EQ(found.at(x, y), numbers.at(x, y));
  for (int band = 0; band < runs.bandCount(); ++band)
    for (const uint32_t part : runs.parts(band)) {
      EXPECT_EQ(runs.partArea(part), areas[part]);
      EXPECT_EQ(areas.erase(part), 1u);
    }
  EXPECT_TRUE(areas.empty());
  Borders borders;
  runs.forBorders([&](uint32_t a, uint32_t b, uint32_t pairs) {
    borders[std::minmax(static_cast<int>(a) + 1, static_cast<int>(b) + 1)] += pairs;
  });
  EXPECT_EQ(borders, right);
}

TEST(PixelRuns, OfLabelsAreThoseOfAFlood) {
  for (const Size size : kSizes)
    for (const bool hasScope : {false, true}) {
      const Image<uint16_t> labels = patches(size);
      // Labels 4 and 5 are in scope apart.
      Image<uint8_t> scope(size);
      for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x)
          scope.at(x, y) = labels.at(x, y) == 0   ? uint8_t{0}
                           : labels.at(x, y) >= 4 ? kInScopeApart
                                                  : kInScope;
      const auto isAlike = [&](Point p, Point q) {
        return labels.at(p.x, p.y) == labels.at(q.x, q.y);
      };
      const auto isPair = [&](Point p, Point q) {
        return !hasScope || scope.at(p.x, p.y) == scope.at(q.x, q.y);
      };
      const Image<int> numbers = flood(
          size, [&](Point p) { return labels.at(p.x, p.y) != 0; }, isAlike);
      test::forEachTargetAndThreads([&](const std::shared_ptr<const Executor>& executor) {
        segmentation::PixelRuns runs;
        runs.build(labels, hasScope ? scope.view() : ImageView<uint8_t>{}, *executor);
        expectSame(runs, numbers, bordersOf(numbers, isPair));
      });
    }
}

TEST(PixelRuns, OfAlikeColoursAreThoseOfAFloodCutIntoTiles) {
  constexpr int kSimilarity = 3, kTile = 16;
  constexpr int64_t kMostArea = 300;
  int cut = 0;
  for (const Size size : kSizes) {
    Image<uint8_t> grey(size);
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x)
        grey.at(x, y) = static_cast<uint8_t>(10 * (hashOf(x / 30, y / 40, 4) % 3) +
                                             (hashOf(x, y, 5) % 13 == 0 ? 100 : 0));
    const auto isLinked = [&](Point p, Point q) {
      return absDiff(grey.at(p.x, p.y), grey.at(q.x, q.y)) <= kSimilarity;
    };
    const auto all = [](Point) { return true; };
    const Image<int> wholes = flood(size, all, isLinked);
    std::map<int, int64_t> areas;
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x) ++areas[wholes.at(x, y)];
    const Image<int> numbers = flood(size, all, [&](Point p, Point q) {
      const bool isTile = p.x / kTile == q.x / kTile && p.y / kTile == q.y / kTile;
      return isLinked(p, q) && (isTile || areas[wholes.at(p.x, p.y)] <= kMostArea);
    });
    for (const auto& [number, area] : areas) cut += area > kMostArea;
    const Borders right = bordersOf(numbers, [](Point, Point) { return true; });
    segmentation::ColourGrid planes;
    planes.size = size;
    planes.colours = {grey, grey, grey};
    test::forEachTargetAndThreads([&](const std::shared_ptr<const Executor>& executor) {
      segmentation::ColourLinks links;
      links.build(planes, {kSimilarity, false, {}}, *executor);
      segmentation::PixelRuns runs;
      runs.build(links, {kMostArea, kTile}, *executor);
      expectSame(runs, numbers, right);
    });
  }
  EXPECT_GT(cut, 3);
}

}  // namespace
}  // namespace rg
