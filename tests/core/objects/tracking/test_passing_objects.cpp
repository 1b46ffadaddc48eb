// SPDX-License-Identifier: LGPL-2.1-or-later
// Objects that touch from the first frame on, and what their motion says of them.
#include "core/objects/objects.hpp"
#include "tests/core/body_scene.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace rg {
namespace {

constexpr graph::Colour kRed{200, 30, 30}, kBlue{30, 40, 200}, kGrey{120, 120, 120};

motion::RegionMotion moving(int dx) {
  return {dx * motion::kMotionUnit, 0, 0, 60};
}

double overlap(const Box& a, const Box& b) {
  const auto common = static_cast<double>(intersect(a, b).area());
  return common / (static_cast<double>(a.area() + b.area()) - common);
}

std::vector<Box> toldOf(const objects::Objects& objects) {
  std::vector<Box> told;
  for (const objects::Object& object : objects.objects)
    if (objects::isListed(object.state)) told.push_back(object.box);
  return told;
}

TEST(PassingObjects, TwoWhoTouchFromTheFirstFrameOnPartByTheirMotion) {
  BodyScene scene;
  for (int i = 0; i < 6; ++i) {
    const Box left{150 - 3 * i, 40, 40, 60}, right{110 + 3 * i, 70, 44, 60};
    ASSERT_GT(right.right(), left.x);
    const auto objects = scene.show({{left, kRed}, {right, kBlue}}, {moving(-3), moving(3)});
    ASSERT_EQ(objects->objects.size(), 2u) << i;
    EXPECT_GE(overlap(objects->objects[0].box, right), 0.9) << i;
    EXPECT_GE(overlap(objects->objects[1].box, left), 0.9) << i;
  }
}

TEST(PassingObjects, TwoWhoTouchAndMoveAlikeAreOne) {
  BodyScene scene;
  for (int i = 0; i < 6; ++i) {
    const Box left{150 - 3 * i, 40, 40, 60}, right{110 - 3 * i, 70, 44, 60};
    const auto objects = scene.show({{left, kRed}, {right, kBlue}}, {moving(-3), moving(-3)});
    EXPECT_EQ(objects->objects.size(), 1u) << i;
  }
}

TEST(PassingObjects, WhatAWalkerUncoversIsNotTold) {
  BodyScene scene;
  const Box first{40, 60, 50, 120};
  for (int i = 0; i < 20; ++i) {
    const Box walker{40 + 5 * i, 60, 50, 120};
    const auto told = toldOf(*scene.show({{first, kGrey}, {walker, kRed}}, {moving(0), moving(5)}));
    if (i < 12) continue;
    ASSERT_EQ(told.size(), 1u) << i;
    EXPECT_GE(overlap(told[0], walker), 0.6) << i;
  }
}

TEST(PassingObjects, LegsThatStandDoNotPartABody) {
  BodyScene scene;
  for (int i = 0; i < 30; ++i) {
    const int x = 40 + 5 * i, step = i / 5 * 25;  // A foot stands for five frames.
    const auto told =
        toldOf(*scene.show({{{x, 60, 40, 70}, kRed}, {{52 + step, 130, 20, 60}, kBlue}},
                           {moving(5), moving(i % 5 == 0 ? 25 : 0)}));
    EXPECT_LE(told.size(), 1u) << i;
    if (i >= 15) {
      ASSERT_EQ(told.size(), 1u);
      EXPECT_GE(overlap(told[0], {x, 60, 40, 130}), 0.6) << i;
    }
  }
}

TEST(PassingObjects, WhatIsKnownByItsPortraitIsNotPartedByWrongVectors) {
  BodyScene scene;
  for (int i = 0; i < 45; ++i) {
    const Box rear{20 + 4 * i, 60, 40, 50}, front{60 + 4 * i, 60, 40, 50};
    const int wrong = i < 25 ? 0 : 6;
    const auto told =
        toldOf(*scene.show({{rear, kRed}, {front, kBlue}}, {moving(4 - wrong), moving(4 + wrong)}));
    if (i < 20) continue;
    ASSERT_EQ(told.size(), 1u) << i;
    EXPECT_GE(overlap(told[0], {20 + 4 * i, 60, 80, 50}), 0.9) << i;
  }
}

TEST(PassingObjects, WhatIsHiddenBeforeItsSizeIsKnownIsNotGuessedAt) {
  for (const bool keepsItsSize : {true, false}) {
    BodyScene scene;
    for (int i = 0; i < 30; ++i) {
      const int wider = keepsItsSize ? 0 : 20 * (i % 2);
      const Box body{40 + 4 * i - wider, 60, 40 + 2 * wider, 90};
      scene.show({{body, kRed}}, {moving(4)});
    }
    EXPECT_EQ(toldOf(*scene.show({})).size(), keepsItsSize ? 1u : 0u);
  }
}

TEST(PassingObjects, WhatLeavesSoonAfterItWasFoundKeepsItsSize) {
  BodyScene scene;
  for (int i = 0; i < 10; ++i) {
    const Box walker{255 + 5 * i, 60, 50, 60};
    const auto told = toldOf(*scene.show({{walker, kRed}}, {moving(5)}));
    if (i < 6) continue;
    ASSERT_EQ(told.size(), 1u) << i;
    EXPECT_GE(overlap(told[0], walker), 0.85) << i;
  }
}

TEST(PassingObjects, WhatOnlyGetsSmallerAtTheBorderIsNotTold) {
  BodyScene scene;
  for (int i = 0; i < 30; ++i) {
    const int left = 290 + i;  // Its height shrinks, too, as that of a leg that is drawn after.
    const auto told =
        toldOf(*scene.show({{{left, 60 + 3 * i, 60, 120 - 3 * i}, kRed}}, {moving(1)}));
    EXPECT_TRUE(told.empty()) << i;
  }
}

}  // namespace
}  // namespace rg
