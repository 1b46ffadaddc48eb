// SPDX-License-Identifier: LGPL-2.1-or-later
// Objects before a camera that zooms: what is learnt of them is learnt in pixels of other sizes.
#include "core/objects/objects.hpp"
#include "tests/core/body_scene.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace rg {
namespace {

constexpr Size kFrame{320, 240};
constexpr graph::Colour kGround{90, 90, 90}, kRed{200, 30, 30};

/// A car that drives to the right over the ground, which the camera shows `zoom` times as large.
Box carAt(int frame, double zoom) {
  const double middle = kFrame.width / 2.0;
  const auto at = [&](double ground, double axis) {
    return static_cast<int>(std::lround(axis + (ground - axis) * zoom));
  };
  const int left = at(60 + 3 * frame, middle), right = at(110 + 3 * frame, middle);
  const int top = at(100, kFrame.height / 2.0), bottom = at(130, kFrame.height / 2.0);
  return {left, top, right - left, bottom - top};
}

CameraMotion zoomedBy(double factor) {
  const auto one = static_cast<int64_t>(std::llround(double(CameraMotion::kOne) / factor));
  return {{one, 0, 0, 0, one, 0, 0, 0, CameraMotion::kOne}, {kFrame.width / 2, kFrame.height / 2}};
}

double overlap(const Box& a, const Box& b) {
  const auto common = static_cast<double>(intersect(a, b).area());
  return common / (static_cast<double>(a.area() + b.area()) - common);
}

/// The least overlap of the reported box with the car, while the camera zooms by `step` a frame
/// after twelve frames in which it did not.
double leastOverlap(double step) {
  BodyScene scene(kFrame, segmentation::Scope::Frame);
  double zoom = 1, least = 1;
  for (int frame = 0; frame < 36; ++frame) {
    const double now = frame < 12 ? 1 : step;
    const Box before = carAt(frame - 1, zoom);
    zoom *= now;
    const Box car = carAt(frame, zoom);
    scene.camera = zoomedBy(now);
    const int dx = car.x + car.width / 2 - before.x - before.width / 2;
    const auto objects = scene.show({{boundsOf(kFrame), kGround}, {car, kRed}},
                                    {{0, 0, 0, 0}, {dx * motion::kMotionUnit, 0, 0, 60}});
    if (frame < 10) continue;
    EXPECT_EQ(objects->objects.size(), 1u) << frame;
    if (objects->objects.empty()) return 0;
    EXPECT_EQ(objects->objects[0].id, 1u) << frame;
    least = std::min(least, overlap(objects->objects[0].box, car));
  }
  return least;
}

TEST(ZoomingCamera, BoxesGrowAndShrinkWithThePicture) {
  EXPECT_GE(leastOverlap(1), .85);
  EXPECT_GE(leastOverlap(1.03), .85);
  EXPECT_GE(leastOverlap(.97), .85);
}

}  // namespace
}  // namespace rg
