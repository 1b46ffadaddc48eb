// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/camera/camera_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <vector>

namespace rg {
namespace {

struct Place {
  double x, y;
};
using Way = std::function<Place(double, double)>;

Place zoomedAndRolled(double x, double y) {
  constexpr double kScale = .98, kAngle = .035;
  return {kScale * (x * std::cos(kAngle) - y * std::sin(kAngle)) + .02,
          kScale * (x * std::sin(kAngle) + y * std::cos(kAngle)) - .01};
}

/// 16 x 9 samples in the frame; `stray` tells which move otherwise.
std::vector<CameraSample> samplesOf(const Way& before,
                                    const std::function<bool(int, int)>& stray = {}) {
  std::vector<CameraSample> samples;
  for (int row = 0; row < 9; ++row)
    for (int column = 0; column < 16; ++column) {
      const double x = (column - 7.5) / 9, y = (row - 4) / 9.0;
      Place was = before(x, y);
      if (stray && stray(column, row)) was = {was.x - .2, was.y + .05};
      samples.push_back({x, y, was.x, was.y, 1e-6, 0, 1e-6});
    }
  return samples;
}

CameraFit fit(const std::vector<CameraSample>& samples) {
  CameraFitScratch scratch;
  return fitCamera(samples, {.004, {}, true}, scratch);
}

double missAtCorner(const CameraModel& m, const Way& before) {
  const double x = .8, y = .45, w = m.g * x + m.h * y + 1;
  const Place is = before(x, y);
  return std::hypot((m.a * x + m.b * y + m.c) / w - is.x, (m.d * x + m.e * y + m.f) / w - is.y);
}

TEST(CameraFit, FindsZoomAndRoll) {
  const CameraFit found = fit(samplesOf(zoomedAndRolled));
  EXPECT_LT(missAtCorner(found.model, zoomedAndRolled), .0005);
  EXPECT_GT(found.explained, .9);
}

TEST(CameraFit, AThirdThatMovesOtherwiseChangesLittle) {
  const auto third = [](int column, int) { return column >= 5 && column < 11; };
  const CameraFit found = fit(samplesOf(zoomedAndRolled, third));
  EXPECT_LT(missAtCorner(found.model, zoomedAndRolled), .001);
  EXPECT_LT(found.explained, .8);
}

TEST(CameraFit, SupportsNoMoreFreedomThanIsSeen) {
  EXPECT_TRUE(isShift(fit(samplesOf([](double x, double y) {
                        return Place{x + .05, y - .02};
                      })).model));
  const CameraModel still = fit(samplesOf([](double x, double y) { return Place{x, y}; })).model;
  EXPECT_EQ(still.c, 0);
  EXPECT_EQ(still.f, 0);
}

/// A sample on an edge knows its motion across it only.
TEST(CameraFit, TakesEachDirectionForItself) {
  std::vector<CameraSample> samples = samplesOf([](double x, double y) {
    return Place{x + .05, y - .02};
  });
  for (size_t i = 0; i < samples.size(); ++i) {
    CameraSample& s = samples[i];
    if (i % 2 == 0) {
      s.px += .003 * double(i % 7);
      s.xx = 1;
    } else {
      s.py += .003 * double(i % 5);
      s.yy = 1;
    }
  }
  const CameraModel model = fit(samples).model;
  EXPECT_NEAR(model.c, .05, .0005);
  EXPECT_NEAR(model.f, -.02, .0005);
}

TEST(CameraFit, WithoutSamplesThereIsNoMotion) {
  EXPECT_TRUE(isShift(fit({}).model));
  EXPECT_EQ(fit({}).votes, 0);
}

TEST(CameraFit, IsTheSameMotionFromAnyOrigin) {
  const CameraModel model{.98, .03, .02, -.03, .98, -.01, .002, -.001};
  const CameraFrame frame = CameraFrame::of({640, 360});
  const CameraMotion motion = motionOf(model, frame);
  ASSERT_TRUE(motion.isSafe());
  for (const Point at : {Point{0, 0}, Point{320, 180}, Point{639, 359}}) {
    const double x = (at.x - frame.middleX) / frame.half, y = (at.y - frame.middleY) / frame.half;
    const double w = model.g * x + model.h * y + 1;
    const double px = (model.a * x + model.b * y + model.c) / w * frame.half + frame.middleX;
    const double py = (model.d * x + model.e * y + model.f) / w * frame.half + frame.middleY;
    EXPECT_NEAR(motion.before(at.x, at.y).x / 256.0, px, .01);
    EXPECT_NEAR(motion.before(at.x, at.y).y / 256.0, py, .01);
  }
}

}  // namespace
}  // namespace rg
