// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/pixel.hpp"
#include "core/objects/tracking/looks/portrait.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <functional>
#include <tuple>

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
  [[nodiscard]] objects::PortraitScene scene() const { return {evidence_, picture_, taken_}; }
  [[nodiscard]] const std::vector<uint16_t>& owner() const { return evidence_.group; }
  [[nodiscard]] size_t cells() const { return evidence_.group.size(); }

 private:
  objects::GroupGrid evidence_;
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

objects::Portrait learntAt(Stage& stage, Point corner, int frames = 8) {
  objects::Portrait portrait;
  stage.paint(thingAt(corner));
  for (int i = 0; i < frames; ++i)
    objects::learn(portrait, stage.scene(), corner, kThing, stage.owner(), 1);
  return portrait;
}

/// In whole pixels.
Point placeOf(const objects::PortraitMatch& match) {
  const auto px = [](int v) { return (v + 8) >> 4; };
  return {px(match.shift.x), px(match.shift.y)};
}

objects::PortraitMatch find(const objects::Portrait& portrait, const Stage& stage, Point corner,
                            Point reach = {10, 10}) {
  objects::PortraitScratch scratch;
  return objects::findPortrait(portrait, stage.scene(), {corner, reach, 1, {}}, scratch);
}

TEST(Portrait, AWholeThingIsFoundWhereItIs) {
  Stage stage({120, 90});
  const objects::Portrait portrait = learntAt(stage, {40, 30});
  EXPECT_EQ(portrait.usual, 256);
  stage.paint(thingAt({43, 28}));
  const objects::PortraitMatch match = find(portrait, stage, {40, 30});
  EXPECT_EQ(placeOf(match), (Point{3, -2}));
  EXPECT_EQ(match.samples, 600u);
  EXPECT_EQ(match.agreeing, 600u);
  EXPECT_EQ(match.share(), 256u);
}

/// The cost of being elsewhere divides by the size's square and by the time: here by 2^65.
TEST(Portrait, OfAWholeLargeFrameIsFoundAfterAnHour) {
  Stage stage({120, 90});
  objects::Portrait portrait = learntAt(stage, {40, 30});
  portrait.sizePx = {8192, 4096};
  stage.paint(thingAt({43, 28}));
  objects::PortraitScratch scratch;
  const objects::PortraitMatch match =
      objects::findPortrait(portrait, stage.scene(), {{40, 30}, {10, 10}, 32768, {}}, scratch);
  EXPECT_EQ(placeOf(match), (Point{3, -2}));
}

TEST(Portrait, TheHalfThatASceneLeavesTellsThePlace) {
  Stage stage({120, 90});
  const objects::Portrait portrait = learntAt(stage, {40, 30});
  stage.paint([thing = thingAt({44, 31})](int x, int y) { return x < 54 ? thing(x, y) : -1; });
  const objects::PortraitMatch match = find(portrait, stage, {42, 30});
  EXPECT_EQ(placeOf(match), (Point{2, 1}));
  EXPECT_EQ(match.agreeing, 300u);
  EXPECT_EQ(match.seen, 300u);
}

TEST(Portrait, WhatAnotherThingCoversSaysNothing) {
  Stage stage({120, 90});
  const objects::Portrait portrait = learntAt(stage, {40, 30});
  const Box front{50, 20, 30, 50};
  stage.paint([&](int x, int y) { return front.contains({x, y}) ? 250 : thingAt({42, 30})(x, y); });
  stage.take(front);
  const objects::PortraitMatch match = find(portrait, stage, {40, 30});
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
  objects::Portrait portrait;
  stage.paint(plain({40, 30}, 120));
  for (int i = 0; i < 8; ++i)
    objects::learn(portrait, stage.scene(), {40, 30}, kThing, stage.owner(), 1);
  stage.paint(plain({43, 30}, 52));
  EXPECT_EQ(placeOf(find(portrait, stage, {42, 30})).x, 1);
}

TEST(Portrait, AnotherThingInItsPlaceIsNotIt) {
  Stage stage({120, 90});
  const objects::Portrait portrait = learntAt(stage, {40, 30});
  stage.paint([](int x, int y) { return Box{36, 26, 30, 40}.contains({x, y}) ? 0 : -1; });
  const objects::PortraitMatch match = find(portrait, stage, {40, 30});
  EXPECT_EQ(match.agreeing, 0u);
  EXPECT_LT(match.value(), 0);
}

TEST(Portrait, NothingIsFoundOnTheGround) {
  Stage stage({120, 90});
  const objects::Portrait portrait = learntAt(stage, {40, 30});
  stage.paint([](int, int) { return -1; });
  const objects::PortraitMatch match = find(portrait, stage, {40, 30});
  EXPECT_EQ(match.seen, 0u);
  EXPECT_EQ(match.shift, Point{});
}

TEST(Portrait, WhatTurnedRoundIsLookedForWhereItCameFrom) {
  Stage stage({160, 90});
  const objects::Portrait portrait = learntAt(stage, {60, 30});
  stage.paint(thingAt({52, 30}));
  objects::PortraitScratch scratch;
  const auto placeWith = [&](Point turn) {
    return placeOf(objects::findPortrait(portrait, stage.scene(), {{60, 30}, {12, 6}, 1, turn},
                                         scratch))
        .x;
  };
  EXPECT_GT(placeWith({}), -8);
  EXPECT_EQ(placeWith({8, 0}), -8);
}

TEST(Portrait, ASliverBetweenTheCoarsePlacesIsFound) {
  for (int width = 3; width < 6; ++width)
    for (int off = -3; off <= 3; ++off) {
      Stage stage({200, 90});
      const objects::Portrait portrait = learntAt(stage, {60, 30});
      // Its outermost columns mix with the ground, and another thing covers the place beside it.
      stage.paint([&](int x, int y) {
        const int grey = thingAt({60 + off, 30})(x, y);
        return x >= 60 + off + width ? (x >= 90 ? 250 : -1) : x == 60 + off ? grey / 2 : grey;
      });
      stage.take({90, 0, 110, 90});
      objects::PortraitScratch scratch;
      const objects::PortraitMatch match =
          objects::findPortrait(portrait, stage.scene(), {{60, 30}, {25, 15}, 13, {}}, scratch);
      EXPECT_NEAR(placeOf(match).x, off, 1) << width;
      EXPECT_GT(match.agreeing, 20u) << width << ' ' << off;
    }
}

TEST(Portrait, DistanceCostsUnlessItWasUnseenForLongOrColoursWeighMore) {
  Stage stage({160, 90});
  const objects::Portrait portrait = learntAt(stage, {40, 30});
  stage.paint([](int x, int y) {
    const int near = thingAt({41, 30})(x, y);
    return near >= 0 ? near - 5 : thingAt({64, 30})(x, y);
  });
  objects::PortraitScratch scratch;
  EXPECT_EQ(
      placeOf(objects::findPortrait(portrait, stage.scene(), {{40, 30}, {30, 4}, 1, {}}, scratch))
          .x,
      1);
  EXPECT_EQ(
      placeOf(objects::findPortrait(portrait, stage.scene(), {{40, 30}, {30, 4}, 50, {}}, scratch))
          .x,
      24);
  const objects::PortraitSearch byColours{{40, 30}, {30, 4}, 1, {}, 50 * 256};
  EXPECT_EQ(placeOf(objects::findPortrait(portrait, stage.scene(), byColours, scratch)).x, 24);
}

TEST(Portrait, WhatItLosesFadesAndWhatItGainsIsLearnt) {
  Stage stage({120, 90});
  objects::Portrait portrait = learntAt(stage, {40, 30});
  stage.paint([thing = thingAt({40, 30})](int x, int y) { return y < 45 ? thing(x, y) : -1; });
  objects::learn(portrait, stage.scene(), {40, 30}, kThing, stage.owner(), 1);
  EXPECT_EQ(find(portrait, stage, {40, 30}).samples, 600u);
  EXPECT_LT(portrait.usual, 256);
  for (int i = 0; i < 8; ++i)
    objects::learn(portrait, stage.scene(), {40, 30}, kThing, stage.owner(), 1);
  EXPECT_EQ(find(portrait, stage, {40, 30}).samples, 300u);
}

TEST(Portrait, AnotherSizeBeginsAnew) {
  Stage stage({120, 90});
  objects::Portrait portrait = learntAt(stage, {40, 30});
  objects::learn(portrait, stage.scene(), {40, 30}, {30, 30}, stage.owner(), 1);
  EXPECT_EQ(portrait.frames, 1u);
  EXPECT_EQ(portrait.sizePx, (Size{30, 30}));
}

TEST(Portrait, LargeThingsHaveNoMoreThanSomeThousandSamples) {
  Stage stage({1010, 810}, 4);
  objects::Portrait portrait;
  stage.paint([](int x, int y) {
    return Box{5, 5, 997, 799}.contains({x, y}) ? x / 90 % 5 * 40 + y / 110 % 3 * 30 : -1;
  });
  for (int i = 0; i < 4; ++i)
    objects::learn(portrait, stage.scene(), {5, 5}, {997, 799}, stage.owner(), 1);
  EXPECT_LE(portrait.samples.size(), 1500u);
  const Point place = placeOf(find(portrait, stage, {7, 4}, {3, 3}));  // Cells are of 4 px.
  EXPECT_NEAR(place.x, -2, 1);
  EXPECT_NEAR(place.y, 1, 1);
}

TEST(Portrait, PlacesBeyondTheFrameAreFine) {
  Stage stage({30, 20}, 2);
  const objects::Portrait portrait = learntAt(stage, {-5, -9});
  EXPECT_GT(find(portrait, stage, {-5, -9}).agreeing, 0u);
  EXPECT_EQ(find(portrait, stage, {-500, 400}).seen, 0u);
  size_t visited = 0;
  for (const Point corner : {Point{-5, -9}, Point{25, 15}, Point{-100, 0}, Point{900, 900}})
    objects::forPortraitCells(portrait, stage.scene(), corner, [&](size_t cell, bool) {
      ASSERT_LT(cell, stage.cells());
      ++visited;
    });
  EXPECT_GT(visited, 0u);
}

TEST(Portrait, ItsCellsAreThoseItCovers) {
  Stage stage({60, 60}, 2);
  const objects::Portrait portrait = learntAt(stage, {11, 13});
  size_t cells = 0, alike = 0;
  objects::forPortraitCells(portrait, stage.scene(), {11, 13}, [&](size_t, bool isAlike) {
    ++cells;
    alike += isAlike;
  });
  EXPECT_EQ(cells, 10u * 15u);
  EXPECT_EQ(alike, cells);
}

/// The search to the letter: all samples at all places.
class PlainSearch {
 public:
  PlainSearch(const objects::Portrait& portrait, const objects::PortraitScene& scene,
              const objects::PortraitSearch& where)
      : p_(portrait), scene_(scene), where_(where) {}

  [[nodiscard]] objects::PortraitMatch find() const {
    const int skip = p_.grid.area() > 300 ? 2 : 1;
    const Point reach = where_.reach, stride{(reach.x + 3) / 4, (reach.y + 3) / 4};
    const Point from = placeOf(
        bestOf({}, {reach.x / stride.x * stride.x, reach.y / stride.y * stride.y}, stride, skip));
    const Key best = std::min(climb(from, stride, skip), climb({}, stride, skip));
    const objects::PortraitMatch at = scoreAt(placeOf(best), 1);
    const auto top = [&](Point step) {
      const auto gainAt = [&](int n) {
        return scoreAt({placeOf(best).x + n * step.x, placeOf(best).y + n * step.y}, 1).gain;
      };
      const int64_t bend = 2 * at.gain - gainAt(-1) - gainAt(1);
      if (bend <= 0) return 0;
      return static_cast<int>(
          std::clamp<int64_t>(divideRounded(8 * (gainAt(1) - gainAt(-1)), bend), -8, 8));
    };
    objects::PortraitMatch match = at;
    match.shift = {placeOf(best).x * 16 + top({1, 0}), placeOf(best).y * 16 + top({0, 1})};
    match.gain -= costOf(placeOf(best), at.samples);
    return match;
  }

 private:
  using Key = std::tuple<int64_t, int, int, int>;
  static Point placeOf(const Key& key) { return {std::get<3>(key), std::get<2>(key)}; }

  /// 0 outside, 1 covered, 2 ground, 3 thing.
  [[nodiscard]] int stateAt(int x, int y) const {
    const objects::GroupGrid& e = scene_.evidence;
    if (!boundsOf(e.frame).contains({x, y})) return 0;
    const size_t cell = e.at(x / e.stepPx, y / e.stepPx);
    return scene_.taken[cell] != 0 ? 1 : e.group[cell] == 0 ? 2 : 3;
  }
  [[nodiscard]] objects::PortraitMatch scoreAt(Point shift, int skip) const {
    objects::PortraitMatch score;
    const int beside = scene_.evidence.stepPx;
    const Point sides[] = {{-beside, 0}, {beside, 0}, {0, -beside}, {0, beside}};
    for (int row = 0; row < p_.grid.height; row += skip)
      for (int column = 0; column < p_.grid.width; column += skip) {
        const objects::PortraitSample& s =
            p_.samples[static_cast<size_t>(row * p_.grid.width + column)];
        if (2 * s.weight < std::min(p_.frames, 8u) || s.weight == 0) continue;
        const int x = where_.corner.x + shift.x + column * p_.stepPx;
        const int y = where_.corner.y + shift.y + row * p_.stepPx;
        ++score.samples;
        score.covered += stateAt(x, y) == 1;
        score.ground += stateAt(x, y) == 2;
        score.gain -= stateAt(x, y) == 2 ? 2 : 0;
        if (stateAt(x, y) != 3) continue;
        ++score.seen;
        const Picture& picture = scene_.picture;
        const int difference = std::abs(s.red - picture.red().at(x, y)) +
                               std::abs(s.green - picture.green().at(x, y)) +
                               std::abs(s.blue - picture.blue().at(x, y));
        const int gain = std::max(-8, 8 - difference / 4);
        score.gain += gain;
        score.agreeing += gain > 0;
        for (int side = 0; side < 4 && gain > 0; ++side)
          if ((s.edges >> side & 1) != 0 && stateAt(x + sides[side].x, y + sides[side].y) == 2)
            score.gain += 8;
      }
    return score;
  }
  [[nodiscard]] int64_t costOf(Point shift, int64_t samples) const {
    const int64_t width = p_.sizePx.width + 3 * where_.turn.x;
    const int64_t height = p_.sizePx.height + 3 * where_.turn.y;
    const int64_t across = shift.x * height, down = shift.y * width;
    return (across * across + down * down) * 72 * samples /
           (width * width * height * height * where_.calm);
  }
  [[nodiscard]] Key bestOf(Point middle, Point around, Point stride, int skip) const {
    Key best{INT64_MAX, 0, 0, 0};
    for (int y = middle.y - around.y; y <= middle.y + around.y; y += stride.y)
      for (int x = middle.x - around.x; x <= middle.x + around.x; x += stride.x) {
        if (std::abs(x) > where_.reach.x || std::abs(y) > where_.reach.y) continue;
        const objects::PortraitMatch score = scoreAt({x, y}, skip);
        best = std::min(best, Key{costOf({x, y}, score.samples) - score.gain, x * x + y * y, y, x});
      }
    return best;
  }
  [[nodiscard]] Key climb(Point place, Point stride, int skip) const {
    while (stride.x > 1 || stride.y > 1) {
      stride = {(stride.x + 1) / 2, (stride.y + 1) / 2};
      place = placeOf(bestOf(place, {2 * stride.x, 2 * stride.y}, stride, skip));
    }
    return bestOf(place, {1, 1}, {1, 1}, 1);
  }

  const objects::Portrait& p_;
  const objects::PortraitScene& scene_;
  const objects::PortraitSearch& where_;
};

void expectSame(const objects::PortraitMatch& a, const objects::PortraitMatch& b) {
  EXPECT_EQ(a.shift, b.shift);
  EXPECT_EQ(a.gain, b.gain);
  EXPECT_EQ(std::tuple(a.samples, a.agreeing, a.seen, a.covered, a.ground),
            std::tuple(b.samples, b.agreeing, b.seen, b.covered, b.ground));
}

/// Things of spots in which noise changes, partly hidden, partly out of the frame.
TEST(Portrait, TheSearchIsThatOfAllSamplesAtAllPlaces) {
  for (uint32_t seed = 0; seed < 24; ++seed) {
    const auto random = [&](int x, int y, uint32_t what) {
      return static_cast<int>(
          mixHash(static_cast<uint32_t>(x), static_cast<uint32_t>(y), seed * 8 + what) >> 8);
    };
    Stage stage({90, 70}, 1 + static_cast<int>(seed % 3));
    const Size size{10 + random(1, 0, 1) % 30, 8 + random(2, 0, 1) % 30};
    const Point corner{seed % 4 == 0 ? -6 : 30, seed % 5 == 0 ? 50 : 20};
    const auto paintAt = [&](Point at, int noise) {
      stage.paint([&](int x, int y) {
        const Point p{x - at.x, y - at.y};
        if (!boundsOf(size).contains(p) || (p.x < 5 && p.y < 5)) return -1;
        return 40 + random(p.x / 4, p.y / 3, 2) % 120 + random(x, y, 3) % (noise + 1);
      });
    };
    objects::Portrait portrait;
    paintAt(corner, 4);
    for (int i = 0; i < 6; ++i)
      objects::learn(portrait, stage.scene(), corner, size, stage.owner(), 1);
    paintAt({corner.x + random(3, 0, 1) % 9 - 4, corner.y + random(4, 0, 1) % 7 - 3}, 30);
    if (seed % 2 == 0) stage.take({corner.x + 8, 0, 6, 70});
    objects::PortraitScratch scratch;
    const objects::PortraitSearch where{
        corner, {6 + random(5, 0, 1) % 6, 6}, 1 + random(6, 0, 1) % 4, {}};
    expectSame(objects::findPortrait(portrait, stage.scene(), where, scratch),
               PlainSearch(portrait, stage.scene(), where).find());
  }
}

TEST(Portrait, WhatIsWholeIsFoundWithoutLookingAtAllSamplesAtAllPlaces) {
  Stage stage({120, 90});
  const objects::Portrait portrait = learntAt(stage, {40, 30});
  stage.paint(thingAt({43, 28}));
  objects::PortraitScratch scratch;
  const objects::PortraitSearch where{{40, 30}, {10, 10}, 1, {}};
  EXPECT_EQ(placeOf(objects::findPortrait(portrait, stage.scene(), where, scratch)),
            (Point{3, -2}));
  EXPECT_LT(scratch.looks, 20'000u);  // All of them: 36 000.
}

}  // namespace
}  // namespace rg
