// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/motion/matched_blocks.hpp"
#include "core/motion/refinement/motion_fit.hpp"
#include "tests/core/scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace rg {
namespace {

using namespace scenes;

TEST(FitSums, CountsByHand) {
  // Columns 0 10 20 … : every gradient is 20 along x; a shift of half a pixel leaves 5 levels.
  const auto ramp = paintGrey({24, 12}, [](int x, int) { return 10 * x; });
  motion::PaddedLuma previous;
  previous.build(ramp->luma(), 2, Executor(1));
  const motion::FitSums sums = motion::sumFit({8, 0, 0b1100}, ramp->luma(), previous,
                                              {motion::kFine / 2, 0}, 6 * motion::kFine);
  EXPECT_EQ(sums.seen, 8);
  EXPECT_EQ(sums.pixels, 8);
  EXPECT_EQ(sums.x, 8 * 20);
  EXPECT_EQ(sums.xx, 8 * 400);
  EXPECT_EQ(sums.yy, 0);
  EXPECT_EQ(sums.r, 8 * 5 * motion::kFine);
  EXPECT_EQ(sums.xr, 8 * 20 * 5 * motion::kFine);
  EXPECT_EQ(sums.rr, 8 * 80 * 80);
  EXPECT_EQ(sums.misfit, 8 * 5 * motion::kFine);
}

TEST(FitSums, LeavesOutWhatFitsWorseThanTheLimit) {
  const auto ramp = paintGrey({24, 12}, [](int x, int) { return 10 * x; });
  motion::PaddedLuma previous;
  previous.build(ramp->luma(), 2, Executor(1));
  const motion::FitSums sums = motion::sumFit({8, 0, 0b1100}, ramp->luma(), previous,
                                              {motion::kFine / 2, 0}, 4 * motion::kFine);
  EXPECT_EQ(sums.seen, 8);
  EXPECT_EQ(sums.pixels, 0);
  EXPECT_EQ(sums.misfit, 8 * 4 * motion::kFine);
}

TEST(FitSums, TheFramesEdgeHasNoGradient) {
  const auto ramp = paintGrey({8, 8}, [](int x, int) { return 10 * x; });
  motion::PaddedLuma previous;
  previous.build(ramp->luma(), 1, Executor(1));
  EXPECT_EQ(motion::sumFit({0, 0, 0xFFFF}, ramp->luma(), previous, {}, motion::kFine).seen, 6 * 6);
}

TEST(MotionFit, SolvesTwoEquations) {
  const motion::Step step = motion::solveStep(4, 2, 3, {4 * 7 + 2 * -5, 2 * 7 + 3 * -5});
  EXPECT_EQ(step.x, 7);
  EXPECT_EQ(step.y, -5);
  EXPECT_EQ(motion::solveStep(4, 2, 1, {4, 2}).x, 0);
  const int64_t huge = int64_t{1} << 45;
  EXPECT_EQ(motion::solveStep(huge, 0, huge, {9 * huge, -3 * huge}).x, 9);
}

TEST(MotionFit, TheLeastInformationIsThatAcrossAnEdge) {
  EXPECT_EQ(motion::leastInformation({900, 0, 25}), 25);
  EXPECT_EQ(motion::leastInformation({450, 450, 450}), 0);
  EXPECT_EQ(motion::leastInformation({500, 300, 500}), 200);
}

double hills(double x, double y) {
  return 128 + 50 * std::sin(x * 0.4 + 1) * std::cos(y * 0.37) + 30 * std::sin(x * 0.13 - y * 0.3);
}

// The picture turns and shifts; textured is the left part only, so that a shift alone would be off.
TEST(MotionFit, FindsTheVectorAtTheCentroidOfATurningRegion) {
  const Size size{96, 96};
  const double turn = 0.02, shiftX = 1.5, shiftY = -0.75;
  const auto contrast = [](double x) { return 0.1 + 0.9 / (1 + std::exp((x - 48) / 4)); };
  const auto before = paintGrey(
      size, [&](int x, int y) { return std::lround(128 + (hills(x, y) - 128) * contrast(x)); });
  const auto now = paintGrey(size, [&](int x, int y) {
    const double u = shiftX - turn * (y - 48), v = shiftY + turn * (x - 48);
    return std::lround(128 + (hills(x - u, y - v) - 128) * contrast(x - u));
  });
  motion::PaddedLuma previous;
  previous.build(before->luma(), 8, Executor(1));
  const auto labels =
      label(now, 1, [](int x, int y) { return x >= 16 && x < 80 && y >= 16 && y < 80 ? 1 : 0; });
  motion::MatchedBlocks blocks;
  blocks.find(**graph::makeStage(contextWith(1))->process(labels, {}), Executor(1));
  const motion::FitRegion fitted{
      blocks.partsOf(segmentation::RegionLabel::ofIndex(0)), {48, 48}, 40 * motion::kFine};
  motion::MotionFit start;
  start.at = {2 * motion::kFine, -motion::kFine};
  const motion::MotionFit fit = motion::fitMotion(fitted, {now->luma(), &previous}, start, {}, 6);
  EXPECT_NEAR(fit.at.x, shiftX * motion::kFine, 0.08 * motion::kFine);
  EXPECT_NEAR(fit.at.y, shiftY * motion::kFine, 0.08 * motion::kFine);
  EXPECT_NEAR(fit.slopes[1], -turn * motion::kFine * motion::kSlopeUnitPx, 0.1 * motion::kFine);
  EXPECT_NEAR(fit.slopes[2], turn * motion::kFine * motion::kSlopeUnitPx, 0.1 * motion::kFine);
}

TEST(MotionFit, APriorDecidesAlongAnEdge) {
  const auto edge = [](int shift) {
    return paintGrey(
        {64, 64}, [=](int x, int) { return std::lround(128 + 60 * std::sin((x - shift) * 0.3)); });
  };
  const auto now = edge(2);
  motion::PaddedLuma previous;
  previous.build(edge(0)->luma(), 8, Executor(1));
  const auto labels =
      label(now, 1, [](int x, int y) { return x > 11 && x < 52 && y > 11 && y < 52 ? 1 : 0; });
  motion::MatchedBlocks blocks;
  blocks.find(**graph::makeStage(contextWith(1))->process(labels, {}), Executor(1));
  const motion::FitRegion fitted{
      blocks.partsOf(segmentation::RegionLabel::ofIndex(0)), {32, 32}, 40 * motion::kFine};
  motion::MotionFit start;
  start.at = {2 * motion::kFine, 0};
  const motion::MotionPrior prior{{5 * motion::kFine, motion::kFine}, 4 * 256};
  const motion::MotionFit fit =
      motion::fitMotion(fitted, {now->luma(), &previous}, start, prior, 4);
  EXPECT_NEAR(fit.at.x, 2 * motion::kFine, 0.1 * motion::kFine);
  EXPECT_GT(fit.at.y, 0);
  EXPECT_EQ(motion::leastInformation(fit.information), 0);
}

}  // namespace
}  // namespace rg
