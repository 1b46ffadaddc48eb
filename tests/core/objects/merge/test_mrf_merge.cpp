// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/merge/mrf_merge.hpp"
#include "tests/support/best_partition.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace rg {
namespace {

using objects::GroupIndex;
using objects::TrackIndex;
using segmentation::RegionLabel;
using ::testing::ElementsAre;

std::vector<uint32_t> solve(uint32_t nodeCount, const std::vector<objects::WeightedArc>& arcs) {
  objects::MergeScratch scratch;
  std::vector<uint32_t> groupOf;
  objects::minimise(nodeCount, arcs, scratch, groupOf);
  return groupOf;
}

/// Regions of 100 px in a row, neighbours share `borderPx`.
struct Row {
  std::shared_ptr<graph::Graph> graph = std::make_shared<graph::Graph>();
  motion::Motion motion;

  explicit Row(const std::vector<motion::RegionMotion>& motions, uint32_t borderPx = 4) {
    graph->size = {512, 512};  // An arc costs as much as 32 px of border.
    for (size_t i = 0; i < motions.size(); ++i) {
      const int x = static_cast<int>(i) * 10;
      graph->regions.push_back({100, {x, 0, 10, 10}, (x + 5) * 256, 5 * 256, {}});
      if (i > 0)
        graph->arcs.push_back({RegionLabel::ofIndex(i - 1), RegionLabel::ofIndex(i), borderPx, 0});
    }
    motion.graph = graph;
    motion.regions = motions;
  }
  std::vector<uint32_t> groups(const std::vector<TrackIndex>& predicted = {}) const {
    std::vector<objects::ArcEnergy> energies;
    std::vector<objects::WeightedArc> arcs;
    objects::weighArcs(motion, predicted, {}, energies);
    objects::listArcs(*graph, energies, arcs);
    return solve(static_cast<uint32_t>(motion.regions.size()), arcs);
  }
};

constexpr motion::RegionMotion kStill{0, 0, 0, motion::kFullReliability};
constexpr motion::RegionMotion kFast{10 * motion::kMotionUnit, 0, 0, motion::kFullReliability};
constexpr motion::RegionMotion kUnknown{};

TEST(MrfMerge, RegionsThatMoveApartAreDifferentGroups) {
  EXPECT_THAT(Row({kStill, kStill, kFast, kFast}).groups(), ElementsAre(0, 0, 1, 1));
}

TEST(MrfMerge, RegionsWithoutReliableMotionAreJoinedByGeometry) {
  EXPECT_THAT(Row({kUnknown, kUnknown, kUnknown}).groups(), ElementsAre(0, 0, 0));
  const motion::RegionMotion wild{300, -300, 0, 0};
  EXPECT_THAT(Row({kStill, wild, kStill}).groups(), ElementsAre(0, 0, 0));
}

/// What the arc between two regions of a motion costs when it is broken.
objects::ArcEnergy energyOf(const Row& row) {
  std::vector<objects::ArcEnergy> energies;
  objects::weighArcs(row.motion, {}, {}, energies);
  return energies.front();
}

TEST(MrfMerge, ABorderIsCheaperToBreakWhereAnEdgeIsSeen) {
  const Row row({kStill, kStill}, 10);
  const objects::MergeWeights weights;
  EXPECT_EQ(energyOf(row).border, 10 * weights.border);
  row.graph->arcs[0].contrast = 10 * 16;
  EXPECT_EQ(energyOf(row).border, 5 * weights.border);
  row.graph->arcs[0].contrast = 10 * 240;
  EXPECT_EQ(energyOf(row).border, 10 * weights.border / 16);
}

TEST(MrfMerge, AnArcIsCheaperToBreakBetweenUnlikeColours) {
  const Row row({kStill, kStill}, 10);
  const objects::MergeWeights weights;
  EXPECT_EQ(energyOf(row).arc, 32 * weights.arc);
  row.graph->regions[0].colour = {10, 100, 50};
  row.graph->regions[1].colour = {0, 130, 50};
  EXPECT_EQ(energyOf(row).arc, 16 * weights.arc);
  EXPECT_EQ(energyOf(row).border, 10 * weights.border);
}

TEST(MrfMerge, AnArcCostsMoreInALargerFrameAsItsBordersDo) {
  const Row row({kStill, kStill}, 10);
  row.graph->size = {1024, 1024};
  EXPECT_EQ(energyOf(row).arc, 64 * objects::MergeWeights{}.arc);
}

TEST(MrfMerge, AnEdgePartsWhatMovesALittleApart) {
  const motion::RegionMotion apart{32, 0, 0, motion::kFullReliability};
  const Row row({kStill, apart}, 10);
  EXPECT_THAT(row.groups(), ElementsAre(0, 0));
  row.graph->arcs[0].contrast = 10 * 64;
  row.graph->regions[1].colour = {64, 64, 64};
  EXPECT_THAT(row.groups(), ElementsAre(0, 1));
}

TEST(MrfMerge, SpeedsBelowTheThresholdAreAlike) {
  const motion::RegionMotion slow{motion::kMotionUnit, 0, 0, motion::kFullReliability};
  EXPECT_THAT(Row({kStill, slow}, 0).groups(), ElementsAre(0, 0));
}

TEST(MrfMerge, ALongBorderOutweighsMotion) {
  EXPECT_THAT(Row({kStill, kFast}, 4).groups(), ElementsAre(0, 1));
  EXPECT_THAT(Row({kStill, kFast}, 80).groups(), ElementsAre(0, 0));
}

TEST(MrfMerge, PredictionHoldsTogetherWhatWasOneObject) {
  const Row row({kStill, {10 * motion::kMotionUnit, 0, 0, 200}}, 2);
  EXPECT_THAT(row.groups(), ElementsAre(0, 1));
  EXPECT_THAT(row.groups({TrackIndex::ofIndex(6), TrackIndex::ofIndex(6)}), ElementsAre(0, 0));
  EXPECT_THAT(row.groups({TrackIndex::ofIndex(6), TrackIndex::ofIndex(7)}), ElementsAre(0, 1));
}

TEST(MrfMerge, NoNodesAndNoArcsAreFine) {
  EXPECT_TRUE(solve(0, {}).empty());
  EXPECT_THAT(solve(3, {}), ElementsAre(0, 1, 2));
}

TEST(MrfMerge, AGroupIsConnectedByArcs) {
  // 0 and 2 like 1 apart from each other; without arcs between them they are no group.
  EXPECT_THAT(solve(3, {{0, 1, -5}, {1, 2, -5}}), ElementsAre(0, 1, 2));
}

TEST(MrfMerge, AChainOfRisingWeightsIsJoinedWithinItsRounds) {
  std::vector<objects::WeightedArc> arcs;
  for (uint32_t i = 0; i + 1 < 1000; ++i) arcs.push_back({i, i + 1, i + 1});
  const auto groups = solve(1000, arcs);
  EXPECT_EQ(*std::max_element(groups.begin(), groups.end()), 0u);
}

TEST(MrfMerge, StartsFromAPartitionOnlyWhereThatIsBetter) {
  const std::vector<objects::WeightedArc> arcs{{0, 1, 5}, {1, 2, -9}, {2, 3, 5}};
  objects::MergeScratch scratch;
  std::vector<uint32_t> groupOf{0, 1, 1, 0};
  objects::minimise(4, arcs, scratch, groupOf);
  EXPECT_THAT(groupOf, ElementsAre(0, 0, 1, 1));
}

std::vector<objects::WeightedArc> randomGrid(int side, std::mt19937& random) {
  std::uniform_int_distribution<int> weight(-1000, 1000);
  std::vector<objects::WeightedArc> arcs;
  for (int i = 0; i < side * side; ++i) {
    const auto node = static_cast<uint32_t>(i);
    if (i % side + 1 < side) arcs.push_back({node, node + 1, weight(random)});
    if (i / side + 1 < side)
      arcs.push_back({node, node + static_cast<uint32_t>(side), weight(random)});
  }
  return arcs;
}

TEST(MrfMerge, ComesCloseToTheOptimumOfRandomGrids) {
  std::mt19937 random(5);
  double gapSum = 0;
  int optimal = 0;
  constexpr int kGraphs = 300;
  for (int i = 0; i < kGraphs; ++i) {
    const auto arcs = randomGrid(4, random);
    const int64_t best = testing::bestKeptWeight(16, arcs);
    const int64_t kept = objects::keptWeight(arcs, solve(16, arcs));
    ASSERT_LE(kept, best);
    optimal += kept == best;
    gapSum += static_cast<double>(best - kept) / static_cast<double>(best);
  }
  RecordProperty("optimal", optimal);
  EXPECT_LE(gapSum / kGraphs, 0.0015);
  EXPECT_GE(optimal, kGraphs * 93 / 100);
}

TEST(MrfMerge, TheOrderOfTheArcsChangesNothing) {
  std::mt19937 random(11);
  for (int i = 0; i < 50; ++i) {
    auto arcs = randomGrid(8, random);
    for (objects::WeightedArc& arc : arcs) arc.weight /= 300;  // Many ties.
    const auto groups = solve(64, arcs);
    std::shuffle(arcs.begin(), arcs.end(), random);
    EXPECT_EQ(solve(64, arcs), groups);
  }
}

TEST(MrfMerge, GroupsAreMeansByAreaAndReliability) {
  Row row({{16, 0, 0, 256}, {0, 32, 0, 64}, kUnknown});
  std::vector<objects::Group> groups;
  objects::describeGroups(
      row.motion,
      std::vector{GroupIndex::ofIndex(0), GroupIndex::ofIndex(0), GroupIndex::ofIndex(1)}, groups);
  ASSERT_EQ(groups.size(), 2u);
  EXPECT_EQ(groups[0].areaPx, 200u);
  EXPECT_EQ(groups[0].box, (Box{0, 0, 20, 10}));
  EXPECT_EQ(groups[0].dx, 13);  // 16 · 256 / 320, rounded
  EXPECT_EQ(groups[0].dy, 6);
  EXPECT_EQ(groups[0].reliability, 160);
  EXPECT_EQ(groups[1].reliability, 0);
}

}  // namespace
}  // namespace rg
