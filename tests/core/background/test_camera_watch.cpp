// SPDX-License-Identifier: LGPL-2.1-or-later
// What bgremove makes of a camera that is turned and stops again.
#include "core/motion/motion.hpp"
#include "tests/core/staged_scene.hpp"

#include <cmath>
#include <vector>

namespace rg {
namespace {

using background::Camera;
using background::SceneEvent;
using test::marksOf;
using test::StagedScene;
using test::Take;
using test::Texture;
using test::walkerAt;

StagedScene watched(Texture texture, uint32_t seed, Camera camera = Camera::Auto) {
  background::Params params;
  params.camera = camera;
  return StagedScene({texture, 3, seed}, params);
}

/// A walker whom the camera has in view wherever it looks.
Take takeFrom(Point push, int step) {
  Box walker = walkerAt(step % 60);
  walker.x += push.x;
  walker.y += push.y;
  return {walker, 100, push, false};
}

struct Told {
  int startedAt = -1, stoppedAt = -1, others = 0;
};

class CameraTurns : public ::testing::TestWithParam<std::tuple<Texture, Point>> {};
INSTANTIATE_TEST_SUITE_P(Speeds, CameraTurns,
                         ::testing::Combine(::testing::Values(Texture::Tiles, Texture::Stone),
                                            ::testing::Values(Point{1, 0}, Point{-3, 2},
                                                              Point{0, -6}, Point{12, 4})));

TEST_P(CameraTurns, ItIsToldWhenThatBeginsAndEndsAndThenThingsAreFound) {
  const auto [texture, speed] = GetParam();
  constexpr int kStart = 60, kStop = 100, kEnd = 200, kLearnt = 50;
  StagedScene scene = watched(texture, 7);
  Told told;
  Point push;
  for (int frame = 0; frame < kEnd; ++frame) {
    SCOPED_TRACE(frame);
    if (frame > kStart && frame <= kStop) push = {push.x + speed.x, push.y + speed.y};
    const auto seen = scene.show(takeFrom(push, frame));
    const SceneEvent event = seen->scene.event;
    if (event == SceneEvent::CameraStarted) told.startedAt = frame;
    if (event == SceneEvent::CameraStopped) told.stoppedAt = frame;
    told.others += event != SceneEvent::None && event != SceneEvent::CameraStarted &&
                   event != SceneEvent::CameraStopped && event != SceneEvent::CameraShaken;
    const bool isMoving = told.startedAt >= 0 && told.stoppedAt < 0;
    ASSERT_EQ(seen->scene.isCameraMoving, isMoving);
    if (isMoving) {
      EXPECT_EQ(seen->scene.foregroundPx, 0u);
      ASSERT_TRUE(seen->cameraSince);
      if (frame <= kStop) {
        const Point by = seen->camera.at(80, 60);
        EXPECT_NEAR(by.x, -speed.x * motion::kMotionUnit, 8);
        EXPECT_NEAR(by.y, -speed.y * motion::kMotionUnit, 8);
      }
    } else {
      EXPECT_FALSE(seen->cameraSince);
    }
    if (frame == kStart || frame == kEnd - 1) {
      const auto marks = marksOf(*seen, walkerAt(frame % 60));
      EXPECT_GE(marks.foundPercent, 80);
      EXPECT_LT(marks.falsePercent, 2);
    }
  }
  // What goes by a pixel a frame is followed for as long as a push might be.
  EXPECT_GT(told.startedAt, kStart);
  EXPECT_LE(told.startedAt, kStart + 20);
  EXPECT_GE(told.stoppedAt, kStop + 25);
  EXPECT_LE(told.stoppedAt, kStop + 25 + 4);
  EXPECT_EQ(told.others, 0);
  EXPECT_LE(told.stoppedAt + kLearnt, kEnd);
}

TEST(CameraWatch, ATurnIsToldWithoutAModelToo) {
  StagedScene scene = watched(Texture::Stone, 3);
  int startedAt = -1;
  for (int frame = 0; frame < 20; ++frame) {
    const auto seen = scene.show(takeFrom({3 * frame, 0}, frame));
    if (seen->scene.event == SceneEvent::CameraStarted) startedAt = frame;
  }
  EXPECT_GE(startedAt, 1);
  EXPECT_LE(startedAt, 3);
}

TEST(CameraWatch, ACameraThatSwaysOrIsPushedStandsStill) {
  for (const Texture texture : {Texture::Tiles, Texture::Stone, Texture::Ramp, Texture::Stripes}) {
    StagedScene scene = watched(texture, 5);
    for (int frame = 0; frame < 150; ++frame) {
      const Point push{static_cast<int>(std::lround(2 * std::sin(frame * .9))),
                       static_cast<int>(std::lround(2 * std::sin(frame * .6 + 1)))};
      const auto seen = scene.show(takeFrom(push, frame));
      EXPECT_FALSE(seen->scene.isCameraMoving) << static_cast<int>(texture) << ' ' << frame;
    }
  }
}

TEST(CameraWatch, WhatIsAskedForNeedsNoLook) {
  StagedScene still = watched(Texture::Stone, 1, Camera::Still);
  StagedScene moving = watched(Texture::Stone, 1, Camera::Moving);
  for (int frame = 0; frame < 40; ++frame) {
    const Take take = takeFrom({4 * frame, 0}, frame);
    EXPECT_FALSE(still.show(take)->scene.isCameraMoving);
    const auto seen = moving.show(take);
    EXPECT_TRUE(seen->scene.isCameraMoving);
    EXPECT_EQ(seen->status, Status::Ok);
    EXPECT_EQ(seen->scene.foregroundPx, 0u);
    EXPECT_EQ(seen->scene.event, SceneEvent::None);
  }
}

/// A scene whose camera has been told to move.
StagedScene turning(Point& push, int& frame) {
  StagedScene scene = watched(Texture::Stone, 9);
  for (; frame < 60; ++frame) scene.show(takeFrom(push, frame));
  for (; frame < 75; ++frame) {
    push.x += 4;
    scene.show(takeFrom(push, frame));
  }
  EXPECT_TRUE(scene.show(takeFrom({push.x += 4, 0}, frame++))->scene.isCameraMoving);
  return scene;
}

TEST(CameraWatch, WhatSwaysAfterATurnStandsStill) {
  Point push;
  int frame = 0, stoppedAt = -1;
  StagedScene scene = turning(push, frame);
  const int last = frame + 100;
  for (; frame < last; ++frame) {
    const Point sway{push.x + static_cast<int>(std::lround(2 * std::sin(frame * .9))), 0};
    if (scene.show(takeFrom(sway, frame))->scene.event == SceneEvent::CameraStopped)
      stoppedAt = frame;
  }
  EXPECT_GE(stoppedAt, last - 100 + 70);
  EXPECT_LE(stoppedAt, last - 100 + 80);
}

TEST(CameraWatch, WhoAsksForAStillCameraInATurnGetsANewModel) {
  for (const Camera camera : {Camera::Still, Camera::Moving}) {
    Point push;
    int frame = 0, stops = 0;
    StagedScene scene = turning(push, frame);
    scene.params().camera = camera;
    auto seen = scene.show(takeFrom(push, frame++));
    stops += seen->scene.event == SceneEvent::CameraStopped;
    EXPECT_EQ(seen->scene.isCameraMoving, camera == Camera::Moving);
    scene.params().camera = Camera::Auto;
    for (int i = 0; i < 40; ++i) {
      seen = scene.show(takeFrom(push, frame++));
      stops += seen->scene.event == SceneEvent::CameraStopped;
      EXPECT_FALSE(seen->scene.isCameraMoving);
      EXPECT_LT(marksOf(*seen, {}).falsePercent, 12) << i;
    }
    EXPECT_EQ(stops, 1);
  }
}

TEST(CameraWatch, DarknessInATurnIsDarkness) {
  Point push;
  int frame = 0;
  StagedScene scene = turning(push, frame);
  Take dark = takeFrom(push, frame);
  dark.gainPercent = 0;
  std::shared_ptr<const background::Foreground> seen;
  for (int i = 0; i < 60; ++i) seen = scene.show(dark);
  EXPECT_TRUE(seen->scene.isDark);
  EXPECT_FALSE(seen->scene.isCameraMoving);
  EXPECT_EQ(seen->scene.foregroundPx, 0u);
  seen = scene.show(takeFrom(push, frame++));
  EXPECT_EQ(seen->scene.event, SceneEvent::BrightAgain);
  for (int i = 0; i < 30; ++i) seen = scene.show(takeFrom(push, frame++));
  const auto marks = marksOf(*seen, walkerAt((frame - 1) % 60));
  EXPECT_GE(marks.foundPercent, 60);
  EXPECT_LT(marks.falsePercent, 3);
}

TEST(CameraWatch, AGapSaysNothingOfTheCamera) {
  Point push;
  int frame = 0;
  StagedScene scene = turning(push, frame);
  for (int i = 0; i < 60; ++i) {
    scene.breakOff();
    EXPECT_TRUE(scene.show(takeFrom({push.x += 4, 0}, frame++))->scene.isCameraMoving) << i;
  }
}

/// Slower than what sways, and for longer than a second.
TEST(CameraWatch, WhatAddsUpByChanceIsNoTurn) {
  background::Params params;
  params.camera = Camera::Auto;
  params.trainingFrames = 2000;
  StagedScene scene({Texture::Stone, 3, 2}, params);
  for (int frame = 0; frame < 120; ++frame)
    EXPECT_FALSE(scene.show(takeFrom({frame / 30, 0}, frame))->scene.isCameraMoving) << frame;
}

TEST(CameraWatch, OfAStillCameraNothingChanges) {
  StagedScene still = watched(Texture::Tiles, 4, Camera::Still);
  StagedScene autoScene = watched(Texture::Tiles, 4);
  for (int frame = 0; frame < 120; ++frame) {
    Take take = takeFrom({}, frame);
    if (frame >= 80) take.gainPercent = 50;
    const auto a = still.show(take), b = autoScene.show(take);
    ASSERT_EQ(a->scene.event, b->scene.event) << frame;
    for (int y = 0; y < a->size.height; ++y)
      ASSERT_TRUE(std::equal(a->mask.row(y), a->mask.row(y) + a->size.width, b->mask.row(y)));
  }
}

}  // namespace
}  // namespace rg
