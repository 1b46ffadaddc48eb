// SPDX-License-Identifier: LGPL-2.1-or-later
// Objects of which only a part is seen: behind the scene, behind another one, or in company.
#include "tests/core/body_scene.hpp"

#include <algorithm>
#include <cmath>

namespace rg {
namespace {

constexpr graph::Colour kRed{200, 30, 30}, kBlue{30, 40, 200}, kGreen{30, 180, 40},
    kGold{210, 180, 20};

/// A body whose upper and lower half, and left and right half below, differ in colour.
std::vector<Body> carAt(int x, int y, graph::Colour top, graph::Colour bottom) {
  return {{{x, y, 40, 16}, top}, {{x, y + 16, 20, 16}, bottom}, {{x + 20, y + 16, 20, 16}, kGold}};
}

std::vector<Body> operator+(std::vector<Body> a, const std::vector<Body>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

/// What of the bodies a pillar from `left` to `right` leaves to be seen.
std::vector<Body> behindPillar(std::vector<Body> bodies, int left, int right) {
  std::vector<Body> seen;
  for (const Body& body : bodies) {
    const Box& box = body.box;
    const int end = std::min(box.right(), left), begin = std::max(box.x, right);
    if (end > box.x) seen.push_back({{box.x, box.y, end - box.x, box.height}, body.colour});
    if (begin < box.right())
      seen.push_back({{begin, box.y, box.right() - begin, box.height}, body.colour});
  }
  return seen;
}

const objects::Object* find(const objects::Objects& objects, uint64_t id) {
  const auto at = std::find_if(objects.objects.begin(), objects.objects.end(),
                               [&](const objects::Object& object) { return object.id == id; });
  return at == objects.objects.end() || !objects::isListed(at->state) ? nullptr : &*at;
}

/// The first is the one of the two at the left.
std::pair<uint64_t, uint64_t> idsOf(const objects::Objects& objects, Point left) {
  const bool isFirst = std::abs(objects.objects.at(0).box.x - left.x) < 20;
  return isFirst ? std::pair<uint64_t, uint64_t>{1, 2} : std::pair<uint64_t, uint64_t>{2, 1};
}

/// How many of the objects share more than so many percent with a box, of what the two cover.
int64_t countAt(const objects::Objects& objects, const Box& box, int percent) {
  return std::count_if(
      objects.objects.begin(), objects.objects.end(), [&](const objects::Object& object) {
        return objects::isListed(object.state) &&
               100 * intersect(object.box, box).area() > percent * unite(object.box, box).area();
      });
}

void expectAt(const objects::Objects& objects, uint64_t id, Point corner, const char* when,
              int step) {
  const objects::Object* object = find(objects, id);
  ASSERT_NE(object, nullptr) << when << ' ' << step;
  EXPECT_NEAR(object->box.x, corner.x, 3) << when << ' ' << step;
  EXPECT_NEAR(object->box.y, corner.y, 3) << when << ' ' << step;
  EXPECT_NEAR(object->box.width, 40, 4) << when << ' ' << step;
  EXPECT_NEAR(object->box.height, 32, 4) << when << ' ' << step;
}

TEST(HiddenObjects, WhatDisappearsSlowlyBehindAPillarKeepsItsBox) {
  BodyScene scene;
  int x = -40;
  for (; x < 110; x += 3) scene.show(carAt(x, 100, kRed, kBlue));
  // A pixel per frame: part of it is hidden for longer than all of it was seen before.
  for (int step = 0; step < 32; ++step, ++x)
    expectAt(*scene.show(behindPillar(carAt(x, 100, kRed, kBlue), 146, 260)), 1, {x, 100}, "in",
             step);
}

TEST(HiddenObjects, AFewPixelsTellWhereItComesOut) {
  BodyScene scene;
  int x = -40;
  for (; x < 118; x += 3) scene.show(carAt(x, 100, kRed, kBlue));
  for (; x < 180; x += 3) scene.show(behindPillar(carAt(x, 100, kRed, kBlue), 120, 215));
  for (; x < 230; x += 3)
    expectAt(*scene.show(behindPillar(carAt(x, 100, kRed, kBlue), 120, 215)), 1, {x, 100}, "out",
             x);
}

TEST(HiddenObjects, ASliverOfWhatKeepsItsShapeIsEnough) {
  BodyScene scene;
  for (int x = -40; x < 176; x += 3) scene.show(behindPillar(carAt(x, 100, kRed, kBlue), 120, 214));
  expectAt(*scene.show(behindPillar(carAt(176, 100, kRed, kBlue), 120, 214)), 1, {176, 100}, "at",
           176);
}

TEST(HiddenObjects, WhatWasSeenWholeForAMomentIsNotTakenToShrink) {
  BodyScene scene;
  for (int i = 0; i < 105; ++i) {
    const int x = -120 + 2 * i;
    const std::vector<Body> lorry{
        {{x, 100, 120, 20}, kRed}, {{x, 120, 60, 30}, kBlue}, {{x + 60, 120, 60, 30}, kGold}};
    // It is seen whole for nine frames; then what is left of it shrinks so slowly that a size which
    // follows it would never be off by much.
    const auto objects = scene.show(behindPillar(lorry, 138, 320));
    if (x < 20) continue;
    const objects::Object* object = find(*objects, 1);
    ASSERT_NE(object, nullptr) << x;
    EXPECT_NEAR(object->box.width, 120, 8) << x;
    EXPECT_NEAR(object->box.x, x, 4) << x;
  }
}

TEST(HiddenObjects, WhoIsCoveredAtThePillarComesOutBehindIt) {
  BodyScene scene;
  for (int i = 0; i < 85; ++i) {
    // The other one, in front of both, covers most of it just before the pillar hides the rest.
    const int x = -40 + 3 * i, other = 330 - 4 * i;
    const auto objects = scene.show(behindPillar(carAt(x, 100, kRed, kBlue), 120, 190) +
                                    carAt(other, 106, kGreen, kRed));
    if (i < 20) continue;
    const objects::Object* object = find(*objects, 1);
    // Where it went is not known at once.
    if (object != nullptr && (x < 90 || x > 105)) {
      EXPECT_NEAR(object->box.x, x, 20) << i;
    }
    if (x > 160) expectAt(*objects, 1, {x, 100}, "out", i);
  }
}

TEST(HiddenObjects, WhoComesInBesideSomebodyKnownGetsTheRest) {
  BodyScene scene;
  for (int i = 0; i < 70; ++i) {
    // It rises where the other one comes in, so that they touch until that is all there.
    const std::vector<Body> known = carAt(262, 302 - 4 * i, kRed, kBlue);
    const Body tall{{365 - 2 * i, 90, 60, 84}, kGreen};
    const auto objects = scene.show(std::vector<Body>{tall} + known);
    if (tall.box.right() > 314) continue;
    const auto fits = [&](const objects::Object& object) {
      return objects::isListed(object.state) &&
             10 * intersect(object.box, tall.box).area() > 7 * unite(object.box, tall.box).area();
    };
    EXPECT_EQ(std::count_if(objects->objects.begin(), objects->objects.end(), fits), 1) << i;
  }
}

/// Two cars that come from either side, 4 px a frame, and turn back after `turn` frames.
struct Meeting {
  int frames, turn;
  Point rear, front;  ///< Where they begin.
  graph::Colour frontTop, frontBottom;
};

void expectBothKept(const Meeting& m) {
  BodyScene scene;
  std::pair<uint64_t, uint64_t> ids;
  for (int i = 0; i < m.frames; ++i) {
    const int way = 4 * (i < m.turn ? i : 2 * m.turn - i);
    const Point rear{m.rear.x + way, m.rear.y}, front{m.front.x - way, m.front.y};
    const auto objects = scene.show(carAt(rear.x, rear.y, kRed, kBlue) +
                                    carAt(front.x, front.y, m.frontTop, m.frontBottom));
    if (i == 20) ids = idsOf(*objects, rear);
    if (i < 20 || rear.x < 4) continue;
    expectAt(*objects, ids.first, rear, "rear", i);
    expectAt(*objects, ids.second, front, "front", i);
  }
}

TEST(HiddenObjects, WhoIsBehindAnotherKeepsItsPlace) {
  expectBothKept({75, 75, {-40, 96}, {280, 104}, kGreen, kRed});
}

TEST(HiddenObjects, TwinsThatCrossGoOnAsTheyDid) {
  expectBothKept({70, 70, {-40, 100}, {281, 104}, kRed, kBlue});
}

TEST(HiddenObjects, WhoMeetAndTurnBackKeepTheirNumbers) {
  expectBothKept({70, 34, {-40, 96}, {260, 104}, kGreen, kRed});
}

TEST(HiddenObjects, TwoThatCameInAboveEachOtherArePartedOnceTheyMoveApart) {
  BodyScene scene;
  std::shared_ptr<const objects::Objects> objects;
  for (int i = 0; i < 70; ++i) {
    // The upper one shows a sliver while the lower one isn't all there yet.
    const Body upper{{-46 + 3 * i, 84, 30, 36}, kRed}, lower{{-36 + 2 * i, 124, 36, 36}, kBlue};
    objects = scene.show({upper, lower});
    if (i < 60) continue;
    for (const Box& box : {upper.box, lower.box}) EXPECT_EQ(countAt(*objects, box, 50), 1) << i;
  }
}

TEST(HiddenObjects, WhatLostAPartThatGoesOnByItselfIsNoLargerThanWhatIsLeft) {
  BodyScene scene;
  for (int i = 0; i < 60; ++i) {
    const int parted = std::max(0, i - 20);
    const Body upper{{20 + 3 * i, 84, 30, 36}, kRed};
    const Body lower{{20 + 3 * i - parted / 2, i < 20 ? 120 : 126, 36, 36}, kBlue};
    const auto objects = scene.show({upper, lower});
    if (i == 19) {
      ASSERT_EQ(objects->objects.size(), 1u);
      EXPECT_NEAR(objects->objects[0].box.height, 72, 4);
    }
    if (i < 40) continue;
    for (const Box& box : {upper.box, lower.box}) EXPECT_EQ(countAt(*objects, box, 75), 1) << i;
  }
}

TEST(HiddenObjects, TwoBesideEachOtherArePartedOnceTheGapMovesAlong) {
  BodyScene scene;
  for (int i = 0; i < 60; ++i) {
    const int x = 20 + 3 * i, gap = i < 20 ? 0 : 10;
    const Body rear{{x, 84, 30, 60}, kRed}, front{{x + 30 + gap, 84, 30, 60}, kBlue};
    const auto objects = scene.show({rear, front});
    if (i == 19) {
      ASSERT_EQ(objects->objects.size(), 1u);
    }
    if (i < 40) continue;
    for (const Box& box : {rear.box, front.box}) EXPECT_EQ(countAt(*objects, box, 75), 1) << i;
  }
}

TEST(HiddenObjects, WhatIsCompleteTakesNoParts) {
  BodyScene scene;
  for (int i = 0; i < 60; ++i) {
    const int x = -40 + 3 * i;
    std::vector<Body> bodies = carAt(x, 100, kRed, kBlue);
    // Comes in right below it, smaller than half of it, and as fast.
    if (i >= 30) bodies.push_back({{x + 4, 135, 24, 12}, kGreen});
    const auto objects = scene.show(bodies);
    if (i >= 20) expectAt(*objects, 1, {x, 100}, "frame", i);
  }
}

TEST(HiddenObjects, WhatLeavesSlowlyIsNoNewObject) {
  BodyScene scene;
  for (int x = 140; x < 282; x += 4) scene.show(carAt(x, 100, kRed, kBlue));
  for (int x = 282; x < 325; ++x)
    for (const objects::Object& object : scene.show(carAt(x, 100, kRed, kBlue))->objects)
      EXPECT_TRUE(object.id == 1 || !objects::isListed(object.state)) << x;
}

}  // namespace
}  // namespace rg
