// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/merge/parallax.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <random>
#include <vector>

namespace rg {
namespace {

using objects::Parallax;
using segmentation::RegionLabel;

constexpr int kUnit = motion::kMotionUnit;
constexpr int64_t kStepNs = 40'000'000;
constexpr Point kPlane{-12 * kUnit, 3 * kUnit};  ///< By how much the ground moves.

/// Regions of 1000 px in a row, all of which can be relied on alike; each touches the next one
/// where `touches` says so.
motion::Motion rowOf(const std::vector<Point>& beyond, bool touches, Point plane = kPlane) {
  auto graph = std::make_shared<graph::Graph>();
  motion::Motion motion;
  motion.camera = CameraMotion(plane);
  for (size_t i = 0; i < beyond.size(); ++i) {
    graph::Region region;
    region.areaPx = 1000;
    region.centroidX = static_cast<int32_t>(i * 40) << 8;
    graph->regions.push_back(region);
    motion.regions.push_back({plane.x + beyond[i].x, plane.y + beyond[i].y, 0, 200});
    if (i > 0 && touches)
      graph->arcs.push_back({RegionLabel::ofIndex(i - 1), RegionLabel::ofIndex(i), 10, 0});
  }
  motion.graph = graph;
  return motion;
}

/// Ten regions of the ground, and before it what goes along with it by these many pixels.
std::vector<Point> groundAnd(const std::vector<int>& along) {
  std::vector<Point> beyond(10);
  for (const int px : along) {
    beyond.push_back({-4 * px * kUnit, px * kUnit});
    beyond.emplace_back();
  }
  return beyond;
}

Parallax looked(const motion::Motion& motion) {
  Parallax parallax;
  parallax.look(motion, {}, kStepNs, {});
  return parallax;
}

TEST(Parallax, IsWhatGoesAlongWithThePlaneInManyPieces) {
  const Parallax parallax = looked(rowOf(groundAnd({1, 3, 2}), true));
  EXPECT_TRUE(parallax.explains({-8 * kUnit, 2 * kUnit}, kPlane));
  EXPECT_TRUE(parallax.explains({-40 * kUnit, 12 * kUnit}, kPlane)) << "a sixth off its line";
  EXPECT_FALSE(parallax.explains({8 * kUnit, -2 * kUnit}, kPlane)) << "with the camera";
  EXPECT_FALSE(parallax.explains({2 * kUnit, 8 * kUnit}, kPlane)) << "across";
  EXPECT_FALSE(parallax.explains({}, kPlane));
  EXPECT_FALSE(parallax.explains({-8 * kUnit, 2 * kUnit}, {})) << "before a camera at rest";
}

TEST(Parallax, IsNoneWhereOneThingMovesAgainstTheCamera) {
  EXPECT_FALSE(looked(rowOf(groundAnd({2}), true)).explains({-8 * kUnit, 2 * kUnit}, kPlane));
  const std::vector<Point> car(12, {-8 * kUnit, 2 * kUnit});
  EXPECT_FALSE(looked(rowOf(car, true)).explains(car.front(), kPlane)) << "one piece";
  EXPECT_TRUE(looked(rowOf(car, false)).explains(car.front(), kPlane)) << "twelve";
}

TEST(Parallax, IsNoneWhereThingsMoveWithTheCamera) {
  EXPECT_FALSE(
      looked(rowOf(groundAnd({-2, -3, -1}), true)).explains({8 * kUnit, 2 * kUnit}, kPlane));
  EXPECT_FALSE(
      looked(rowOf(groundAnd({-2, -3, -1}), true)).explains({-8 * kUnit, 2 * kUnit}, kPlane));
}

TEST(Parallax, IsForgottenWithTime) {
  Parallax parallax = looked(rowOf(groundAnd({1, 3, 2}), true));
  const motion::Motion flat = rowOf(groundAnd({}), true);
  const Point beyond{-8 * kUnit, 2 * kUnit};
  parallax.look(flat, {}, kStepNs, {});
  EXPECT_TRUE(parallax.explains(beyond, kPlane)) << "for a frame";
  for (int i = 0; i < 25; ++i) parallax.look(flat, {}, kStepNs, {});
  EXPECT_FALSE(parallax.explains(beyond, kPlane)) << "for a second";
  parallax = looked(rowOf(groundAnd({1, 3, 2}), true));
  parallax.reset();
  EXPECT_FALSE(parallax.explains(beyond, kPlane));
}

/// A frame that is turned by half has the same parallax.
TEST(Parallax, IsTheSameOfATurnedFrame) {
  std::mt19937 random(3);
  const auto between = [&](int least, int most) {
    return least + static_cast<int>(random() % static_cast<uint32_t>(most - least + 1));
  };
  int found = 0;
  for (int round = 0; round < 200; ++round) {
    std::vector<Point> beyond, turned;
    for (int i = 0; i < 30; ++i) {
      const int along = between(-1, 6) * kUnit / 2;
      beyond.push_back({-4 * along + between(-9, 9), along + between(-9, 9)});
      turned.push_back({-beyond.back().x, -beyond.back().y});
    }
    const Parallax parallax = looked(rowOf(beyond, true));
    const Parallax other = looked(rowOf(turned, true, {-kPlane.x, -kPlane.y}));
    for (size_t i = 0; i < beyond.size(); ++i) {
      const bool isStill = parallax.explains(beyond[i], kPlane);
      ASSERT_EQ(isStill, other.explains(turned[i], {-kPlane.x, -kPlane.y}));
      found += isStill;
    }
  }
  EXPECT_GT(found, 100);
}

}  // namespace
}  // namespace rg
