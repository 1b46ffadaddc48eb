// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/merge/mrf_merge.hpp"
#include "tests/core/body_scene.hpp"

#include <gtest/gtest.h>

namespace rg {
namespace {

constexpr graph::Colour kRed{200, 30, 30}, kBlue{30, 40, 200}, kGround{90, 110, 90};
constexpr objects::Params kLiteral{.method = objects::Method::Literal};

motion::RegionMotion moving(int dxPx, int dyPx = 0) {
  return {dxPx * motion::kMotionUnit, dyPx * motion::kMotionUnit, 0, motion::kFullReliability};
}

bool isOneGroup(const objects::Objects& objects, size_t a, size_t b) {
  return objects.regionGroup[a] == objects.regionGroup[b];
}

TEST(LiteralMerge, TheEnergyOfThisFrameAloneDecides) {
  BodyScene scene;
  scene.params = kLiteral;
  const auto show = [&](int time, int legs) {
    const int x = 40 + 2 * time;
    return scene.show({{{x, 60, 24, 40}, kRed}, {{x, 100, 24, 40}, kBlue}},
                      {moving(2), moving(legs)});
  };
  for (int time = 0; time < 30; ++time) EXPECT_TRUE(isOneGroup(*show(time, 2), 0, 1)) << time;
  const auto parted = show(30, -12);
  EXPECT_FALSE(isOneGroup(*parted, 0, 1)) << "thirty frames together don't count";
  ASSERT_EQ(parted->arcs.size(), 1u);
  EXPECT_LT(parted->arcs[0].weight(), 0);
  EXPECT_TRUE(isOneGroup(*show(31, 2), 0, 1));
}

TEST(LiteralMerge, TheLargestGroupIsTheBackgroundAndItsMotionTheCameras) {
  BodyScene scene({320, 240}, segmentation::Scope::Frame);
  scene.params = kLiteral;
  std::shared_ptr<const objects::Objects> objects;
  for (int time = 0; time < 20; ++time)
    objects = scene.show({{{0, 0, 320, 240}, kGround}, {{60 + 5 * time, 80, 40, 60}, kRed}},
                         {moving(-1), moving(5)});
  ASSERT_EQ(objects->regionGroup.size(), 2u);
  EXPECT_EQ(objects->groundGroup, objects->regionGroup[0]);
  EXPECT_EQ(objects->cameraDx, -motion::kMotionUnit);
  EXPECT_TRUE(objects->ground.empty());
  ASSERT_EQ(objects->objects.size(), 1u);
  EXPECT_EQ(objects->slots.at(175, 100), 1);
  EXPECT_EQ(objects->slots.at(10, 10), 0);
}

TEST(LiteralMerge, AThingThatFillsTheFrameIsTakenForTheBackground) {
  BodyScene scene({320, 240}, segmentation::Scope::Frame);
  scene.params = kLiteral;
  const auto objects =
      scene.show({{{0, 0, 320, 240}, kGround}, {{20, 20, 280, 200}, kRed}}, {moving(0), moving(6)});
  EXPECT_EQ(objects->groundGroup, objects->regionGroup[1]);
  EXPECT_EQ(objects->cameraDx, 6 * motion::kMotionUnit);
}

TEST(LiteralMerge, WhatHasNoRegionIsTheBackgroundWhereItIsMore) {
  BodyScene scene;
  scene.params = kLiteral;
  std::shared_ptr<const objects::Objects> objects;
  for (int time = 0; time < 20; ++time)
    objects = scene.show({{{40 + 4 * time, 100, 24, 60}, kRed}}, {moving(4)});
  EXPECT_FALSE(objects->groundGroup);
  EXPECT_EQ(objects->cameraDx, 0);
  ASSERT_EQ(objects->objects.size(), 1u);
  EXPECT_EQ(objects->objects[0].areaPx, 24u * 60);
}

TEST(LiteralMerge, MayChangeFromFrameToFrame) {
  for (const auto scope : {segmentation::Scope::Frame, segmentation::Scope::Foreground}) {
    BodyScene scene({320, 240}, scope);
    for (int time = 0; time < 24; ++time) {
      scene.params.method =
          time / 3 % 2 == 0 ? objects::Method::Extended : objects::Method::Literal;
      const auto objects =
          scene.show({{{0, 0, 320, 240}, kGround}, {{40 + 5 * time, 80, 40, 60}, kRed}},
                     {moving(0), moving(5)});
      ASSERT_EQ(objects->regionGroup.size(), 2u);
      if (scene.params.method == objects::Method::Literal) {
        EXPECT_FALSE(isOneGroup(*objects, 0, 1));
      }
    }
  }
}

TEST(LargestGroup, OfEqualOnesTheFirst) {
  std::vector<objects::Group> groups(3);
  groups[0].areaPx = 20;
  groups[1].areaPx = groups[2].areaPx = 30;
  EXPECT_EQ(objects::largestGroup(groups, {10, 8}), objects::GroupIndex::ofIndex(1));
  EXPECT_EQ(objects::largestGroup(groups, {10, 11}), objects::GroupIndex::ofIndex(1));
  EXPECT_FALSE(objects::largestGroup(groups, {10, 12}));
  EXPECT_FALSE(objects::largestGroup({}, {10, 12}));
}

}  // namespace
}  // namespace rg
