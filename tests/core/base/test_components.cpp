// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/components.hpp"
#include "tests/support/text_picture.hpp"

#include <gtest/gtest.h>

namespace rg {
namespace {

using test::drawMask;
using test::textOf;

Components find(const std::vector<std::string>& lines, Connectivity connectivity) {
  Components found;
  findComponents(drawMask(lines), 255, connectivity, found);
  return found;
}

TEST(Components, DiagonalNeighboursJoinOnlyEightfold) {
  const std::vector<std::string> lines{"#..", ".#.", "..#"};
  EXPECT_EQ(find(lines, Connectivity::Eight).list.size(), 1u);
  EXPECT_EQ(find(lines, Connectivity::Four).list.size(), 3u);
  EXPECT_EQ(find({"..#", ".#.", "#.."}, Connectivity::Eight).list.size(), 1u);
}

TEST(Components, TheSmallestPixelNamesAComponent) {
  // The right arm starts first, the left one joins it at the bottom.
  const auto found = find({"....#", "#...#", "#####", ".....", ".##.."}, Connectivity::Four);
  ASSERT_EQ(found.list.size(), 2u);
  EXPECT_EQ(found.list[0].firstPixel, 4u);
  EXPECT_EQ(found.list[0].areaPx, 8u);
  EXPECT_EQ(found.list[0].box, (Box{0, 0, 5, 3}));
  EXPECT_EQ(found.list[1].firstPixel, 21u);
  EXPECT_EQ(found.list[1].box, (Box{1, 4, 2, 1}));
}

TEST(Components, NumbersFollowTheRaster) {
  const auto found = find({".#.#", "....", "#..#"}, Connectivity::Four);
  ASSERT_EQ(found.list.size(), 4u);
  for (size_t i = 1; i < found.list.size(); ++i)
    EXPECT_LT(found.list[i - 1].firstPixel, found.list[i].firstPixel);
}

TEST(Components, ASpiralIsOne) {
  const auto found =
      find({"#######", "#.....#", "#.###.#", "#.#.#.#", "#.#...#", "#.#####"}, Connectivity::Four);
  ASSERT_EQ(found.list.size(), 1u);
  EXPECT_EQ(found.list[0].areaPx, 27u);
}

TEST(Components, OtherValuesAreNoMembers) {
  Image<uint8_t> mask({4, 1});
  for (int x = 0; x < 4; ++x) mask.at(x, 0) = static_cast<uint8_t>(x < 2 ? 128 : 255);
  Components found;
  findComponents(mask, 128, Connectivity::Four, found);
  ASSERT_EQ(found.list.size(), 1u);
  EXPECT_EQ(found.list[0].box, (Box{0, 0, 2, 1}));
}

TEST(Components, ACheckerboardHasAComponentPerPixelOrOne) {
  Image<uint8_t> mask({33, 17});
  for (int y = 0; y < 17; ++y)
    for (int x = 0; x < 33; ++x) mask.at(x, y) = (x + y) % 2 == 0 ? 255 : 0;
  Components found;
  findComponents(mask, 255, Connectivity::Four, found);
  EXPECT_EQ(found.list.size(), 281u);
  findComponents(mask, 255, Connectivity::Eight, found);
  ASSERT_EQ(found.list.size(), 1u);
  EXPECT_EQ(found.list[0].areaPx, 281u);
}

/// Flood fill in raster order: slow and plain.
std::vector<uint32_t> floodAreas(const Image<uint8_t>& mask) {
  Image<uint8_t> left;
  left.copyFrom(mask);
  std::vector<uint32_t> areas;
  for (int y = 0; y < mask.height(); ++y)
    for (int x = 0; x < mask.width(); ++x) {
      if (left.at(x, y) == 0) continue;
      std::vector<Point> open{{x, y}};
      left.at(x, y) = 0;
      uint32_t area = 0;
      while (!open.empty()) {
        const Point p = open.back();
        open.pop_back();
        ++area;
        for (int dy = -1; dy <= 1; ++dy)
          for (int dx = -1; dx <= 1; ++dx) {
            const Point q{p.x + dx, p.y + dy};
            if (!boundsOf(mask.size()).contains(q) || left.at(q.x, q.y) == 0) continue;
            left.at(q.x, q.y) = 0;
            open.push_back(q);
          }
      }
      areas.push_back(area);
    }
  return areas;
}

TEST(Components, AgreeWithAFloodFillOnNoise) {
  uint32_t state = 7;
  for (const Size size : {Size{1, 1}, Size{1, 40}, Size{40, 1}, Size{61, 47}, Size{128, 9}}) {
    Image<uint8_t> mask(size);
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x)
        mask.at(x, y) = (state = state * 1664525u + 1013904223u) >> 30 == 0 ? 255 : 0;
    Components found;
    findComponents(mask, 255, Connectivity::Eight, found);
    std::vector<uint32_t> areas;
    for (const Component& component : found.list) areas.push_back(component.areaPx);
    EXPECT_EQ(areas, floodAreas(mask)) << size.width << "x" << size.height;
  }
}

TEST(Components, UnsetBitsHaveComponentsToo) {
  BitMask mask = test::drawBits({"#.#", "#.#", "###", "..."});
  Components found;
  findComponents(mask, false, Connectivity::Four, found);
  ASSERT_EQ(found.list.size(), 2u);
  EXPECT_EQ(found.list[0].areaPx, 2u);
  EXPECT_EQ(found.list[1].box, (Box{0, 3, 3, 1}));
  paintComponents(found, std::vector<uint8_t>{1, 0}, true, mask);
  EXPECT_EQ(textOf(mask), (std::vector<std::string>{"###", "###", "###", "..."}));
}

TEST(Components, RunsCrossWords) {
  BitMask mask({200, 2});
  mask.clear();
  setColumns(mask.row(0), 3, 128, true);
  setColumns(mask.row(1), 128, 200, true);
  Components found;
  findComponents(mask, true, Connectivity::Four, found);
  EXPECT_EQ(found.list.size(), 2u);
  EXPECT_EQ(found.runs.at(0).end, 128);
  EXPECT_EQ(found.runs.at(1).end, 200);
  findComponents(mask, true, Connectivity::Eight, found);
  EXPECT_EQ(found.list.size(), 1u);
}

TEST(Components, PaintingTouchesOnlyTheChosen) {
  Image<uint8_t> mask = drawMask({"##..#", "....#"});
  Components found;
  findComponents(mask, 255, Connectivity::Four, found);
  paintComponents(found, std::vector<uint8_t>{0, 1}, 0, mask);
  EXPECT_EQ(textOf(mask), (std::vector<std::string>{"##...", "....."}));
}

}  // namespace
}  // namespace rg
