// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/merge/motion_evidence.hpp"
#include "core/objects/operations.hpp"
#include "tests/core/scenes.hpp"
#include "tests/core/simd_targets.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <vector>

namespace rg {
namespace {

constexpr Size kSize{96, 64};
constexpr int64_t kStepNs = 40'000'000;
constexpr int64_t kGain = objects::kGainUnit / 2;  // Of a pixel.

/// A dark square on a bright ground, 4 px further to the right in each frame.
int squareX(int frame) {
  return 16 + 4 * frame;
}
bool isSquare(int x, int y, int frame) {
  return Box{squareX(frame), 20, 16, 16}.contains({x, y});
}

std::shared_ptr<const Picture> pictureOf(int frame, int squareLevel = 40) {
  return scenes::paintGrey(kSize,
                           [&](int x, int y) { return isSquare(x, y, frame) ? squareLevel : 200; });
}

/// Regions: ground, square.
motion::Motion motionOf(int frame, int squareLevel = 40) {
  motion::Motion motion;
  motion.size = kSize;
  motion.status = Status::Ok;
  const auto labels = scenes::label(pictureOf(frame, squareLevel), 2,
                                    [&](int x, int y) { return isSquare(x, y, frame) ? 2 : 1; });
  motion.graph = *graph::makeStage(scenes::contextWith(1))->process(labels, {});
  motion.regions = {{0, 0, 0, 200}, {4 * motion::kMotionUnit, 0, 0, 200}};
  return motion;
}

std::vector<objects::OwnMotion> squareGains(int64_t ofPixel) {
  return {{}, {{4, 0}, ofPixel * 16 * 16}};
}

/// That the square of frame 0 moves.
objects::MotionEvidence evidenceOfSquare(objects::Operations& operations) {
  objects::MotionEvidence evidence;
  evidence.carry(motionOf(0), nullptr, 0, operations);
  EXPECT_EQ(evidence.gainOf(1), 0);
  evidence.add(motionOf(0), squareGains(kGain), operations);
  return evidence;
}

TEST(MotionEvidence, GoesAlongWithWhatItWasFoundOfAndFades) {
  test::forEachTargetAndThreads([&](const std::shared_ptr<const Executor>& executor) {
    objects::Operations operations(*executor);
    objects::MotionEvidence evidence = evidenceOfSquare(operations);
    int64_t last = kGain * 16 * 16;
    for (int frame = 1; frame < 5; ++frame) {
      evidence.carry(motionOf(frame), pictureOf(frame - 1).get(), kStepNs, operations);
      EXPECT_LT(evidence.gainOf(1), last);
      EXPECT_GT(evidence.gainOf(1), last / 2);
      EXPECT_EQ(evidence.gainOf(0), 0);
      last = evidence.gainOf(1);
      evidence.add(motionOf(frame), squareGains(0), operations);
    }
  });
}

TEST(MotionEvidence, IsTakenBackByPixelsThatFollowTheGround) {
  const Executor executor(1);
  objects::Operations operations(executor);
  objects::MotionEvidence evidence = evidenceOfSquare(operations);
  evidence.carry(motionOf(1), pictureOf(0).get(), kStepNs, operations);
  evidence.add(motionOf(1), squareGains(-4 * kGain), operations);
  evidence.carry(motionOf(2), pictureOf(1).get(), kStepNs, operations);
  EXPECT_EQ(evidence.gainOf(1), 0);
}

TEST(MotionEvidence, IsNotTakenOverByWhatLooksOtherwise) {
  const Executor executor(1);
  objects::Operations operations(executor);
  objects::MotionEvidence evidence = evidenceOfSquare(operations);
  evidence.carry(motionOf(1, 90), pictureOf(0).get(), kStepNs, operations);
  EXPECT_EQ(evidence.gainOf(1), 0);
}

TEST(MotionEvidence, IsNotTakenOverByTheGroundBeside) {
  const Executor executor(1);
  objects::Operations operations(executor);
  objects::MotionEvidence evidence = evidenceOfSquare(operations);
  motion::Motion motion = motionOf(1);
  motion.regions[0].dx = 2 * motion::kMotionUnit;  // From where a sample of the square is nearest.
  evidence.carry(motion, pictureOf(0).get(), kStepNs, operations);
  EXPECT_EQ(evidence.gainOf(0), 0);
}

TEST(MotionEvidence, AChangeOfSizeOrSceneForgetsIt) {
  const Executor executor(1);
  objects::Operations operations(executor);
  objects::MotionEvidence evidence = evidenceOfSquare(operations);
  evidence.carry(motionOf(1), nullptr, kStepNs, operations);
  EXPECT_EQ(evidence.gainOf(1), 0);
  evidence.add(motionOf(1), squareGains(kGain), operations);
  evidence.reset();
  evidence.carry(motionOf(2), pictureOf(1).get(), kStepNs, operations);
  EXPECT_EQ(evidence.gainOf(1), 0);
}

}  // namespace
}  // namespace rg
