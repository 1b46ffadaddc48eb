// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/mapping.hpp"

#include <gtest/gtest.h>

namespace rg {
namespace {

TEST(FrameMap, EqualSizesChangeNothing) {
  const auto map = mapBetween({7, 5}, {7, 5});
  EXPECT_EQ(map.box({-3, 2, 9, 4}), (Box{-3, 2, 9, 4}));
  EXPECT_EQ(map.point({-3, 2}), (Point{-3, 2}));
  EXPECT_EQ(map.x(-123457), -123457);
  EXPECT_EQ(map.area(35), 35);
}

TEST(FrameMap, FollowsEachAxisByItsOwnRatio) {
  const auto map = mapBetween({320, 240}, {640, 60});
  EXPECT_EQ(map.box({10, 20, 30, 40}), (Box{20, 5, 60, 10}));
  EXPECT_EQ(map.area(100), 50);
}

TEST(FrameMap, BoxesThatTouchStillTouch) {
  const auto map = mapBetween({100, 100}, {33, 33});
  for (int x = 0; x < 95; ++x) {
    const Box left = map.box({x, 0, 5, 5});
    EXPECT_EQ(left.right(), map.box({x + 5, 0, 5, 5}).x) << x;
  }
}

TEST(FrameMap, WhatIsThereStaysVisible) {
  const auto map = mapBetween({1000, 1000}, {10, 10});
  EXPECT_EQ(map.box({501, 501, 2, 2}), (Box{5, 5, 1, 1}));
  EXPECT_TRUE(map.box({501, 501, 0, 0}).isEmpty());
}

TEST(FrameMap, AnEmptySourceMapsNothingAway) {
  EXPECT_EQ(mapBetween({}, {640, 480}).point({3, 4}), (Point{3, 4}));
}

TEST(FrameMap, LargeFramesStayInRange) {
  const auto map = mapBetween({1, 1}, {16384, 16384});
  EXPECT_EQ(map.area(1), int64_t{16384} * 16384);
  EXPECT_EQ(map.x(INT32_MIN), int64_t{INT32_MIN} * 16384);
}

}  // namespace
}  // namespace rg
