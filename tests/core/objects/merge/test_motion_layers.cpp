// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/merge/motion_layers.hpp"
#include "tests/core/scenes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace rg {
namespace {

using testing::ElementsAre;

constexpr int kCell = 8;  ///< Pixels that a character stands for.

struct Trend {
  int dx = 0;  ///< In pixels per frame.
  uint16_t reliability = 200;
};

/// The groups of the regions '1', '2' … of a drawing, that start as one. expected: numbers of
/// tracks, 0 = none.
std::vector<uint32_t> partsOf(const std::vector<std::string>& rows, const std::vector<Trend>& shown,
                              const std::vector<uint32_t>& expected = {}) {
  const Size size{static_cast<int>(rows[0].size()) * kCell, static_cast<int>(rows.size()) * kCell};
  const auto at = [&](int x, int y) {
    const char c = rows[static_cast<size_t>(y / kCell)][static_cast<size_t>(x / kCell)];
    return c == '.' ? 0 : c - '0';
  };
  auto labels = scenes::label(scenes::paintGrey(size, [](int, int) { return 0; }),
                              static_cast<uint32_t>(shown.size()), at);
  motion::Motion trends;
  trends.size = size;
  trends.status = Status::Ok;
  trends.graph = *graph::makeStage(scenes::contextWith(1))->process(std::move(labels), {});
  for (const Trend& trend : shown)
    trends.regions.push_back({trend.dx * motion::kMotionUnit, 0, 0, trend.reliability});
  std::vector<objects::TrackIndex> tracks(shown.size());
  std::transform(expected.begin(), expected.end(), tracks.begin(), objects::TrackIndex::ofNumber);
  std::vector<uint32_t> groupOf(shown.size(), 0);
  objects::LayerScratch scratch;
  objects::partGroups(trends, tracks, scratch, groupOf);
  return groupOf;
}

TEST(MotionLayers, ALegThatSaysNothingDoesNotTieTwoWhoPass) {
  EXPECT_THAT(partsOf({"11.33", "11.33", "11233", "11233"}, {{5}, {0, 0}, {-5}}),
              ElementsAre(0, 0, 1));
}

TEST(MotionLayers, WhatMovesAlikeIsOneThing) {
  EXPECT_THAT(partsOf({"1133", "1133", "2233"}, {{5}, {6}, {5}}), ElementsAre(0, 0, 0));
}

TEST(MotionLayers, WhatWasLeftBehindIsNoPartOfTheWalker) {
  EXPECT_THAT(partsOf({"1122", "1122", "1122"}, {{0}, {6}}), ElementsAre(0, 1));
}

TEST(MotionLayers, AStandingLegBelongsToTheBodyAboveIt) {
  EXPECT_THAT(partsOf({"11", "11", "11", "2.", "2."}, {{6}, {0}}), ElementsAre(0, 0));
}

TEST(MotionLayers, WhatIsNotKnownToMoveIsNotParted) {
  EXPECT_THAT(partsOf({"1122", "1122"}, {{6, 20}, {-6, 200}}), ElementsAre(0, 0));
}

TEST(MotionLayers, WhatWasTwoObjectsStaysSoUntilItMovesAsOne) {
  const std::vector<std::string> pair{"1122", "1122"};
  EXPECT_THAT(partsOf(pair, {{6, 20}, {6, 20}}, {1, 2}), ElementsAre(0, 1));
  EXPECT_THAT(partsOf(pair, {{6, 20}, {6, 20}}, {1, 1}), ElementsAre(0, 0));
  EXPECT_THAT(partsOf(pair, {{5}, {6}}, {1, 2}), ElementsAre(0, 1));
  EXPECT_THAT(partsOf(pair, {{5}, {6}}, {1, 0}), ElementsAre(0, 0));
  EXPECT_THAT(partsOf(pair, {{6}, {6}}, {1, 2}), ElementsAre(0, 0));
}

TEST(MotionLayers, GroupsThatWereApartStaySo) {
  const auto labels = scenes::label(scenes::paintGrey({8, 8}, [](int, int) { return 0; }), 2,
                                    [](int x, int) { return x < 4 ? 1 : 2; });
  motion::Motion trends;
  trends.graph = *graph::makeStage(scenes::contextWith(1))->process(labels, {});
  trends.regions.assign(2, {16, 0, 0, 200});
  std::vector<uint32_t> groupOf{0, 1};
  objects::LayerScratch scratch;
  objects::partGroups(trends, std::vector<objects::TrackIndex>(2), scratch, groupOf);
  EXPECT_THAT(groupOf, ElementsAre(0, 1));
}

TEST(MotionLayers, TheLessThereIsTheMoreItHasToMoveOtherwise) {
  EXPECT_TRUE(objects::moveApart({30, 0, 100}, {0, 0, 100}, 24));
  EXPECT_FALSE(objects::moveApart({20, 0, 100}, {0, 0, 100}, 24));
  EXPECT_FALSE(objects::moveApart({30, 0, 100}, {0, 0, 1000}, 24));
  EXPECT_TRUE(objects::moveApart({90, 0, 100}, {0, 0, 1000}, 24));
  EXPECT_FALSE(objects::moveApart({90, 0, 0}, {0, 0, 1000}, 24));
}

TEST(MotionLayers, WeightsOfAnySizeCompareAlike) {
  constexpr int64_t kHuge = int64_t{1} << 48;
  EXPECT_TRUE(objects::moveApart({2000, 2000, kHuge}, {-2000, -2000, kHuge}, 24));
  EXPECT_FALSE(objects::moveApart({30, 0, kHuge}, {0, 0, 10 * kHuge}, 24));
  EXPECT_FALSE(objects::moveApart({2000, 0, 1}, {0, 0, kHuge}, 24));
}

TEST(MotionLayers, NoRegionsAreNoGroups) {
  motion::Motion trends;
  trends.graph = std::make_shared<graph::Graph>();
  std::vector<uint32_t> groupOf;
  objects::LayerScratch scratch;
  objects::partGroups(trends, {}, scratch, groupOf);
  EXPECT_TRUE(groupOf.empty());
}

}  // namespace
}  // namespace rg
