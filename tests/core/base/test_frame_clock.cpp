// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/time/frame_clock.hpp"

#include <gtest/gtest.h>

#include <limits>

namespace rg {
namespace {

TEST(FrameClock, CountsTheFramesOfASecond) {
  FrameClock clock;
  EXPECT_EQ(clock.frames(1), 25);
  for (int i = 0; i < 50; ++i) clock.tick({i * int64_t{20'000'000}, true});
  EXPECT_EQ(clock.frames(1), 50);
}

TEST(FrameClock, JumpsOverAllOfTimeSayNothingOfTheRate) {
  FrameClock clock;
  for (const int64_t time :
       {INT64_MAX, int64_t{0}, INT64_MIN, INT64_MAX, INT64_MAX - 1, INT64_MIN, int64_t{-1}})
    clock.tick({time, true});
  EXPECT_EQ(clock.frames(1), 25);
}

TEST(FrameClock, NoNumberOfSecondsIsTooMuch) {
  FrameClock clock;
  clock.tick({0, true});
  clock.tick({1, true});  // A frame each nanosecond.
  EXPECT_EQ(clock.frames(std::numeric_limits<double>::infinity()), 1'000'000'000'000'000);
  EXPECT_EQ(clock.frames(-std::numeric_limits<double>::infinity()), 1);
  EXPECT_EQ(clock.frames(std::numeric_limits<double>::quiet_NaN()), 1);
}

}  // namespace
}  // namespace rg
