// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/tracking/looks/contour.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string_view>

namespace rg {
namespace {

using testing::ElementsAre;

/// '#' is 1, all else 0; the contour from the first '#'.
std::vector<Point> contourOf(const std::vector<std::string_view>& rows, int limit = 100) {
  Image<uint16_t> picture({static_cast<int>(rows[0].size()), static_cast<int>(rows.size())});
  Point start{-1, -1};
  for (int y = picture.height() - 1; y >= 0; --y)
    for (int x = picture.width() - 1; x >= 0; --x) {
      const bool isSet = rows[static_cast<size_t>(y)][static_cast<size_t>(x)] == '#';
      picture.at(x, y) = isSet;
      if (isSet) start = {x, y};
    }
  std::vector<Point> contour;
  objects::traceContour(picture, start, limit, contour);
  return contour;
}

TEST(Contour, ASquareHasItsCornersClockwise) {
  EXPECT_THAT(contourOf({"....", ".##.", ".##.", "...."}),
              ElementsAre(Point{1, 1}, Point{2, 1}, Point{2, 2}, Point{1, 2}));
}

TEST(Contour, StraightSidesHaveNoPointsBetween) {
  EXPECT_THAT(contourOf({"#####", "#####", "#####"}),
              ElementsAre(Point{0, 0}, Point{4, 0}, Point{4, 2}, Point{0, 2}));
}

TEST(Contour, APixelIsItsOwnContour) {
  EXPECT_THAT(contourOf({"#"}), ElementsAre(Point{0, 0}));
}

TEST(Contour, ALineIsFollowedThereAndBack) {
  EXPECT_THAT(contourOf({"###"}), ElementsAre(Point{0, 0}, Point{2, 0}));
}

TEST(Contour, HolesAreNotFollowed) {
  EXPECT_THAT(contourOf({"###", "#.#", "###"}),
              ElementsAre(Point{0, 0}, Point{2, 0}, Point{2, 2}, Point{0, 2}));
}

TEST(Contour, DiagonalsConnect) {
  EXPECT_THAT(contourOf({"#..", ".#.", "..#"}), ElementsAre(Point{0, 0}, Point{2, 2}));
}

TEST(Contour, StopsAtTheLimit) {
  EXPECT_LE(contourOf({"#.#.#.#", ".#.#.#."}, 3).size(), 4u);
}

}  // namespace
}  // namespace rg
