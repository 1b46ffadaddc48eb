// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/merge/ground_merge.hpp"
#include "core/objects/merge/own_motion.hpp"

#include <gmock/gmock.h>

namespace rg {
namespace {

using segmentation::RegionLabel;
using testing::ElementsAre;

/// Regions in a row, each with a border of 20 with the next. Those that have a gain were tried.
struct Row {
  explicit Row(std::vector<objects::OwnMotion> motions) : own(std::move(motions)) {
    graph.size = {512, 512};  // An arc costs as much as 32 px of border.
    graph.regions.resize(own.size());
    for (graph::Region& region : graph.regions) region.areaPx = 400;
    for (size_t i = 1; i < own.size(); ++i)
      graph.arcs.push_back({RegionLabel::ofIndex(i - 1), RegionLabel::ofIndex(i), 20, 0});
    moves.assign(own.size(), 0);
  }

  /// Groups of the regions; `ground` comes to hold that of the ground.
  std::vector<uint32_t> groups(const objects::MergeWeights& weights = {}) {
    motion::Motion motion;
    motion.graph = std::make_shared<graph::Graph>(graph);
    motion.regions.resize(own.size());
    std::vector<objects::ArcEnergy> arcs;
    objects::weighArcs(motion, {}, weights, arcs);
    std::vector<objects::GroundEnergy> energies;
    for (const objects::OwnMotion& of : own)
      energies.push_back(objects::weighGround(of.gain, 400, isExpected, weights));
    std::vector<uint8_t> isOpen;
    for (const objects::OwnMotion& of : own) isOpen.push_back(of.isTried());
    std::vector<uint32_t> groupOf;
    for (uint32_t i = 0; i < own.size(); ++i) groupOf.push_back(i);
    objects::GroundScratch scratch;
    objects::MergeScratch merging;
    ground = objects::minimiseWithGround(graph, arcs, {energies, isOpen, moves}, scratch, merging,
                                         groupOf);
    return groupOf;
  }

  graph::Graph graph;
  std::vector<objects::OwnMotion> own;
  std::vector<uint8_t> moves;
  bool isExpected = true;
  objects::GroupIndex ground;
};

objects::OwnMotion gains(int64_t units) {
  return {{3, 0}, units * objects::kGainUnit};
}

TEST(GroundMerge, WithoutRegionsTheGroundHasNoGroup) {
  Row row({});
  EXPECT_THAT(row.groups(), ElementsAre());
  EXPECT_FALSE(row.ground);
}

TEST(GroundMerge, WhatMovesIsPartedFromTheGround) {
  Row row({{}, gains(500), {}});
  EXPECT_THAT(row.groups(), ElementsAre(0, 1, 0));
  EXPECT_EQ(row.ground, objects::GroupIndex::ofIndex(0));
}

TEST(GroundMerge, ItsBorderOutweighsWhatHardlyMoves) {
  Row row({{}, gains(100), {}});
  EXPECT_THAT(row.groups(), ElementsAre(0, 0, 0));
  objects::MergeWeights weights;
  weights.border = 0;
  EXPECT_THAT(row.groups(weights), ElementsAre(0, 1, 0));
}

TEST(GroundMerge, APartThatSaysNothingGoesWithItsLongerBorder) {
  Row row({gains(500), gains(0), gains(500), gains(-5), {}});
  EXPECT_THAT(row.groups(), ElementsAre(0, 0, 0, 1, 1));
  EXPECT_EQ(row.ground, objects::GroupIndex::ofIndex(1));
}

TEST(GroundMerge, WhereNoObjectIsExpectedMoreHasToMove) {
  Row row({{}, gains(160), {}});
  EXPECT_THAT(row.groups(), ElementsAre(0, 1, 0));
  row.isExpected = false;
  EXPECT_THAT(row.groups(), ElementsAre(0, 0, 0));
}

TEST(GroundMerge, WithoutTheTermOfMotionAllIsGround) {
  Row row({{}, gains(500), {}});
  objects::MergeWeights weights;
  weights.motion = 0;
  EXPECT_THAT(row.groups(weights), ElementsAre(0, 0, 0));
}

TEST(GroundMerge, AllMayMove) {
  Row row({gains(500), gains(500)});
  EXPECT_THAT(row.groups(), ElementsAre(0, 0));
  EXPECT_FALSE(row.ground);
}

TEST(GroundMerge, TheGuessChangesNoClearResult) {
  Row row({{}, gains(500), gains(-400), {}});
  for (const uint8_t guess : {uint8_t{0}, uint8_t{1}}) {
    row.moves.assign(4, guess);
    EXPECT_THAT(row.groups(), ElementsAre(0, 1, 0, 0));
  }
}

}  // namespace
}  // namespace rg
