// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/camera/parallax.hpp"
#include "tests/core/scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

namespace rg {
namespace {

constexpr Size kSize{640, 360};
constexpr int kAcross = 16, kTile = 40, kTiles = kAcross * 9;

/// A region for each tile of the frame, with motions in pixels.
motion::Motion tiles(const std::function<std::pair<double, double>(int, int)>& motionAt) {
  motion::Motion motion;
  motion.size = kSize;
  motion.status = Status::Ok;
  const auto picture = scenes::paintGrey(kSize, [](int, int) { return 0; });
  motion.graph =
      *graph::makeStage(scenes::contextWith(1))
           ->process(
               scenes::label(picture, kTiles,
                             [](int x, int y) { return y / kTile * kAcross + x / kTile + 1; }),
               {});
  for (int tile = 0; tile < kTiles; ++tile) {
    const auto [dx, dy] = motionAt(tile % kAcross, tile / kAcross);
    motion.regions.push_back({static_cast<int>(std::lround(dx * motion::kMotionUnit)),
                              static_cast<int>(std::lround(dy * motion::kMotionUnit)), 0, 200});
  }
  return motion;
}

bool isPost(int column, int row) {
  return column % 4 == 1 && row > 1;
}

/// Posts that a camera passes, which moves to the left.
std::pair<double, double> passedPosts(int column, int row) {
  return {isPost(column, row) ? 4 + column % 3 : 0, 0};
}

objects::Parallax parallaxOf(const motion::Motion& motion) {
  objects::Parallax parallax;
  parallax.find(motion, {}, motion::kMotionUnit);
  return parallax;
}

TEST(Parallax, WhatIsNearMovesFasterTheWayThatAllOfItDoes) {
  const objects::Parallax parallax = parallaxOf(tiles(passedPosts));
  EXPECT_TRUE(parallax.explains({60, 200}, {5 * motion::kMotionUnit, 0}));
  EXPECT_TRUE(parallax.explains({380, 100}, {9 * motion::kMotionUnit, 0}));
  EXPECT_FALSE(parallax.explains({380, 100}, {-5 * motion::kMotionUnit, 0}));
  EXPECT_FALSE(parallax.explains({380, 100}, {0, 5 * motion::kMotionUnit}));
}

TEST(Parallax, ACameraThatComesNearerSpreadsWhatIsNear) {
  const objects::Parallax parallax = parallaxOf(tiles([](int column, int row) {
    const double x = column - 7.5, y = row - 4.0;
    return (column + row) % 3 == 0 ? std::pair(x * .9, y * .9) : std::pair(0.0, 0.0);
  }));
  EXPECT_TRUE(parallax.explains({600, 180}, {5 * motion::kMotionUnit, 0}));
  EXPECT_TRUE(parallax.explains({40, 180}, {-5 * motion::kMotionUnit, 0}));
  EXPECT_FALSE(parallax.explains({600, 180}, {0, 5 * motion::kMotionUnit}));
}

TEST(Parallax, OneThingThatMovesIsNoParallax) {
  EXPECT_FALSE(parallaxOf(tiles([](int column, int row) {
                 const bool isThing = column > 3 && column < 9 && row > 2 && row < 7;
                 return std::pair(isThing ? 5.0 : 0.0, 0.0);
               })).isSeen());
}

TEST(Parallax, WhereNothingMovesOtherwiseThereIsNone) {
  EXPECT_FALSE(parallaxOf(tiles([](int, int) { return std::pair(0.0, 0.0); })).isSeen());
}

}  // namespace
}  // namespace rg
