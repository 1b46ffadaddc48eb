// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/camera/camera_place.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>

namespace rg {
namespace {

constexpr Size kSize{640, 360};
constexpr int64_t kOne = CameraMotion::kOne;

int64_t part(double value) {
  return std::llround(value * kOne);
}

CameraMotion slanted() {
  return {{part(.98), part(.035), part(7.3), part(-.033), part(.985), part(-3.1), part(4e-5),
           part(-3e-5), kOne},
          {kSize.width / 2, kSize.height / 2}};
}

struct Place {
  double x, y;
};

Place before(const CameraMatrix& m, double x, double y) {
  const double w = m[6] * x + m[7] * y + m[8];
  return {(m[0] * x + m[1] * y + m[2]) / w, (m[3] * x + m[4] * y + m[5]) / w};
}

/// The unit of CameraMotion::before().
constexpr double kNearPx = .51 / 256;

TEST(CameraMatrix, TellsWhatTheCameraTells) {
  const CameraMatrix matrix = matrixOf(slanted());
  EXPECT_EQ(matrix[8], 1);
  for (const Point p :
       {Point{0, 0}, Point{639, 0}, Point{0, 359}, Point{639, 359}, Point{111, 222}}) {
    const Point was = slanted().before(p.x, p.y);
    EXPECT_NEAR(before(matrix, p.x, p.y).x, was.x / 256.0, kNearPx);
    EXPECT_NEAR(before(matrix, p.x, p.y).y, was.y / 256.0, kNearPx);
  }
}

TEST(CameraMatrix, OfAShiftHasItsNumbers) {
  EXPECT_EQ(matrixOf(CameraMotion(Point{-24, 40})), (CameraMatrix{1, 0, 1.5, 0, 1, -2.5, 0, 0, 1}));
  EXPECT_EQ(matrixOf(CameraMotion()), (CameraMatrix{1, 0, 0, 0, 1, 0, 0, 0, 1}));
}

TEST(CameraMatrix, OfNonsenseIsFinite) {
  constexpr auto kLeast = std::numeric_limits<int64_t>::min();
  constexpr auto kMost = std::numeric_limits<int64_t>::max();
  CameraMotion::Matrix all{};
  for (const int64_t value : {kLeast, kMost, int64_t{0}, -kOne}) {
    all.fill(value);
    for (const Point origin : {Point{0, 0}, Point{INT32_MIN, INT32_MAX}, Point{16384, -16384}})
      EXPECT_EQ(matrixOf({all, origin}), matrixOf({})) << value;
  }
  // Safe, but the plane's horizon crosses the frame.
  const CameraMotion horizon({kOne, 0, 0, 0, kOne, 0, part(1), part(1), kOne}, {320, 180});
  ASSERT_TRUE(horizon.isSafe());
  EXPECT_EQ(matrixOf(horizon), matrixOf(CameraMotion(horizon.at(320, 180))));
}

TEST(CameraMatrix, ChainsFromRightToLeft) {
  const CameraMatrix twice{2, 0, 0, 0, 2, 0, 0, 0, 1}, shift{1, 0, 5, 0, 1, 0, 0, 0, 1};
  EXPECT_EQ(before(chained(twice, shift), 1, 1).x, 12);
  EXPECT_EQ(before(chained(shift, twice), 1, 1).x, 7);
}

TEST(MovedCamera, IsTheSameWhereNothingMoves) {
  EXPECT_EQ(moved(slanted(), {}), slanted());
  EXPECT_EQ(moved(CameraMotion(Point{-37, 21}), wayAlong({kSize, kSize})).matrix(),
            CameraMotion(Point{-37, 21}).matrix());
}

/// The same pixels, wherever the frame has them.
TEST(MovedCamera, SeesTheSamePixelsMove) {
  const PixelWay ways[] = {{1, 0, -100, 0, 1, -50},
                           {-1, 0, 639, 0, 1, 0},
                           {0, 1, 0, 1, 0, 0},
                           {0, -1.5, 539.25, 1.5, 0, .25},
                           wayAlong({kSize, {1920, 1080}}),
                           wayAlong({kSize, {321, 97}})};
  const CameraMatrix is = matrixOf(slanted());
  for (const PixelWay& way : ways) {
    const CameraMatrix now = matrixOf(moved(slanted(), way));
    const auto there = [&](Place p) {
      return Place{way.xx * p.x + way.xy * p.y + way.x0, way.yx * p.x + way.yy * p.y + way.y0};
    };
    for (const Place p : {Place{0, 0}, Place{639, 0}, Place{0, 359}, Place{639, 359}}) {
      const Place place = there(p), was = there(before(is, p.x, p.y));
      EXPECT_NEAR(before(now, place.x, place.y).x, was.x, 1e-3) << way.xx << ' ' << way.xy;
      EXPECT_NEAR(before(now, place.x, place.y).y, was.y, 1e-3) << way.xx << ' ' << way.xy;
    }
  }
}

TEST(MovedCamera, AShiftStaysOne) {
  const CameraMotion scaled = moved(CameraMotion(Point{-37, 21}), wayAlong({kSize, {960, 270}}));
  EXPECT_TRUE(scaled.isUniform());
  EXPECT_EQ(scaled.at(5, 5), (Point{-56, 16}));
}

TEST(MovedCamera, OfNonsenseIsSafe) {
  CameraMotion::Matrix all{};
  all.fill(std::numeric_limits<int64_t>::min());
  EXPECT_EQ(moved({all, {}}, wayAlong({kSize, {1, 1}})), CameraMotion());
  for (const FrameMap& map : {FrameMap{{1, 1}, {16384, 16384}}, FrameMap{{16384, 16384}, {1, 1}},
                              FrameMap{{1, 16384}, {16384, 1}}}) {
    const CameraMotion camera = moved(slanted(), wayAlong(map));
    EXPECT_TRUE(camera.isSafe());
    for (const double number : matrixOf(camera)) EXPECT_TRUE(std::isfinite(number));
  }
}

TEST(CameraFollowed, LeadsThroughBothFrames) {
  const CameraMotion other{{part(1.02), part(-.01), part(-4.5), part(.02), part(1.01), part(6),
                            part(-2e-5), part(1e-5), kOne},
                           {100, 50}};
  const CameraMatrix all = matrixOf(followed(slanted(), other));
  for (const Point p : {Point{0, 0}, Point{639, 0}, Point{320, 180}, Point{639, 359}}) {
    const Place between = before(matrixOf(slanted()), p.x, p.y);
    const Place was = before(matrixOf(other), between.x, between.y);
    EXPECT_NEAR(before(all, p.x, p.y).x, was.x, 1e-3);
    EXPECT_NEAR(before(all, p.x, p.y).y, was.y, 1e-3);
  }
}

TEST(CameraFollowed, AfterNoMotionIsTheSame) {
  EXPECT_EQ(followed(slanted(), {}), slanted());
  EXPECT_EQ(followed(CameraMotion(Point{-37, 21}), CameraMotion(Point{5, 7})),
            CameraMotion(Point{-32, 28}));
}

TEST(CameraFollowed, WhatCanNotBeComputedWithIsAShift) {
  CameraMotion::Matrix all{};
  all.fill(std::numeric_limits<int64_t>::max());
  EXPECT_EQ(followed({all, {}}, slanted()), CameraMotion());
  EXPECT_EQ(followed(slanted(), {all, {}}), CameraMotion());
  // Twice as large again and again: beyond what numbers hold, it stays safe.
  CameraMotion zoom{{kOne / 2, 0, part(3), 0, kOne / 2, part(5), 0, 0, kOne}, {0, 0}};
  const CameraMotion step = zoom;
  const CameraMotion out{{2 * kOne, 0, 0, 0, 2 * kOne, 0, 0, 0, kOne}, {0, 0}};
  CameraMotion far;
  for (int i = 0; i < 40; ++i) {
    zoom = followed(step, zoom);
    far = followed(out, far);
    EXPECT_TRUE(zoom.isSafe());
    EXPECT_TRUE(far.isSafe());
  }
}

}  // namespace
}  // namespace rg
