// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/portrait.hpp"

#include <gtest/gtest.h>

#include <functional>

namespace rg {
namespace {

/// A picture of which some cells are foreground: thing(x, y) tells the grey of its pixels, −1 where
/// the ground is seen.
class Stage {
 public:
  explicit Stage(Size size, int stepPx = 1) {
    evidence_.stepPx = stepPx;
    evidence_.frame = size;
    evidence_.grid = {(size.width + stepPx - 1) / stepPx, (size.height + stepPx - 1) / stepPx};
  }

  void paint(const std::function<int(int, int)>& thing) {
    const Size size = evidence_.frame;
    std::vector<uint8_t> pixels(static_cast<size_t>(size.area()), 100);
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x)
        if (const int grey = thing(x, y); grey >= 0)
          pixels[static_cast<size_t>(y * size.width + x)] = static_cast<uint8_t>(grey);
    const PlaneMemory plane{pixels.data(), pixels.size(), size.width};
    picture_.load(*Frame::make({PixelFormat::Gray8, size}, std::span(&plane, 1)), Executor(1));
    evidence_.group.assign(static_cast<size_t>(evidence_.grid.area()), 0);
    for (int y = 0; y < evidence_.grid.height; ++y)
      for (int x = 0; x < evidence_.grid.width; ++x) {
        const Point middle = evidence_.middleOf(x, y);
        evidence_.group[evidence_.at(x, y)] = thing(middle.x, middle.y) >= 0;
      }
    taken_.assign(evidence_.group.size(), 0);
  }
  void take(const Box& box) {
    for (int y = 0; y < evidence_.grid.height; ++y)
      for (int x = 0; x < evidence_.grid.width; ++x)
        if (box.contains(evidence_.middleOf(x, y))) taken_[evidence_.at(x, y)] = 1;
  }
  [[nodiscard]] PortraitScene scene() const { return {evidence_, picture_, taken_}; }
  [[nodiscard]] const std::vector<uint16_t>& owner() const { return evidence_.group; }
  [[nodiscard]] size_t cells() const { return evidence_.group.size(); }

 private:
  Evidence evidence_;
  Picture picture_;
  std::vector<uint8_t> taken_;
};

constexpr Size kThing{20, 30};

/// A thing of stripes and squares with its corner at `corner`.
auto thingAt(Point corner) {
  return [corner](int x, int y) {
    const Point p{x - corner.x, y - corner.y};
    if (!boundsOf(kThing).contains(p)) return -1;
    return p.x / 5 % 2 * 40 + p.y / 7 % 3 * 50 + 60;
  };
}

Portrait learntAt(Stage& stage, Point corner, int frames = 8) {
  Portrait portrait;
  stage.paint(thingAt(corner));
  for (int i = 0; i < frames; ++i) learn(portrait, stage.scene(), corner, kThing, stage.owner(), 1);
  return portrait;
}

/// In whole pixels.
Point placeOf(const PortraitMatch& match) {
  const auto px = [](int v) { return (v + 8) >> 4; };
  return {px(match.shift.x), px(match.shift.y)};
}

PortraitMatch find(const Portrait& portrait, const Stage& stage, Point corner,
                   Point reach = {10, 10}) {
  PortraitScratch scratch;
  return findPortrait(portrait, stage.scene(), {corner, reach, 1, {}}, scratch);
}

TEST(Portrait, AWholeThingIsFoundWhereItIs) {
  Stage stage({120, 90});
  const Portrait portrait = learntAt(stage, {40, 30});
  EXPECT_EQ(portrait.usual, 256);
  stage.paint(thingAt({43, 28}));
  const PortraitMatch match = find(portrait, stage, {40, 30});
  EXPECT_EQ(placeOf(match), (Point{3, -2}));
  EXPECT_EQ(match.samples, 600u);
  EXPECT_EQ(match.agreeing, 600u);
  EXPECT_EQ(match.share(), 256u);
}

/// The cost of being elsewhere divides by the size's square and by the time: here by 2^65.
TEST(Portrait, OfAWholeLargeFrameIsFoundAfterAnHour) {
  Stage stage({120, 90});
  Portrait portrait = learntAt(stage, {40, 30});
  portrait.sizePx = {8192, 4096};
  stage.paint(thingAt({43, 28}));
  PortraitScratch scratch;
  const PortraitMatch match =
      findPortrait(portrait, stage.scene(), {{40, 30}, {10, 10}, 32768, {}}, scratch);
  EXPECT_EQ(placeOf(match), (Point{3, -2}));
}

TEST(Portrait, TheHalfThatASceneLeavesTellsThePlace) {
  Stage stage({120, 90});
  const Portrait portrait = learntAt(stage, {40, 30});
  stage.paint([thing = thingAt({44, 31})](int x, int y) { return x < 54 ? thing(x, y) : -1; });
  const PortraitMatch match = find(portrait, stage, {42, 30});
  EXPECT_EQ(placeOf(match), (Point{2, 1}));
  EXPECT_EQ(match.agreeing, 300u);
  EXPECT_EQ(match.seen, 300u);
}

TEST(Portrait, WhatAnotherThingCoversSaysNothing) {
  Stage stage({120, 90});
  const Portrait portrait = learntAt(stage, {40, 30});
  const Box front{50, 20, 30, 50};
  stage.paint([&](int x, int y) { return front.contains({x, y}) ? 250 : thingAt({42, 30})(x, y); });
  stage.take(front);
  const PortraitMatch match = find(portrait, stage, {40, 30});
  EXPECT_EQ(placeOf(match), (Point{2, 0}));
  EXPECT_EQ(match.agreeing, 8u * 30u);
  EXPECT_EQ(match.seen, 8u * 30u);
}

TEST(Portrait, AThingOfOneColourIsPlacedByTheEdgeThatIsSeen) {
  const auto plain = [](Point corner, int end) {
    return [=](int x, int y) {
      return boundsOf(kThing).contains({x - corner.x, y - corner.y}) && x < end ? 220 : -1;
    };
  };
  Stage stage({120, 90});
  Portrait portrait;
  stage.paint(plain({40, 30}, 120));
  for (int i = 0; i < 8; ++i) learn(portrait, stage.scene(), {40, 30}, kThing, stage.owner(), 1);
  stage.paint(plain({43, 30}, 52));
  EXPECT_EQ(placeOf(find(portrait, stage, {42, 30})).x, 1);
}

TEST(Portrait, AnotherThingInItsPlaceIsNotIt) {
  Stage stage({120, 90});
  const Portrait portrait = learntAt(stage, {40, 30});
  stage.paint([](int x, int y) { return Box{36, 26, 30, 40}.contains({x, y}) ? 0 : -1; });
  const PortraitMatch match = find(portrait, stage, {40, 30});
  EXPECT_EQ(match.agreeing, 0u);
  EXPECT_LT(match.value(), 0);
}

TEST(Portrait, NothingIsFoundOnTheGround) {
  Stage stage({120, 90});
  const Portrait portrait = learntAt(stage, {40, 30});
  stage.paint([](int, int) { return -1; });
  const PortraitMatch match = find(portrait, stage, {40, 30});
  EXPECT_EQ(match.seen, 0u);
  EXPECT_EQ(match.shift, Point{});
}

TEST(Portrait, WhatTurnedRoundIsLookedForWhereItCameFrom) {
  Stage stage({160, 90});
  const Portrait portrait = learntAt(stage, {60, 30});
  stage.paint(thingAt({52, 30}));
  PortraitScratch scratch;
  const auto placeWith = [&](Point turn) {
    return placeOf(findPortrait(portrait, stage.scene(), {{60, 30}, {12, 6}, 1, turn}, scratch)).x;
  };
  EXPECT_GT(placeWith({}), -8);
  EXPECT_EQ(placeWith({8, 0}), -8);
}

TEST(Portrait, ASliverBetweenTheCoarsePlacesIsFound) {
  for (int width = 3; width < 6; ++width)
    for (int off = -3; off <= 3; ++off) {
      Stage stage({200, 90});
      const Portrait portrait = learntAt(stage, {60, 30});
      // Its outermost columns mix with the ground, and another thing covers the place beside it.
      stage.paint([&](int x, int y) {
        const int grey = thingAt({60 + off, 30})(x, y);
        return x >= 60 + off + width ? (x >= 90 ? 250 : -1) : x == 60 + off ? grey / 2 : grey;
      });
      stage.take({90, 0, 110, 90});
      PortraitScratch scratch;
      const PortraitMatch match =
          findPortrait(portrait, stage.scene(), {{60, 30}, {25, 15}, 13, {}}, scratch);
      EXPECT_NEAR(placeOf(match).x, off, 1) << width;
      EXPECT_GT(match.agreeing, 20u) << width << ' ' << off;
    }
}

TEST(Portrait, DistanceCostsUnlessItWasUnseenForLong) {
  Stage stage({160, 90});
  const Portrait portrait = learntAt(stage, {40, 30});
  stage.paint([](int x, int y) {
    const int near = thingAt({41, 30})(x, y);
    return near >= 0 ? near - 5 : thingAt({64, 30})(x, y);
  });
  PortraitScratch scratch;
  EXPECT_EQ(placeOf(findPortrait(portrait, stage.scene(), {{40, 30}, {30, 4}, 1, {}}, scratch)).x,
            1);
  EXPECT_EQ(placeOf(findPortrait(portrait, stage.scene(), {{40, 30}, {30, 4}, 50, {}}, scratch)).x,
            24);
}

TEST(Portrait, WhatItLosesFadesAndWhatItGainsIsLearnt) {
  Stage stage({120, 90});
  Portrait portrait = learntAt(stage, {40, 30});
  stage.paint([thing = thingAt({40, 30})](int x, int y) { return y < 45 ? thing(x, y) : -1; });
  learn(portrait, stage.scene(), {40, 30}, kThing, stage.owner(), 1);
  EXPECT_EQ(find(portrait, stage, {40, 30}).samples, 600u);
  EXPECT_LT(portrait.usual, 256);
  for (int i = 0; i < 8; ++i) learn(portrait, stage.scene(), {40, 30}, kThing, stage.owner(), 1);
  EXPECT_EQ(find(portrait, stage, {40, 30}).samples, 300u);
}

TEST(Portrait, AnotherSizeBeginsAnew) {
  Stage stage({120, 90});
  Portrait portrait = learntAt(stage, {40, 30});
  learn(portrait, stage.scene(), {40, 30}, {30, 30}, stage.owner(), 1);
  EXPECT_EQ(portrait.frames, 1u);
  EXPECT_EQ(portrait.sizePx, (Size{30, 30}));
}

TEST(Portrait, LargeThingsHaveNoMoreThanSomeThousandSamples) {
  Stage stage({1010, 810}, 4);
  Portrait portrait;
  stage.paint([](int x, int y) {
    return Box{5, 5, 997, 799}.contains({x, y}) ? x / 90 % 5 * 40 + y / 110 % 3 * 30 : -1;
  });
  for (int i = 0; i < 4; ++i) learn(portrait, stage.scene(), {5, 5}, {997, 799}, stage.owner(), 1);
  EXPECT_LE(portrait.samples.size(), 1500u);
  const Point place = placeOf(find(portrait, stage, {7, 4}, {3, 3}));  // Cells are of 4 px.
  EXPECT_NEAR(place.x, -2, 1);
  EXPECT_NEAR(place.y, 1, 1);
}

TEST(Portrait, PlacesBeyondTheFrameAreFine) {
  Stage stage({30, 20}, 2);
  const Portrait portrait = learntAt(stage, {-5, -9});
  EXPECT_GT(find(portrait, stage, {-5, -9}).agreeing, 0u);
  EXPECT_EQ(find(portrait, stage, {-500, 400}).seen, 0u);
  size_t visited = 0;
  for (const Point corner : {Point{-5, -9}, Point{25, 15}, Point{-100, 0}, Point{900, 900}})
    forPortraitCells(portrait, stage.scene(), corner, [&](size_t cell, bool) {
      ASSERT_LT(cell, stage.cells());
      ++visited;
    });
  EXPECT_GT(visited, 0u);
}

TEST(Portrait, ItsCellsAreThoseItCovers) {
  Stage stage({60, 60}, 2);
  const Portrait portrait = learntAt(stage, {11, 13});
  size_t cells = 0, alike = 0;
  forPortraitCells(portrait, stage.scene(), {11, 13}, [&](size_t, bool isAlike) {
    ++cells;
    alike += isAlike;
  });
  EXPECT_EQ(cells, 10u * 15u);
  EXPECT_EQ(alike, cells);
}

}  // namespace
}  // namespace rg
