// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/motion/camera/frame_shift.hpp"
#include "tests/core/scenes.hpp"
#include "tests/core/simd_targets.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

namespace rg {
namespace {

constexpr Size kSize{384, 216};

/// A ground with features of all sizes, seen by a camera at (x, y).
std::shared_ptr<const Picture> seenFrom(Point view) {
  return scenes::paintGrey(kSize, [&](int x, int y) {
    const double u = x + view.x, v = y + view.y;
    return 128 + static_cast<int>(40 * std::sin(u * .051 + std::cos(v * .04)) +
                                  35 * std::sin(v * .083 + u * .013) +
                                  25 * std::sin(u * .37) * std::cos(v * .31));
  });
}

TEST(FrameShift, FindsAPanToAHundredthOfTheFrameOnAnyNumberOfThreads) {
  for (const Point by : {Point{60, 0}, Point{-45, 21}, Point{0, -30}})
    test::forEachTargetAndThreads([&](const std::shared_ptr<const Executor>& executor) {
      motion::FrameShift shift;
      const Point found = shift.find(seenFrom({-by.x, -by.y}), seenFrom({}), *executor);
      EXPECT_LE(std::abs(found.x - by.x), 4);
      EXPECT_LE(std::abs(found.y - by.y), 4);
    });
}

TEST(FrameShift, WhatStandsStillHasNone) {
  motion::FrameShift shift;
  const auto picture = seenFrom({});
  EXPECT_EQ(shift.find(picture, picture, Executor(1)), Point{});
  const auto flat = scenes::paintGrey(kSize, [](int, int) { return 90; });
  EXPECT_EQ(shift.find(flat, picture, Executor(1)), Point{});
}

TEST(FrameShift, TakesAnyPicture) {
  for (const Size size : {Size{1, 1}, Size{3, 200}, Size{900, 2}, Size{129, 1}}) {
    motion::FrameShift shift;
    EXPECT_EQ(shift.find(scenes::greyNoise(size, 1), scenes::greyNoise(size, 2), Executor(1)),
              Point{});
  }
}

}  // namespace
}  // namespace rg
