// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/detection/cascade.hpp"
#include "core/detection/cascade_window.hpp"
#include "core/detection/integral.hpp"
#include "core/detection/scaled_cascade.hpp"
#include "tests/core/detection/cascades.hpp"
#include "tests/core/fills.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <limits>
#include <string>

namespace rg::detection {
namespace {

using test::halvesCascade;

/// Of OpenCV's definition: rows above y whose columns lie between the diagonals that meet at (x,
/// y).
bool isAbove(int x, int y, int column, int row) {
  return row < y && std::abs(column - x + 1) <= y - row - 1;
}

TEST(Cascade, ATiltedRectangleHasThePixelsBetweenItsDiagonals) {
  for (int width = 1; width < 8; ++width)
    for (int height = 1; height < 8; ++height) {
      const Box box{height + 1, 2, width, height};
      int64_t pixels = 0;
      for (int row = 0; row < 20; ++row)
        for (int column = 0; column < 20; ++column) {
          const int corners = isAbove(box.x, box.y, column, row) -
                              isAbove(box.x - height, box.y + height, column, row) -
                              isAbove(box.x + width, box.y + width, column, row) +
                              isAbove(box.x + width - height, box.y + width + height, column, row);
          const int own = row - box.y;
          const bool isIn =
              own >= 0 && own < width + height && tiltedRow(box, own).contains({column, row});
          ASSERT_EQ(corners, isIn ? 1 : 0)
              << width << "x" << height << ": " << column << ", " << row;
          pixels += isIn;
        }
      EXPECT_EQ(pixels, 2 * width * height);
    }
}

TEST(Cascade, AGoodOneIsAccepted) {
  const auto checked = check(halvesCascade());
  EXPECT_TRUE(checked) << checked.error().message;
}

struct Damage {
  const char* what;
  std::function<void(Cascade&)> make;
};

TEST(Cascade, WhatPointsNowhereIsRefused) {
  const float nan = std::numeric_limits<float>::quiet_NaN();
  const float inf = std::numeric_limits<float>::infinity();
  const Damage damages[] = {
      {"no window", [](Cascade& c) { c.window = {}; }},
      {"a small window",
       [](Cascade& c) {
         c.window = {2, 20};
       }},
      {"a huge window",
       [](Cascade& c) {
         c.window = {1 << 20, 1 << 20};
       }},
      {"no stages", [](Cascade& c) { c.stages.clear(); }},
      {"a stage without trees", [](Cascade& c) { c.stages[1].trees = 0; }},
      {"a stage of more trees", [](Cascade& c) { c.stages[1].trees = INT32_MAX; }},
      {"a stage of others' trees", [](Cascade& c) { c.stages[1].firstTree = 0; }},
      {"trees without stage", [](Cascade& c) { c.stages.pop_back(); }},
      {"a threshold", [=](Cascade& c) { c.stages[0].threshold = nan; }},
      {"a node's threshold", [=](Cascade& c) { c.branches[0].threshold = inf; }},
      {"a leaf", [=](Cascade& c) { c.leaves[1] = nan; }},
      {"fewer leaves", [](Cascade& c) { c.leaves.pop_back(); }},
      {"fewer nodes", [](Cascade& c) { c.branches.pop_back(); }},
      {"fewer of both",
       [](Cascade& c) {
         c.branches.pop_back();
         c.nodeFeatures.pop_back();
       }},
      {"no feature", [](Cascade& c) { c.nodeFeatures[0] = 99; }},
      {"a negative feature", [](Cascade& c) { c.nodeFeatures[0] = -1; }},
      {"a node behind the last", [](Cascade& c) { c.branches[0].less = 1; }},
      {"a node that leads to itself", [](Cascade& c) { c.branches[0].less = 0; }},
      {"a leaf behind the last", [](Cascade& c) { c.branches[0].other = -3; }},
      {"a tree of too many nodes", [](Cascade& c) { c.trees[0].nodes = 1000; }},
      {"a tree of none", [](Cascade& c) { c.trees[0].nodes = 0; }},
      {"a tree elsewhere", [](Cascade& c) { c.trees[1].firstNode = 0; }},
      {"leaves elsewhere", [](Cascade& c) { c.trees[1].firstLeaf = 0; }},
      {"a weight", [=](Cascade& c) { c.features[0].rects[1].weight = inf; }},
      {"no weight", [](Cascade& c) { c.features[0].rects[0].weight = 0; }},
      {"a rectangle to the right", [](Cascade& c) { c.features[0].rects[0].box.x = 8; }},
      {"a rectangle to the left", [](Cascade& c) { c.features[0].rects[0].box.x = -1; }},
      {"a rectangle below", [](Cascade& c) { c.features[0].rects[0].box.height = 99; }},
      {"a rectangle beyond numbers",
       [](Cascade& c) {
         c.features[0].rects[0].box = {INT32_MAX, 0, INT32_MAX, 1};
       }},
      {"an empty rectangle", [](Cascade& c) { c.features[0].rects[0].box.width = 0; }},
      {"a tilted rectangle to the left", [](Cascade& c) { c.features[0].isTilted = true; }},
      {"too many stages", [](Cascade& c) { c.stages.resize(kMostStages + 1); }},
      {"too many features", [](Cascade& c) { c.features.resize(kMostNodes + 1); }},
  };
  for (const Damage& damage : damages) {
    Cascade cascade = halvesCascade();
    damage.make(cascade);
    EXPECT_FALSE(check(cascade)) << damage.what;
  }
}

TEST(Cascade, SumsAreThoseOfThePixels) {
  const Size size{67, 31};
  Image<uint8_t> luma(size);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      luma.at(x, y) = static_cast<uint8_t>(test::hashOf(x, y, 3));
  Image<uint32_t> sums({size.width + 1, size.height + 1});
  Image<double> squares(sums.size());
  const Box area{5, 4, 40, 21};
  sumArea(luma, area, {sums, squares});
  for (int y = area.y; y <= area.bottom(); ++y)
    for (int x = area.x; x <= area.right(); ++x) {
      uint32_t sum = 0;
      double squared = 0;
      for (int r = area.y; r < y; ++r)
        for (int c = area.x; c < x; ++c) {
          sum += luma.at(c, r);
          squared += luma.at(c, r) * luma.at(c, r);
        }
      ASSERT_EQ(sums.at(x, y), sum) << x << ", " << y;
      ASSERT_EQ(squares.at(x, y), squared) << x << ", " << y;
    }
}

/// The left half is brighter than the right one, at any scale: the cascade's first stage says so.
TEST(Cascade, AScaledWindowSeesWhatTheTrainedOneSaw) {
  const Cascade cascade = halvesCascade();
  for (const double factor : {1.0, 1.1, 1.37, 2.0, 3.0, 6.5}) {
    const Size window{static_cast<int>(std::floor(cascade.window.width * factor + .5)),
                      static_cast<int>(std::floor(cascade.window.height * factor + .5))};
    for (const bool isBrightLeft : {true, false}) {
      Image<uint8_t> luma(window);
      for (int y = 0; y < window.height; ++y)
        for (int x = 0; x < window.width; ++x)
          luma.at(x, y) = (2 * x < window.width) == isBrightLeft ? 200 : 40;
      Image<uint32_t> sums({window.width + 1, window.height + 1});
      Image<double> squares(sums.size());
      sumIntegrals(luma, {sums, squares});
      const SumLayout layout{1, 0, sums.view().strideBytes / 4, squares.view().strideBytes / 8};
      const ScaledCascade scaled(cascade, {factor, window, 1}, layout);
      EXPECT_EQ(judgeWindow(scaled.view(), sums.row(0), squares.row(0)), isBrightLeft ? 2 : 0)
          << factor;
    }
  }
}

TEST(Cascade, AFlatWindowIsNoObject) {
  EXPECT_EQ(contrastFactor(100 * 50.0, 100 * 2500.0, 100), 0);
  EXPECT_EQ(contrastFactor(100 * 50.0, 100 * 2600.0, 100), 0);  // A deviation of ten.
  EXPECT_GT(contrastFactor(100 * 50.0, 100 * 2625.0, 100), 0);
}

}  // namespace
}  // namespace rg::detection
