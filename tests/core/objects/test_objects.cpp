// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/objects.hpp"
#include "tests/core/body_scene.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>

namespace rg {
namespace {

using testing::IsEmpty;

constexpr graph::Colour kRed{200, 30, 30}, kBlue{30, 40, 200}, kGreen{30, 180, 40};

bool isTold(const objects::Object& object) {
  return object.state == objects::ObjectState::Tracked ||
         object.state == objects::ObjectState::Stopped;
}

std::vector<const objects::Object*> toldOf(const objects::Objects& objects) {
  std::vector<const objects::Object*> told;
  for (const objects::Object& object : objects.objects)
    if (isTold(object)) told.push_back(&object);
  return told;
}

int countEvents(const objects::Objects& objects, objects::EventKind kind) {
  return static_cast<int>(
      std::count_if(objects.events.begin(), objects.events.end(),
                    [&](const objects::Event& event) { return event.kind == kind; }));
}

double overlap(const Box& a, const Box& b) {
  const auto common = static_cast<double>(intersect(a, b).area());
  return common / (static_cast<double>(a.area() + b.area()) - common);
}

TEST(Objects, AMovingBodyIsOneObjectWithItsBoxAndSpeed) {
  BodyScene scene;
  std::shared_ptr<const objects::Objects> objects;
  int begun = 0;
  for (int i = 0; i < 40; ++i) {
    objects = scene.show({{{40 + 4 * i, 100, 24, 60}, kRed}});
    begun += countEvents(*objects, objects::EventKind::ObjectNew);
  }
  const auto told = toldOf(*objects);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(begun, 1);
  EXPECT_EQ(told[0]->id, 1u);
  EXPECT_GE(overlap(told[0]->box, {196, 100, 24, 60}), 0.9);
  EXPECT_EQ(told[0]->areaPx, 24u * 60);
  EXPECT_EQ(told[0]->colour, kRed);
  EXPECT_TRUE(told[0]->hasSpeed);
  EXPECT_NEAR(told[0]->speedX, 100 * objects::kPositionUnit,
              5 * objects::kPositionUnit);  // 4 px in 40 ms
  EXPECT_NEAR(told[0]->speedY, 0, 2 * objects::kPositionUnit);
  EXPECT_EQ(objects->slots.at(200, 120), 1);
  EXPECT_EQ(objects->slots.at(20, 120), 0);
  EXPECT_EQ(objects->regionObject, std::vector<uint64_t>{1});
  EXPECT_THAT(told[0]->contour, testing::ElementsAre(Point{196, 100}, Point{219, 100},
                                                     Point{219, 159}, Point{196, 159}));
}

TEST(Objects, RegionsAreExpectedToBeTheObjectThatMovesThere) {
  BodyScene scene;
  std::shared_ptr<const objects::Objects> objects;
  for (int i = 0; i < 20; ++i)
    objects = scene.show({{{20 + 12 * i, 80, 12, 30}, kRed}, {{20 + 12 * i, 110, 12, 30}, kBlue}});
  EXPECT_EQ(objects->regionExpected, (std::vector<uint64_t>{1, 1}));
  ASSERT_EQ(objects->arcs.size(), 1u);
  constexpr int kStep = 170;  // Between red and blue; the frame's area is that of 277x277.
  EXPECT_EQ(objects->arcs[0].border, 2 * 256 * 12 * 16 / (16 + kStep));
  EXPECT_EQ(objects->arcs[0].arc, 277 * 256 / 16 * 30 / (30 + kStep));
  EXPECT_EQ(objects->arcs[0].prediction, 2 * 256 * 18);  // √360, rounded down
  EXPECT_EQ(objects->arcs[0].motion, 0);
  EXPECT_EQ(objects->regionGroup, std::vector(2, objects::GroupIndex::ofIndex(0)));
}

TEST(Objects, SlowEntryFromTheBorderMakesOneObject) {
  BodyScene scene;
  std::set<uint64_t> ids;
  std::shared_ptr<const objects::Objects> objects;
  for (int i = 0; i < 60; ++i) {
    objects = scene.show({{{2 * i - 30, 80, 30, 70}, kRed}});
    for (const objects::Object& object : objects->objects) ids.insert(object.id);
  }
  EXPECT_EQ(ids.size(), 1u);
  ASSERT_EQ(toldOf(*objects).size(), 1u);
  EXPECT_GE(overlap(toldOf(*objects)[0]->box, {88, 80, 30, 70}), 0.9);
}

TEST(Objects, WhatComesInIsToldAsSoonAsAllOfItIsSeen) {
  BodyScene scene;
  std::shared_ptr<const objects::Objects> objects;
  for (int x = -60; x <= 0; x += 4) objects = scene.show({{{x, 100, 60, 90}, kRed}});
  const auto told = toldOf(*objects);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_GE(overlap(told[0]->box, {0, 100, 60, 90}), 0.8);
}

TEST(Objects, WhatComesInBesideAKnownObjectIsAnObjectOfItsOwn) {
  BodyScene scene;
  std::shared_ptr<const objects::Objects> objects;
  for (int i = 0; i < 65; ++i) {
    const Box old{10 + 2 * i, 120, 60, 40}, fresh{20 + 2 * i, 280 - 2 * i, 60, 50};
    objects = scene.show({{old, kRed}, {fresh, kBlue}});
  }
  const auto told = toldOf(*objects);
  ASSERT_EQ(told.size(), 2u);
  EXPECT_GE(overlap(told[0]->box, {138, 120, 60, 40}), 0.7);
  EXPECT_GE(overlap(told[1]->box, {148, 152, 60, 50}), 0.7);
}

/// Of a red thing that leaves and a green one that stops where it went by.
std::shared_ptr<const objects::Objects> showOneLeaveAnotherStop(BodyScene& scene) {
  std::shared_ptr<const objects::Objects> objects;
  for (int i = 0; i < 90; ++i)
    objects = scene.show(
        {{{40 + 4 * i, 100, 30, 80}, kRed}, {{std::max(230, 550 - 4 * i), 96, 40, 70}, kGreen}});
  return objects;
}

TEST(Objects, WhoComesInWhereAnotherLeavesIsSomebodyElse) {
  BodyScene scene;
  const auto objects = showOneLeaveAnotherStop(scene);
  const auto told = toldOf(*objects);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_NE(told[0]->id, 1u);
  EXPECT_GE(overlap(told[0]->box, {230, 96, 40, 70}), 0.8);
}

TEST(Objects, WithoutAppearanceWhoComesInWhereAnotherLeavesIsTakenForIt) {
  BodyScene scene;
  scene.params.appearanceWeight = 0;
  const auto objects = showOneLeaveAnotherStop(scene);
  const auto told = toldOf(*objects);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0]->id, 1u);
}

TEST(Objects, AKnownObjectKeepsItsSizeInCompany) {
  BodyScene scene;
  for (int i = 0; i < 60; ++i) {
    const Box first{10 + 2 * i, 100, 40, 60}, second{250 - 2 * i, 110, 60, 40};
    const auto objects = scene.show({{first, kRed}, {second, kBlue}});
    for (const objects::Object* object : toldOf(*objects)) {
      EXPECT_NEAR(object->box.width, object->id == 1 ? 40 : 60, 6) << i;
      EXPECT_NEAR(object->box.height, object->id == 1 ? 60 : 40, 6) << i;
    }
  }
}

TEST(Objects, TheFirstPartThatComesOutFromBehindAPillarIsEnough) {
  BodyScene scene;
  uint64_t id = 0;
  for (int i = 0; i < 60; ++i) {
    const Box box{4 * i, 100, 40, 60};
    const Box before = intersect(box, {0, 0, 100, 240}), after = intersect(box, {200, 0, 120, 240});
    const auto objects = scene.show({{before, kRed}, {after, kRed}});
    if (i == 20) id = toldOf(*objects).at(0)->id;
    if (after.width < 8) continue;
    const auto told = toldOf(*objects);
    const auto same = std::find_if(objects->objects.begin(), objects->objects.end(),
                                   [&](const objects::Object& object) { return object.id == id; });
    ASSERT_NE(same, objects->objects.end()) << i;
    EXPECT_TRUE(objects::isListed(same->state)) << i;
    EXPECT_GE(overlap(same->box, box), 0.7) << i;
    EXPECT_EQ(objects->objects.size(), 1u) << i;
  }
}

TEST(Objects, ABodyOfSeveralColoursIsOneObject) {
  BodyScene scene;
  std::shared_ptr<const objects::Objects> objects;
  for (int i = 0; i < 30; ++i)
    objects = scene.show({{{40 + 3 * i, 80, 24, 30}, kRed}, {{40 + 3 * i, 110, 24, 30}, kBlue}});
  ASSERT_EQ(toldOf(*objects).size(), 1u);
  EXPECT_GE(overlap(toldOf(*objects)[0]->box, {127, 80, 24, 60}), 0.9);
  EXPECT_EQ(objects->regionObject, (std::vector<uint64_t>{1, 1}));
}

TEST(Objects, AFootApartFromItsBodyIsAPartOfIt) {
  BodyScene scene;
  for (int i = 0; i < 20; ++i) {
    const auto objects =
        scene.show({{{40 + 4 * i, 60, 24, 60}, kRed}, {{50 + 4 * i, 124, 14, 8}, kBlue}});
    ASSERT_LE(objects->objects.size(), 1u) << "frame " << i;
    if (i >= 5) {
      EXPECT_GT(overlap(objects->objects[0].box, {40 + 4 * i, 60, 24, 72}), 0.9);
    }
  }
}

TEST(Objects, PartsThatWereApartForAMomentBecomeOneObject) {
  BodyScene scene;
  std::shared_ptr<const objects::Objects> objects;
  for (int i = 0; i < 30; ++i) {
    std::vector<Body> bodies = {{{40 + 4 * i, 60, 20, 30}, kRed},
                                {{50 + 4 * i, 100, 30, 40}, kBlue}};
    if (i > 5) bodies.push_back({{40 + 4 * i, 80, 30, 30}, kGreen});
    objects = scene.show(bodies);
  }
  EXPECT_EQ(toldOf(*objects).size(), 1u);
  EXPECT_EQ(objects->objects.size(), 1u);
}

TEST(Objects, WhatIsHiddenSoonAfterItWasFoundIsNotGuessedAt) {
  BodyScene scene;
  for (int i = 0; i < 6; ++i) scene.show({{{40 + 8 * i, 60, 24, 60}, kRed}});
  for (int i = 0; i < 5; ++i) scene.show({});
  const auto objects = scene.show({});
  for (const objects::Object& object : objects->objects)
    EXPECT_EQ(object.state, objects::ObjectState::Lost);
}

TEST(Objects, WhatNeverMovesIsNotTold) {
  BodyScene scene;
  for (int i = 0; i < 100; ++i)
    EXPECT_THAT(toldOf(*scene.show({{{100, 80, 24, 60}, kRed}})), IsEmpty());
}

TEST(Objects, AFlickerIsNotTold) {
  BodyScene scene;
  for (int i = 0; i < 60; ++i) {
    const auto objects =
        i % 20 == 3 ? scene.show({{{40 + 3 * i, 80, 24, 60}, kRed}}) : scene.show({});
    EXPECT_THAT(toldOf(*objects), IsEmpty());
    EXPECT_THAT(objects->events, IsEmpty());
  }
}

TEST(Objects, AStoppedObjectKeepsItsNumber) {
  BodyScene scene;
  std::shared_ptr<const objects::Objects> objects;
  for (int i = 0; i < 30; ++i) objects = scene.show({{{40 + 3 * i, 80, 24, 60}, kRed}});
  for (int i = 0; i < 250; ++i) objects = scene.show({{{127, 80, 24, 60}, kRed}});
  ASSERT_EQ(toldOf(*objects).size(), 1u);
  EXPECT_EQ(objects->objects[0].state, objects::ObjectState::Stopped);
  EXPECT_EQ(objects->objects[0].id, 1u);
  for (int i = 0; i < 20; ++i) objects = scene.show({{{127 + 3 * i, 80, 24, 60}, kRed}});
  EXPECT_EQ(objects->objects[0].state, objects::ObjectState::Tracked);
  EXPECT_EQ(objects->objects[0].id, 1u);
}

/// Shows bodies that cross; tells the ids by which each is seen at the start and at the end.
std::map<int, std::set<uint64_t>> cross(BodyScene& scene, int frames, int gapFrom, int gapTo) {
  std::map<int, std::set<uint64_t>> ids;
  for (int i = 0; i < frames; ++i) {
    const std::vector<Body> bodies{{{30 + 3 * i, 80, 24, 60}, kRed},
                                   {{260 - 3 * i, 84, 24, 60}, kBlue}};
    const auto objects = scene.show(bodies);
    if (i < 15 || (i > gapFrom && i < gapTo)) continue;
    for (const objects::Object* object : toldOf(*objects))
      for (int which = 0; which < 2; ++which)
        if (overlap(object->box, bodies[static_cast<size_t>(which)].box) > 0.5)
          ids[which].insert(object->id);
  }
  return ids;
}

TEST(Objects, CrossingBodiesKeepTheirNumbers) {
  BodyScene scene;
  auto ids = cross(scene, 75, 28, 52);
  EXPECT_EQ(ids[0].size(), 1u);
  EXPECT_EQ(ids[1].size(), 1u);
  EXPECT_NE(ids[0], ids[1]);
}

/// Two that hold as much red as blue, but not in the same places, stand behind each other for a
/// while. Then they go on, or back where they came from.
std::map<int, std::set<uint64_t>> meet(bool isTurning) {
  BodyScene scene;
  std::map<int, std::set<uint64_t>> ids;
  for (int i = 0; i < 90; ++i) {
    const int way = i < 36 ? 3 * i : i < 46 ? 108 : 108 + (isTurning ? -3 : 3) * (i - 45);
    const Box first{30 + way, 80, 24, 60}, second{248 - way, 84, 24, 60};
    const auto objects = scene.show({{{first.x, first.y, 24, 30}, kRed},
                                     {{first.x, first.y + 30, 24, 30}, kBlue},
                                     {{second.x, second.y, 24, 30}, kBlue},
                                     {{second.x, second.y + 30, 24, 30}, kRed}});
    if (i < 15 || (i > 28 && i < 75)) continue;
    for (const objects::Object* object : toldOf(*objects)) {
      if (overlap(object->box, first) > 0.5) ids[0].insert(object->id);
      if (overlap(object->box, second) > 0.5) ids[1].insert(object->id);
    }
  }
  return ids;
}

TEST(Objects, WhoMetIsKnownByTheLooksOfItsParts) {
  for (const bool isTurning : {false, true}) {
    auto ids = meet(isTurning);
    EXPECT_EQ(ids[0].size(), 1u) << isTurning;
    EXPECT_EQ(ids[1].size(), 1u) << isTurning;
    EXPECT_NE(ids[0], ids[1]) << isTurning;
  }
}

TEST(Objects, MeetingAndPartingAreToldOnce) {
  BodyScene scene;
  std::vector<objects::Event> merges, splits;
  for (int i = 0; i < 75; ++i) {
    const auto objects =
        scene.show({{{30 + 3 * i, 80, 24, 60}, kRed}, {{260 - 3 * i, 84, 24, 60}, kBlue}});
    for (const objects::Event& event : objects->events) {
      if (event.kind == objects::EventKind::Merge) merges.push_back(event);
      if (event.kind == objects::EventKind::Split) splits.push_back(event);
    }
  }
  ASSERT_EQ(merges.size(), 1u);
  ASSERT_EQ(splits.size(), 1u);
  EXPECT_EQ(merges[0].ids, (std::vector<uint64_t>{1, 2}));
  EXPECT_EQ(splits[0].ids, (std::vector<uint64_t>{1, 2}));
}

TEST(Objects, WhatComesOutOfAnObjectNamesItsParent) {
  BodyScene scene;
  std::shared_ptr<const objects::Objects> objects;
  for (int i = 0; i < 40; ++i) objects = scene.show({{{30 + 2 * i, 80, 24, 60}, kRed}});
  for (int i = 0; i < 40; ++i)
    objects = scene.show({{{110 + 2 * i, 80, 24, 60}, kRed}, {{110 - 2 * i, 80, 24, 60}, kBlue}});
  const auto told = toldOf(*objects);
  ASSERT_EQ(told.size(), 2u);
  EXPECT_EQ(told[0]->id, 1u);
  EXPECT_THAT(told[0]->parents, IsEmpty());
  EXPECT_EQ(told[1]->parents, std::vector<uint64_t>{1});
}

TEST(Objects, AHiddenObjectComesBackWithItsNumber) {
  BodyScene scene;
  std::shared_ptr<const objects::Objects> objects;
  for (int i = 0; i < 60; ++i) {
    const bool isHidden = i >= 25 && i < 45;
    objects = isHidden ? scene.show({}) : scene.show({{{40 + 3 * i, 80, 24, 60}, kGreen}});
    if (i == 30) {
      ASSERT_EQ(objects->objects.size(), 1u);
      EXPECT_EQ(objects->objects[0].state, objects::ObjectState::Occluded);
      EXPECT_NEAR(objects->objects[0].box.x, 130, 4);
    }
  }
  ASSERT_EQ(toldOf(*objects).size(), 1u);
  EXPECT_EQ(toldOf(*objects)[0]->id, 1u);
}

TEST(Objects, WhatIsGoneForLongEndsAndItsNumberIsNotUsedAgain) {
  BodyScene scene;
  for (int i = 0; i < 30; ++i) (void)scene.show({{{40 + 3 * i, 80, 24, 60}, kGreen}});
  int ended = 0;
  for (int i = 0; i < 60; ++i) ended += countEvents(*scene.show({}), objects::EventKind::ObjectEnd);
  EXPECT_EQ(ended, 1);
  std::shared_ptr<const objects::Objects> objects;
  for (int i = 0; i < 30; ++i) objects = scene.show({{{40 + 3 * i, 80, 24, 60}, kGreen}});
  ASSERT_EQ(toldOf(*objects).size(), 1u);
  EXPECT_GT(toldOf(*objects)[0]->id, 1u);
}

TEST(Objects, ASkippedFramePredictsAndTellsNothing) {
  BodyScene scene;
  for (int i = 0; i < 30; ++i) (void)scene.show({{{40 + 3 * i, 80, 24, 60}, kRed}});
  const auto skipped = scene.skip();
  EXPECT_EQ(skipped->status, Status::Skipped);
  EXPECT_THAT(skipped->objects, IsEmpty());
  const auto objects = scene.show({{{40 + 3 * 31, 80, 24, 60}, kRed}});
  ASSERT_EQ(toldOf(*objects).size(), 1u);
  EXPECT_EQ(toldOf(*objects)[0]->id, 1u);
  EXPECT_GE(overlap(toldOf(*objects)[0]->box, {133, 80, 24, 60}), 0.85);
}

TEST(Objects, AFlushEndsTracksAndTheNextFrameTells) {
  BodyScene scene;
  for (int i = 0; i < 30; ++i) (void)scene.show({{{40 + 3 * i, 80, 24, 60}, kRed}});
  scene.stage().reset(Reset::Flush);
  const auto objects = scene.show({});
  EXPECT_EQ(countEvents(*objects, objects::EventKind::ObjectEnd), 1);
  EXPECT_THAT(objects->objects, IsEmpty());
}

TEST(Objects, AGapIsBridgedByPrediction) {
  BodyScene scene;
  for (int i = 0; i < 30; ++i) (void)scene.show({{{40 + 3 * i, 80, 24, 60}, kRed}});
  scene.stage().reset(Reset::Gap);
  scene.wait(9 * kStepNs);
  const auto objects = scene.show({{{40 + 3 * 39, 80, 24, 60}, kRed}});
  ASSERT_EQ(toldOf(*objects).size(), 1u);
  EXPECT_EQ(toldOf(*objects)[0]->id, 1u);
}

TEST(Objects, WhatPassesBehindAPillarGoesOnAsItDid) {
  BodyScene scene;
  constexpr Box kPillar{140, 0, 100, 240};
  std::shared_ptr<const objects::Objects> objects;
  for (int i = 0; i < 75; ++i) {
    const Box body{4 * i - 10, 100, 24, 60};
    const int first = body.x >= kPillar.x ? std::max(body.x, kPillar.right()) : body.x;
    const int last = body.x < kPillar.x ? std::min(body.right(), kPillar.x) : body.right();
    std::vector<Body> seen;
    if (first < last) seen.push_back({{first, body.y, last - first, body.height}, kRed});
    objects = scene.show(seen);
    if (i < 20 || body.right() > 320) continue;
    ASSERT_EQ(objects->objects.size(), 1u) << i;
    EXPECT_EQ(objects->objects[0].id, 1u) << i;
    EXPECT_NEAR(objects->objects[0].centroidX, (2 * body.x + 23) * objects::kPositionUnit / 2,
                3 * objects::kPositionUnit)
        << i;
  }
}

TEST(Objects, WithoutTimeThereIsNoSpeed) {
  BodyScene scene;
  scene.forgetTime();
  std::shared_ptr<const objects::Objects> objects;
  for (int i = 0; i < 30; ++i) objects = scene.show({{{40 + 3 * i, 80, 24, 60}, kRed}});
  ASSERT_EQ(toldOf(*objects).size(), 1u);
  EXPECT_FALSE(toldOf(*objects)[0]->hasSpeed);
  EXPECT_EQ(toldOf(*objects)[0]->speedX, 0);
}

TEST(Objects, AMovingCameraIsTheBackgroundsMotion) {
  BodyScene scene({320, 240}, segmentation::Scope::Frame);
  const motion::RegionMotion pan{-3 * motion::kMotionUnit, motion::kMotionUnit, 0,
                                 motion::kFullReliability};
  const motion::RegionMotion walk{4 * motion::kMotionUnit, 0, 0, motion::kFullReliability};
  std::shared_ptr<const objects::Objects> objects;
  for (int i = 0; i < 30; ++i)
    objects =
        scene.show({{{0, 0, 320, 240}, kGreen}, {{60 + 4 * i, 90, 24, 60}, kRed}}, {pan, walk});
  EXPECT_EQ(objects->cameraDx, -3 * motion::kMotionUnit);
  EXPECT_EQ(objects->cameraDy, motion::kMotionUnit);
  ASSERT_EQ(toldOf(*objects).size(), 1u);
  EXPECT_GE(overlap(toldOf(*objects)[0]->box, {176, 90, 24, 60}), 0.9);
}

TEST(Objects, TinyFramesAreFine) {
  for (const Size size : {Size{1, 1}, Size{1, 9}, Size{9, 1}}) {
    BodyScene scene(size);
    for (int i = 0; i < 10; ++i) (void)scene.show({{{i % 3, i % 2, 3, 3}, kRed}});
    EXPECT_EQ(scene.show({})->size, size);
  }
}

TEST(Objects, TwoRunsAgree) {
  BodyScene one, two;
  for (int i = 0; i < 75; ++i) {
    const std::vector<Body> bodies{{{30 + 3 * i, 80, 24, 60}, kRed},
                                   {{260 - 3 * i, 84, 24, 60}, kBlue}};
    const auto a = one.show(bodies), b = two.show(bodies);
    ASSERT_EQ(a->objects.size(), b->objects.size());
    for (size_t k = 0; k < a->objects.size(); ++k) {
      EXPECT_EQ(a->objects[k].id, b->objects[k].id);
      EXPECT_EQ(a->objects[k].box, b->objects[k].box);
      EXPECT_EQ(a->objects[k].speedX, b->objects[k].speedX);
    }
  }
}

}  // namespace
}  // namespace rg
