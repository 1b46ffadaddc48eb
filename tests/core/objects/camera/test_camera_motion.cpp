// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/camera/camera_fit.hpp"
#include "core/objects/camera/camera_warp.hpp"
#include "tests/core/scenes.hpp"
#include "tests/core/simd_targets.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <functional>

namespace rg {
namespace {

using objects::CameraMotion;

constexpr Size kSize{640, 360};
constexpr int kAcross = 16, kDown = 9, kTile = 40;
constexpr double kOne = CameraMotion::kOne;

struct Place {
  double x, y;
};
using Way = std::function<Place(double, double)>;  ///< From now to before, from the middle.

Place zoomedAndRolled(double x, double y) {
  constexpr double kScale = .98, kAngle = .035;
  return {kScale * (x * std::cos(kAngle) - y * std::sin(kAngle)) + 7,
          kScale * (x * std::sin(kAngle) + y * std::cos(kAngle)) - 3};
}

Place slanted(double x, double y) {
  const double w = 1 + 4e-5 * x - 3e-5 * y;
  return {(1.01 * x + .004 * y - 5) / w, (.002 * x + .99 * y + 2) / w};
}

/// A region for each tile of the frame; `stays` tells which have a motion of their own.
motion::Motion tiles(const Way& before, const std::function<bool(int)>& movesItself = {}) {
  motion::Motion motion;
  motion.size = kSize;
  motion.status = Status::Ok;
  const auto picture = scenes::paintGrey(kSize, [](int, int) { return 0; });
  motion.graph =
      *graph::makeStage(scenes::contextWith(1))
           ->process(
               scenes::label(picture, kAcross * kDown,
                             [](int x, int y) { return y / kTile * kAcross + x / kTile + 1; }),
               {});
  for (int tile = 0; tile < kAcross * kDown; ++tile) {
    const double x = tile % kAcross * kTile + (kTile - 1) / 2.0 - kSize.width / 2;
    const double y = tile / kAcross * kTile + (kTile - 1) / 2.0 - kSize.height / 2;
    const Place was = before(x, y);
    const bool isMover = movesItself && movesItself(tile);
    const auto inUnits = [](double v) { return static_cast<int>(std::lround(v * 16)); };
    motion.regions.push_back({inUnits(x - was.x) + (isMover ? 130 : 0),
                              inUnits(y - was.y) - (isMover ? 30 : 0), 0, 200});
  }
  return motion;
}

double worstAtCorners(const CameraMotion& camera, const Way& before) {
  double worst = 0;
  for (const Point corner : {Point{0, 0}, Point{kSize.width - 1, 0}, Point{0, kSize.height - 1},
                             Point{kSize.width - 1, kSize.height - 1}}) {
    const Point found = camera.before(corner.x, corner.y);
    const Place is = before(corner.x - kSize.width / 2, corner.y - kSize.height / 2);
    worst = std::max(worst, std::hypot(found.x / 256.0 - kSize.width / 2 - is.x,
                                       found.y / 256.0 - kSize.height / 2 - is.y));
  }
  return worst;
}

CameraMotion fit(const motion::Motion& motion) {
  objects::CameraScratch scratch;
  return objects::fitCamera(motion, {}, scratch);
}

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

TEST(CameraFit, FindsZoomAndRollAtTheCorners) {
  EXPECT_LT(worstAtCorners(fit(tiles(zoomedAndRolled)), zoomedAndRolled), .1);
}

TEST(CameraFit, FindsASlant) {
  EXPECT_LT(worstAtCorners(fit(tiles(slanted)), slanted), .1);
}

TEST(CameraFit, AThirdThatMovesOtherwiseChangesLittle) {
  const auto third = [](int tile) { return tile % kAcross >= 5 && tile % kAcross < 11; };
  EXPECT_LT(worstAtCorners(fit(tiles(zoomedAndRolled, third)), zoomedAndRolled), .25);
}

TEST(CameraFit, SupportsNoMoreThanIsSeen) {
  const CameraMotion camera = fit(tiles([](double x, double y) { return Place{x + 4, y - 2}; }));
  EXPECT_EQ(camera.at(0, 0), camera.at(kSize.width - 1, kSize.height - 1));
  EXPECT_EQ(camera.at(100, 100), (Point{-64, 32}));
}

TEST(CameraFit, WithoutReliableRegionsItIsTheGivenShift) {
  motion::Motion motion = tiles(zoomedAndRolled);
  for (motion::RegionMotion& region : motion.regions) region.reliability = 0;
  objects::CameraScratch scratch;
  EXPECT_EQ(objects::fitCamera(motion, {{48, -16, 0, 256}, {}, 16, {}}, scratch),
            CameraMotion(Point{48, -16}));
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
    objects::ExpectedFrame expected;
    objects::warpByCamera(previous->luma(), camera, *executor, expected);
    for (int y = 0; y < kSmall.height; ++y)
      for (int x = 0; x < kSmall.width; ++x) {
        const Point was = camera.before(x, y);
        const objects::ShownRange& shown = expected.shown[static_cast<size_t>(y)];
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
        EXPECT_NEAR(expected.luma.at(x, y), level, 1.6) << x << ' ' << y;
      }
  });
}

}  // namespace
}  // namespace rg
