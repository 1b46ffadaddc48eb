// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/movers.hpp"
#include "core/objects/operations.hpp"
#include "tests/core/scenes.hpp"
#include "tests/core/simd_targets.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

namespace rg {
namespace {

constexpr Size kSize{96, 64};
constexpr int64_t kPerPixelNs = 40'000'000;
constexpr size_t kGround = 0, kSquare = 1;

/// A ground that pans by a pixel in each frame, and a square that goes a pixel further in every
/// `framesPerPixel` of them.
struct SlowScene {
  int framesPerPixel = 4;

  [[nodiscard]] Box squareAt(int frame) const {
    return {20 + frame + frame / framesPerPixel, 20, 16, 16};
  }
  [[nodiscard]] std::shared_ptr<const Picture> picture(int frame) const {
    return scenes::paintGrey(kSize, [&](int x, int y) {
      const Box square = squareAt(frame);
      const bool isSquare = square.contains({x, y});
      const auto u = static_cast<uint32_t>(isSquare ? x - square.x : x - frame + 1000);
      return 60 + static_cast<int>(mixHash(u, static_cast<uint32_t>(y), isSquare ? 9 : 5) % 90);
    });
  }
  [[nodiscard]] motion::Motion motion(int frame) const {
    const auto labels = scenes::label(picture(frame), 2, [&](int x, int y) {
      return squareAt(frame).contains({x, y}) ? 2 : 1;
    });
    motion::Motion motion;
    motion.size = kSize;
    motion.status = frame == 0 ? Status::Skipped : Status::Ok;
    motion.graph = *graph::makeStage(scenes::contextWith(1))->process(labels, {});
    constexpr int kUnit = motion::kMotionUnit;
    if (frame > 0) motion.camera = CameraMotion(Point{kUnit, 0});
    motion.regions = {{kUnit, 0, 0, 200}, {kUnit + kUnit / framesPerPixel, 0, 0, 200}};
    return motion;
  }
};

/// Gains of the ground and the square in the last of so many frames.
std::vector<int64_t> gainsAfter(int frames, int64_t stepNs, const Executor& executor) {
  const SlowScene scene;
  objects::Operations operations(executor);
  objects::Movers movers;
  for (int frame = 0; frame < frames; ++frame) {
    const motion::Motion motion = scene.motion(frame);
    std::vector<objects::ArcEnergy> arcs;
    objects::weighArcs(motion, {}, {}, arcs);
    const std::vector<objects::TrackIndex> expected(motion.regions.size());
    const objects::MoverRules rules{arcs, {}, expected, {}, stepNs, kPerPixelNs, {}};
    movers.find(motion, rules, operations);
    movers.remember(motion, rules, operations);
  }
  return {movers.own()[kGround].gain, movers.own()[kSquare].gain};
}

TEST(Movers, WhatMovesByPartsOfAPixelIsSeenAgainstAnOlderFrame) {
  test::forEachTargetAndThreads([&](const std::shared_ptr<const Executor>& executor) {
    const std::vector<int64_t> gains = gainsAfter(9, kPerPixelNs / 6, *executor);
    EXPECT_LE(gains[kGround], 0);
    EXPECT_GT(gains[kSquare], 16 * 16 * objects::kGainUnit);
  });
}

TEST(Movers, WhereFramesAreFewTheLastOneIsAsked) {
  // It shows no motion: a quarter of a pixel is beyond what is asked for.
  EXPECT_EQ(gainsAfter(9, kPerPixelNs, Executor(1))[kSquare], 0);
}

TEST(Movers, AfterFramesOfAnotherSizeNothingIsCompared) {
  const SlowScene scene;
  const Executor executor(1);
  objects::Operations operations(executor);
  objects::Movers movers;
  const std::vector<objects::TrackIndex> expected(2);
  const auto find = [&](const motion::Motion& motion) {
    std::vector<objects::ArcEnergy> arcs;
    objects::weighArcs(motion, {}, {}, arcs);
    const objects::MoverRules rules{arcs, {}, expected, {}, kPerPixelNs / 6, kPerPixelNs, {}};
    movers.find(motion, rules, operations);
    movers.remember(motion, rules, operations);
  };
  for (int frame = 0; frame < 9; ++frame) find(scene.motion(frame));
  EXPECT_GT(movers.own()[kSquare].gain, 0);
  movers.reset();
  find(scene.motion(9));
  EXPECT_EQ(movers.own()[kSquare].gain, 0);
  for (int frame = 10; frame < 18; ++frame) find(scene.motion(frame));
  EXPECT_GT(movers.own()[kSquare].gain, 0);
  motion::Motion skipped = scene.motion(18);
  skipped.status = Status::Skipped;
  find(skipped);
  EXPECT_EQ(movers.own()[kSquare].gain, 0);
}

TEST(PastFrames, KeepsTheYoungestAndOneForEachEighth) {
  objects::PastFrames past;
  EXPECT_EQ(past.nearest(100), nullptr);
  EXPECT_EQ(past.previous(), nullptr);
  const auto picture = scenes::paintGrey({16, 16}, [](int, int) { return 9; });
  for (int frame = 0; frame < 1000; ++frame) {
    past.advance(CameraMotion(Point{1, 0}), 1);
    past.add(picture, 80);
    if (frame == 0) continue;
    past.advance({}, 0);
    EXPECT_EQ(past.previous()->ageNs, 0);
  }
  past.advance({}, 1);
  const objects::PastFrame* older = past.nearest(80);
  EXPECT_NEAR(static_cast<double>(older->ageNs), 80, 5);
  // A sixteenth in each nanosecond but the last.
  EXPECT_EQ(older->camera.at(8, 8), (Point{static_cast<int>(older->ageNs) - 1, 0}));
  EXPECT_EQ(past.previous()->ageNs, 1);
  EXPECT_NEAR(static_cast<double>(past.nearest(40)->ageNs), 40, 5);
  EXPECT_NEAR(static_cast<double>(past.nearest(80)->ageNs), 40, 5);  // Older ones are forgotten.
  past.clear();
  EXPECT_EQ(past.previous(), nullptr);
}

}  // namespace
}  // namespace rg
