// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/core/body_scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace rg {
namespace {

constexpr graph::Colour kRed{200, 30, 30}, kBlue{30, 40, 200}, kGreen{30, 180, 40};

std::vector<const objects::Object*> listedOf(const objects::Objects& objects) {
  std::vector<const objects::Object*> listed;
  for (const objects::Object& object : objects.objects)
    if (objects::isListed(object.state)) listed.push_back(&object);
  return listed;
}

/// A camera that pans, and a body in two colours that walks, stands from frame 40 to 139 on, and
/// leaves. Its place over the ground is 4 px a frame.
std::shared_ptr<const objects::Objects> showStop(BodyScene& scene, int frame, bool isThere = true) {
  const int pan = frame % 40 < 20 ? frame % 20 : 20 - frame % 20;  // To and fro by a pixel a frame.
  const int panStep = frame % 40 < 20 ? 1 : -1;
  const bool isWalking = frame <= 40 || frame > 140;
  const int walked = 4 * (frame < 40 ? frame : std::max(40, frame - 100));
  const motion::RegionMotion camera{panStep * motion::kMotionUnit, 0, 0, motion::kFullReliability};
  const motion::RegionMotion walk{(panStep + (isWalking ? 4 : 0)) * motion::kMotionUnit, 0, 0,
                                  motion::kFullReliability};
  const Box coat{20 + walked + pan, 90, 24, 30}, trousers{coat.x, 120, 24, 30};
  std::vector<Body> bodies{{{0, 0, 320, 240}, kGreen}};
  if (isThere) bodies.insert(bodies.end(), {{coat, kRed}, {trousers, kBlue}});
  return scene.show(bodies, {camera, walk, walk});
}

TEST(StoppedThings, AreKeptBeforeAMovingCamera) {
  BodyScene scene({320, 240}, segmentation::Scope::Frame);
  std::shared_ptr<const objects::Objects> objects;
  for (int frame = 0; frame < 165; ++frame) {
    objects = showStop(scene, frame);
    if (frame < 20) continue;
    const auto told = listedOf(*objects);
    ASSERT_EQ(told.size(), 1u) << frame;
    EXPECT_EQ(told[0]->id, 1u) << frame;
    EXPECT_GT(told[0]->areaPx, 1200u) << frame;
    if (frame == 138) {
      EXPECT_EQ(told[0]->state, objects::ObjectState::Stopped);
      EXPECT_NEAR(told[0]->speedX, 0, 2 * objects::kPositionUnit);
    }
  }
  EXPECT_EQ(listedOf(*objects)[0]->state, objects::ObjectState::Tracked);
}

TEST(StoppedThings, AreForgottenWhenTheyAreGone) {
  BodyScene scene({320, 240}, segmentation::Scope::Frame);
  std::shared_ptr<const objects::Objects> objects;
  for (int frame = 0; frame < 140; ++frame) objects = showStop(scene, frame, frame < 80);
  EXPECT_TRUE(objects->objects.empty());
}

TEST(StoppedThings, PassersByAreNotTakenForThem) {
  BodyScene scene({320, 240}, segmentation::Scope::Frame);
  std::shared_ptr<const objects::Objects> objects;
  const motion::RegionMotion pan{motion::kMotionUnit, 0, 0, motion::kFullReliability};
  const motion::RegionMotion walk{5 * motion::kMotionUnit, 0, 0, motion::kFullReliability};
  for (int i = 0; i < 30; ++i)
    objects =
        scene.show({{{0, 0, 320, 240}, kGreen}, {{20 + 5 * i, 90, 24, 60}, kRed}}, {pan, walk});
  ASSERT_EQ(listedOf(*objects).size(), 1u);
  // Something else comes to where it stands: its colours are not seen there.
  for (int i = 0; i < 60; ++i)
    objects = scene.show({{{0, 0, 320, 240}, kGreen}, {{165 + i, 90, 24, 60}, kBlue}}, {pan, pan});
  EXPECT_TRUE(listedOf(*objects).empty());
}

}  // namespace
}  // namespace rg
