// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/detection/search_windows.hpp"

#include <gtest/gtest.h>

#include <array>
#include <limits>
#include <string>
#include <vector>

namespace rg::detection {
namespace {

constexpr std::array kFrames{Size{640, 480}, Size{460, 480}, Size{1920, 1080}};
// Of OpenCV's cascades, of the paper, and of the usual ones for people.
constexpr std::array kWindows{Size{20, 20}, Size{24, 24}, Size{25, 25}, Size{14, 28},
                              Size{19, 23}, Size{22, 18}, Size{36, 18}, Size{60, 20},
                              Size{45, 11}, Size{48, 96}, Size{64, 128}};
constexpr std::array kFactors{1.05, 1.1, 1.2, 1.25, 1.5, 2.0};
struct Steps {
  double fine, coarse;
};
constexpr std::array kSteps{Steps{2, 1}, Steps{3.125, 3.125}, Steps{0.5, 4}};

std::vector<Scale> scalesFor(Size frame, Size window, double factor, Steps steps = {2, 1}) {
  ScaleParams params{frame, window, factor};
  params.fineStep = steps.fine;
  params.coarseStep = steps.coarse;
  auto scales = scalesOf(params);
  EXPECT_TRUE(scales) << scales.error().message;
  return scales ? *std::move(scales) : std::vector<Scale>();
}

/// Tries every place of the frame; false where an id's window, or a window's id, is another one.
bool matchesBruteForce(const WindowTable& table, const std::vector<Scale>& scales,
                       const std::vector<Box>& areas) {
  uint32_t id = 0;
  int range = 0;
  bool isSame = true;
  for (const Scale& scale : scales)
    for (const Box& area : areas) {
      for (int y = 0; y + scale.window.height <= area.bottom(); y += scale.stepPx)
        for (int x = 0; x + scale.window.width <= area.right(); x += scale.stepPx) {
          if (x < area.x || y < area.y) continue;
          const WindowPlace expected{range, {x, y}};
          isSame = isSame && placeOf(table, id) == expected && idOf(table, expected) == id;
          ++id;
        }
      ++range;
    }
  return isSame && id == table.count;
}

TEST(SearchWindows, EachIdIsItsWindowAndBackAgain) {
  uint64_t seen = 0;
  for (const Size frame : kFrames)
    for (const Size window : kWindows)
      for (const double factor : kFactors) {
        const auto scales = scalesFor(frame, window, factor);
        SearchWindows windows;
        ASSERT_TRUE(windows.lay(scales, std::array{boundsOf(frame)}));
        ASSERT_TRUE(matchesBruteForce(windows.table(), scales, {boundsOf(frame)}))
            << frame.width << "x" << frame.height << ", " << window.width << "x" << window.height
            << ", " << factor;
        seen += windows.table().count;
      }
  EXPECT_GT(seen, 10'000'000u);
}

TEST(SearchWindows, AnyStepWillDo) {
  for (const Size frame : {Size{640, 480}, Size{97, 1000}, Size{14, 28}})
    for (const Size window : kWindows)
      for (const Steps steps : kSteps) {
        const auto scales = scalesFor(frame, window, 1.07, steps);
        SearchWindows windows;
        ASSERT_TRUE(windows.lay(scales, std::array{boundsOf(frame)}));
        ASSERT_TRUE(matchesBruteForce(windows.table(), scales, {boundsOf(frame)}))
            << frame.width << "x" << frame.height << ", " << window.width << "x" << window.height
            << ", " << steps.fine;
      }
}

TEST(SearchWindows, WindowsOfAreasAreSomeOfTheFrames) {
  const Size frame{320, 240};
  const std::vector<Box> areas{
      {0, 0, 50, 240}, {51, 3, 90, 77}, {200, 200, 10, 10}, {150, 100, 170, 140}};
  const auto scales = scalesFor(frame, {14, 28}, 1.1);
  SearchWindows windows, whole;
  ASSERT_TRUE(windows.lay(scales, areas));
  ASSERT_TRUE(whole.lay(scales, std::array{boundsOf(frame)}));
  ASSERT_TRUE(matchesBruteForce(windows.table(), scales, areas));
  uint32_t inside = 0;
  for (uint32_t id = 0; id < whole.table().count; ++id) {
    const WindowPlace place = placeOf(whole.table(), id);
    const Size size = scales[static_cast<size_t>(place.range)].window;
    const Box box{place.at.x, place.at.y, size.width, size.height};
    for (const Box& area : areas) inside += intersect(box, area) == box;
  }
  EXPECT_EQ(windows.table().count, inside);
  EXPECT_GT(inside, 1000u);
}

TEST(SearchWindows, NoAreaOrTooSmallOnesHaveNoWindows) {
  const auto scales = scalesFor({320, 240}, {24, 24}, 1.1);
  SearchWindows windows;
  ASSERT_TRUE(windows.lay(scales, {}));
  EXPECT_EQ(windows.table().count, 0u);
  ASSERT_TRUE(windows.lay(scales, std::array{Box{1, 1, 23, 200}, Box{0, 0, 200, 23}}));
  EXPECT_EQ(windows.table().count, 0u);
  ASSERT_TRUE(windows.lay({}, std::array{Box{0, 0, 200, 200}}));
  EXPECT_EQ(windows.table().count, 0u);
}

TEST(SearchWindows, ScalesGrowByTheFactorUpToTheFrame) {
  const auto scales = scalesFor({640, 480}, {24, 24}, 1.25);
  ASSERT_EQ(scales.size(), 14u);
  EXPECT_EQ(scales.front(), (Scale{1, {24, 24}, 2}));
  EXPECT_EQ(scales[3], (Scale{1.953125, {47, 47}, 4}));
  EXPECT_EQ(scales[4], (Scale{2.44140625, {59, 59}, 2}));
  EXPECT_LE(scales.back().window.height, 480);
  EXPECT_GT(scales.back().window.height * 1.25, 480);
}

TEST(SearchWindows, SizesBoundTheScales) {
  ScaleParams params{{640, 480}, {14, 28}, 1.1};
  params.least = {0, 56};
  params.most = {0, 112};
  const auto scales = scalesOf(params);
  ASSERT_TRUE(scales);
  ASSERT_FALSE(scales->empty());
  for (const Scale& scale : *scales) {
    EXPECT_GE(scale.window.height, 56);
    EXPECT_LE(scale.window.height, 112);
  }
}

TEST(SearchWindows, WindowsWhoseSumsWouldOverflowAreLeftOut) {
  for (const Scale& scale : scalesFor({8192, 4320}, {24, 24}, 1.1))
    EXPECT_LE(scale.window.area(), kMostWindowPx);
}

TEST(SearchWindows, WhatCanNotBeIsAnError) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const ScaleParams& params :
       {ScaleParams{{0, 480}, {24, 24}}, ScaleParams{{640, 480}, {24, 0}},
        ScaleParams{{640, 480}, {24, 24}, 1.0}, ScaleParams{{640, 480}, {24, 24}, nan},
        ScaleParams{{640, 480}, {24, 24}, 1.1, 0}, ScaleParams{{640, 480}, {24, 24}, 1.1, 1, 0, 1},
        ScaleParams{{640, 480}, {24, 24}, 1.1, 1, 1, nan},
        ScaleParams{{640, 480}, {24, 24}, 1.0000001},
        ScaleParams{{640, 480}, {24, 24}, 1.1, 1e-300}})
    EXPECT_FALSE(scalesOf(params)) << params.scaleFactor;
  EXPECT_TRUE(scalesOf({{640, 480}, {24, 24}, std::numeric_limits<double>::infinity()}));
}

TEST(SearchWindows, MoreWindowsThanNumbersAreAnError) {
  const auto scales = scalesFor({8192, 4320}, {8, 8}, 1.01, {0.01, 0.01});
  SearchWindows windows;
  const auto laid = windows.lay(scales, std::array{Box{0, 0, 8192, 4320}});
  ASSERT_FALSE(laid);
  EXPECT_NE(laid.error().message.find("larger step"), std::string::npos);
  EXPECT_EQ(windows.table().count, 0u);
}

/// Equation (12) as printed rounds once only, so that windows of a row slide down along it.
TEST(SearchWindows, ThePrintedRowDriftsWhereOursIsStraight) {
  const auto scales = scalesFor({640, 480}, {24, 24}, 1.1);
  SearchWindows windows;
  ASSERT_TRUE(windows.lay(std::span(scales).first(1), std::array{Box{0, 0, 640, 480}}));
  const WindowRange& range = windows.ranges()[0];
  const auto last = static_cast<uint32_t>(range.columns) - 1;
  EXPECT_EQ(placeOf(windows.table(), last).at, (Point{616, 0}));
  const double printed = static_cast<double>(last) / range.columns * range.stepPx;
  EXPECT_EQ(static_cast<int>(printed), 1);
}

}  // namespace
}  // namespace rg::detection
