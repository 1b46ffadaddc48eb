// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/camera/camera_motion.hpp"
#include "core/base/camera/camera_warp.hpp"
#include "tests/core/scenes.hpp"
#include "tests/core/simd_targets.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <vector>

namespace rg {
namespace {

constexpr double kOne = CameraMotion::kOne;

TEST(CameraMotion, AShiftIsTheSameEverywhere) {
  constexpr CameraMotion kShift(Point{-37, 21});
  static_assert(kShift.isShift());
  static_assert(kShift.at(0, 0) == Point{-37, 21} && kShift.at(600, 300) == Point{-37, 21});
  static_assert(kShift.before(10, 10) == Point{10 * 256 + 37 * 16, 10 * 256 - 21 * 16});
  static_assert(CameraMotion().at(5, 5) == Point{});
}

TEST(CameraMotion, WhatLiesFarOutsideOfTheFrameHasAnAnswer) {
  const CameraMotion camera({1 << 30, 0, 0, 0, 1 << 30, 0, -(1 << 20), 0, 1 << 30}, {320, 180});
  for (const int far : {-2'000'000'000, -20'000, 20'000, 2'000'000'000})
    EXPECT_LE(std::abs(camera.at(far, far).x), 1 << 24);
}

TEST(CameraMotion, TellsHowFarAPlaceHasMovedSinceThePreviousFrame) {
  const auto part = [](double v) { return static_cast<int64_t>(std::llround(v * kOne)); };
  const CameraMotion camera(
      {part(.98), part(.03), part(7), part(-.03), part(.98), part(-3), 0, 0, part(1)}, {320, 180});
  for (const Point place : {Point{10, 20}, Point{320, 180}, Point{600, 40}}) {
    const Point by = camera.since({place.x * 16, place.y * 16});
    const Point back = camera.at(place.x + by.x / 16, place.y + by.y / 16);
    EXPECT_NEAR(by.x, back.x, 2);
    EXPECT_NEAR(by.y, back.y, 2);
  }
  constexpr CameraMotion kShift(Point{-37, 21});
  static_assert(kShift.since({99, 5}) == Point{-37, 21});
}

TEST(CameraMotion, TellsHowDirectionsAndLengthsHaveChanged) {
  const auto part = [](double v) { return static_cast<int64_t>(std::llround(v * kOne)); };
  // Zooms in, turns, slants.
  const CameraMotion camera({part(.95), part(.05), part(7), part(-.05), part(.96), part(-3),
                             part(2e-4), part(-1e-4), part(1)},
                            {320, 180});
  for (const Point place : {Point{10, 20}, Point{320, 180}, Point{600, 340}}) {
    const LinearMap change = camera.around(place.x, place.y);
    constexpr int kLength = 16;
    const auto differenceOf = [](Point a, Point b) { return Point{a.x - b.x, a.y - b.y}; };
    const Point alongX = differenceOf(camera.before(place.x + kLength / 2, place.y),
                                      camera.before(place.x - kLength / 2, place.y));
    const Point alongY = differenceOf(camera.before(place.x, place.y + kLength / 2),
                                      camera.before(place.x, place.y - kLength / 2));
    // What was so long and so directed is kLength pixels along an axis now, but for the slant.
    constexpr int kNow = kLength * 256;
    EXPECT_NEAR(change.of(alongX).x, kNow, 8);
    EXPECT_NEAR(change.of(alongX).y, 0, 8);
    EXPECT_NEAR(change.of(alongY).x, 0, 8);
    EXPECT_NEAR(change.of(alongY).y, kNow, 8);
  }
  const double area = .95 * .96 + .05 * .05;
  EXPECT_NEAR(double(camera.around(320, 180).scale()), LinearMap::kOne / std::sqrt(area), 100);
  constexpr LinearMap kNone = CameraMotion(Point{-37, 21}).around(17, 5);
  static_assert(kNone.of({-9, 1 << 30}) == Point{-9, 1 << 30} && kNone.scale() == LinearMap::kOne);
}

TEST(CameraMotion, WhatMakesALineOfThePictureChangesNoLengths) {
  const CameraMotion flat({0, 0, 0, 0, 0, 0, 0, 0, CameraMotion::kOne}, {0, 0});
  EXPECT_EQ(flat.around(3, 4).scale(), LinearMap::kOne);
  constexpr int64_t kFar = int64_t{1} << 32;
  const CameraMotion wild({kFar, -kFar, 0, kFar, kFar, 0, 1 << 30, 1 << 30, 1 << 30}, {0, 0});
  const LinearMap change = wild.around(1 << 20, -(1 << 20));
  EXPECT_GE(change.scale(), 0);
  EXPECT_LE(std::abs(change.of({INT32_MAX, INT32_MIN}).x), int64_t{INT32_MAX} + 1);
}

/// Pixel by pixel, each place exact.
TEST(CameraWarp, IsTheFrameWhereTheCameraSaysForAnyNumberOfThreads) {
  constexpr Size kSmall{157, 90};
  const auto previous = scenes::paintGrey(kSmall, [](int x, int y) {
    return 128 + static_cast<int>(60 * std::sin(x * .21) + 50 * std::cos(y * .17 + x * .05));
  });
  const auto part = [](double v) { return static_cast<int64_t>(std::llround(v * kOne)); };
  const CameraMotion camera({part(.98), part(.03), part(2.3), part(-.03), part(.98), part(-4.1),
                             part(2e-4), part(-1e-4), part(1)},
                            {kSmall.width / 2, kSmall.height / 2});
  test::forEachTargetAndThreads([&](const std::shared_ptr<const Executor>& executor) {
    Image<uint8_t> expected(kSmall);
    std::vector<ShownRange> range(static_cast<size_t>(kSmall.height));
    warpByCamera(previous->luma(), camera, *executor, expected, range);
    for (int y = 0; y < kSmall.height; ++y)
      for (int x = 0; x < kSmall.width; ++x) {
        const Point was = camera.before(x, y);
        const ShownRange& shown = range[static_cast<size_t>(y)];
        const bool isShown = x >= shown.first && x < shown.last;
        constexpr int kNearBorder = 4;
        const bool isInside = was.x >= kNearBorder && was.y >= kNearBorder &&
                              was.x <= (kSmall.width - 1) * 256 - kNearBorder &&
                              was.y <= (kSmall.height - 1) * 256 - kNearBorder;
        EXPECT_TRUE(isShown || !isInside) << x << ' ' << y;
        if (!isShown) continue;
        const int px = std::clamp(was.x >> 8, 0, kSmall.width - 2);
        const int py = std::clamp(was.y >> 8, 0, kSmall.height - 2);
        const double u = was.x / 256.0 - px, v = was.y / 256.0 - py;
        const ImageView<const uint8_t> luma = previous->luma();
        const double level = (luma.row(py)[px] * (1 - u) + luma.row(py)[px + 1] * u) * (1 - v) +
                             (luma.row(py + 1)[px] * (1 - u) + luma.row(py + 1)[px + 1] * u) * v;
        EXPECT_NEAR(expected.at(x, y), level, 1.6) << x << ' ' << y;
      }
  });
}

}  // namespace
}  // namespace rg
