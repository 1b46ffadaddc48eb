// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/merge/motion_trends.hpp"
#include "tests/core/scenes.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <utility>
#include <vector>

namespace rg {
namespace {

constexpr Size kSize{64, 32};
constexpr uint16_t kTellsAll = 256;
constexpr Box kSquare{4, 8, 12, 12};

/// Regions that are boxes, later ones before earlier ones, and their vectors in pixels.
struct Shown {
  Box box;
  Point step;
  uint16_t reliability = kTellsAll;
};

class Trends {
 public:
  const motion::Motion& show(const std::vector<Shown>& shown, Status status = Status::Ok) {
    const auto picture = scenes::paintGrey(kSize, [](int, int) { return 0; });
    auto labels = scenes::label(picture, static_cast<uint32_t>(shown.size()), [&](int x, int y) {
      int label = 0;
      for (size_t i = 0; i < shown.size(); ++i)
        if (shown[i].box.contains({x, y})) label = static_cast<int>(i + 1);
      return label;
    });
    motion::Motion motion;
    motion.size = kSize;
    motion.status = status;
    motion.graph = *graph::makeStage(scenes::contextWith(1))->process(std::move(labels), {});
    for (const Shown& s : shown)
      motion.regions.push_back(
          {s.step.x * motion::kMotionUnit, s.step.y * motion::kMotionUnit, 0, s.reliability});
    objects::followTrends(motion, executor_, memory_, result_);
    return result_;
  }
  void reset() { memory_.reset(); }

 private:
  Executor executor_{1};
  objects::MotionTrends memory_;
  motion::Motion result_;
};

Box moved(const Box& box, int dx) {
  return {box.x + dx, box.y, box.width, box.height};
}

TEST(MotionTrends, WhatKeepsMovingAlikeBecomesCertain) {
  Trends trends;
  int before = 0;
  for (int i = 0; i < 8; ++i) {
    const motion::RegionMotion now = trends.show({{moved(kSquare, 4 * i), {4, 0}}}).regions[0];
    EXPECT_EQ(now.dx, 4 * motion::kMotionUnit);
    EXPECT_EQ(now.dy, 0);
    EXPECT_GT(now.reliability, before);
    before = now.reliability;
  }
  EXPECT_GT(before, 7 * motion::kFullReliability / 8);
}

TEST(MotionTrends, WhatTurnsRoundStartsAnew) {
  Trends trends;
  const int first = trends.show({{kSquare, {4, 0}}}).regions[0].reliability;
  for (int i = 1; i < 6; ++i) trends.show({{moved(kSquare, 4 * i), {4, 0}}});
  const motion::RegionMotion now = trends.show({{moved(kSquare, 16), {-4, 0}}}).regions[0];
  EXPECT_EQ(now.dx, -4 * motion::kMotionUnit);
  EXPECT_EQ(now.reliability, first);
}

TEST(MotionTrends, WhatWasUncoveredInheritsNothing) {
  Trends trends;
  for (int i = 0; i < 6; ++i) trends.show({{moved(kSquare, 4 * i), {4, 0}}});
  const motion::Motion& now = trends.show({{{24, 8, 4, 12}, {0, 0}}, {moved(kSquare, 24), {4, 0}}});
  EXPECT_EQ(now.regions[0].dx, 0);
  EXPECT_LT(2 * now.regions[0].reliability,
            now.regions[1].reliability + motion::kFullReliability / 4);
  EXPECT_LE(now.regions[0].reliability, motion::kFullReliability / 2);
}

TEST(MotionTrends, AVectorThatSaysNothingLeavesTheTrend) {
  Trends trends;
  trends.show({{kSquare, {4, 0}}});
  const int before = trends.show({{moved(kSquare, 4), {4, 0}}}).regions[0].reliability;
  const motion::RegionMotion now = trends.show({{moved(kSquare, 8), {4, 0}, 0}}).regions[0];
  EXPECT_EQ(now.dx, 4 * motion::kMotionUnit);
  EXPECT_EQ(now.reliability, before);
}

TEST(MotionTrends, PartsOfARegionAddUp) {
  Trends trends;
  // Two halves that moved alike, then one region of them and of as much that is new.
  trends.show({{{0, 8, 8, 8}, {4, 0}}, {{8, 8, 8, 8}, {4, 0}}});
  const int whole = trends.show({{{4, 8, 16, 8}, {4, 0}}}).regions[0].reliability;
  trends.reset();
  trends.show({{{0, 8, 8, 8}, {4, 0}}});
  const int half = trends.show({{{4, 8, 16, 8}, {4, 0}}}).regions[0].reliability;
  EXPECT_GT(whole, half);
  trends.reset();
  EXPECT_GT(half, trends.show({{{4, 8, 16, 8}, {4, 0}}}).regions[0].reliability);
}

TEST(MotionTrends, WithoutAPreviousFrameNothingIsKnown) {
  Trends trends;
  for (int i = 0; i < 4; ++i) trends.show({{moved(kSquare, 4 * i), {4, 0}}});
  const motion::Motion& skipped = trends.show({{moved(kSquare, 16), {0, 0}, 0}}, Status::Skipped);
  EXPECT_EQ(skipped.regions[0].reliability, 0);
  EXPECT_EQ(skipped.regions[0].dx, 0);
}

TEST(MotionTrends, WhatComesFromBeyondTheFrameIsNew) {
  Trends trends;
  trends.show({{{0, 0, 64, 32}, {4, 0}}});
  const int first = trends.show({{{0, 0, 4, 32}, {40, 30}}}).regions[0].reliability;
  trends.reset();
  EXPECT_EQ(trends.show({{{0, 0, 4, 32}, {40, 30}}}).regions[0].reliability, first);
}

}  // namespace
}  // namespace rg
