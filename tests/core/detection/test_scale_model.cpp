// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/detection/scale_model.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace rg::detection {
namespace {

// The set of windows that comes nearest to the printed equation (2): 25 px windows of 1.05 times
// the size from scale to scale, an eighth of their side apart, in a frame of 460x480.
const PaperWindows kNearest{{460, 480}, 25, 1.0 / 8, 1.05, 1.05};
constexpr uint64_t kStride = 293;  // 600 of the windows.

std::vector<PaperScale> scalesOf(const PaperWindows& windows) {
  auto scales = paperScalesOf(windows);
  EXPECT_TRUE(scales);
  return scales ? *std::move(scales) : std::vector<PaperScale>();
}

TEST(ScaleModel, TheNearestSetHasAsManyWindowsAsThePoleAllows) {
  const auto scales = scalesOf(kNearest);
  ASSERT_EQ(scales.size(), 57u);
  EXPECT_EQ(scales.back().firstId + scales.back().count, 176'093u);
  EXPECT_NEAR(kPrintedModel.pole(), 176'894, 1);
}

TEST(ScaleModel, ThePrintedFitIsReproduced) {
  const auto scales = scalesOf(kNearest);
  EXPECT_NEAR(rSquared(kPrintedModel, sample(scales, kStride)), .9963, .0001);
  EXPECT_NEAR(rSquared(kPrintedModel, sample(scales, 1)), .9948, .0001);
}

TEST(ScaleModel, ARefitIsBetterThanThePrintedOne) {
  const auto samples = sample(scalesOf(kNearest), kStride);
  const ScaleModel fitted = refit(kPrintedModel, samples);
  EXPECT_NEAR(rSquared(fitted, samples), .9990, .0001);
  EXPECT_NEAR(fitted.n0, 1.0471, .001);
  EXPECT_NEAR(fitted.d1, -1.0531e-5, 1e-8);
}

TEST(ScaleModel, ARefitFindsTheModelThatMadeTheSamples) {
  const ScaleModel truth{1.2, -8e-6, 2e-11, -9e-6, 2.5e-11};
  std::vector<ScaleSample> samples;
  for (int id = 0; id < 120'000; id += 1000)
    samples.push_back({static_cast<double>(id), truth.at(id)});
  const ScaleModel fitted = refit(kPrintedModel, samples);
  for (const ScaleSample& s : samples) EXPECT_NEAR(fitted.at(s.id), s.scale, 1e-6);
}

/// Where the printed equation breaks: behind its pole, and for any other set of windows.
TEST(ScaleModel, ThePrintedEquationSaysNothingBehindItsPole) {
  EXPECT_NEAR(kPrintedModel.at(0), 1.08, 1e-9);
  EXPECT_NEAR(kPrintedModel.at(170'000), 3.86, .01);
  EXPECT_NEAR(kPrintedModel.at(180'000), 1.45, .01);
  EXPECT_LT(kPrintedModel.at(210'000), 0);
  const auto others = sample(scalesOf({{640, 480}, 24, 1.0 / 12, 1.1, 1.1}), 101);
  EXPECT_LT(rSquared(kPrintedModel, others), 0);
  EXPECT_GT(rSquared(refit({1, 0, 0, 0, 0}, others), others), 0);
}

TEST(ScaleModel, PolesAreTheFirstBehindZero) {
  EXPECT_DOUBLE_EQ((ScaleModel{1, 0, 0, -.5, 0}).pole(), 2);
  EXPECT_DOUBLE_EQ((ScaleModel{1, 0, 0, -3, 2}).pole(), .5);
  EXPECT_DOUBLE_EQ((ScaleModel{1, 0, 0, 0, -.25}).pole(), 2);
  EXPECT_TRUE(std::isinf((ScaleModel{1, 0, 0, .5, 0}).pole()));
  EXPECT_TRUE(std::isinf((ScaleModel{1, 0, 0, 0, 1}).pole()));
}

TEST(ScaleModel, WhatCanNotBeIsAnError) {
  EXPECT_FALSE(paperScalesOf({{0, 480}, 25, .125}));
  EXPECT_FALSE(paperScalesOf({{460, 480}, 25, 0}));
  EXPECT_FALSE(paperScalesOf({{460, 480}, 25, .125, 1, 1}));
}

}  // namespace
}  // namespace rg::detection
