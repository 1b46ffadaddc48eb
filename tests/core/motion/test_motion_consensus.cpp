// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/motion/refinement/motion_consensus.hpp"

#include <gtest/gtest.h>

namespace rg {
namespace {

using segmentation::RegionLabel;

constexpr motion::Information kSure{400 * 256, 0, 400 * 256};
constexpr graph::Colour kGrey{90, 90, 90}, kRed{200, 40, 40};

graph::Graph chainOf(std::initializer_list<graph::Colour> colours) {
  graph::Graph graph;
  for (const graph::Colour& colour : colours) {
    graph::Region region;
    region.colour = colour;
    if (!graph.regions.empty()) {
      const size_t count = graph.regions.size();
      const uint32_t contrast = graph.regions.back().colour == colour ? 0 : 100 * 20;
      graph.arcs.push_back(
          {RegionLabel::ofIndex(count - 1), RegionLabel::ofIndex(count), 20, contrast});
    }
    graph.regions.push_back(region);
  }
  return graph;
}

TEST(MotionConsensus, AVectorSpreadsAlongAChainOfUnsureRegions) {
  const graph::Graph graph = chainOf({kGrey, kGrey, kGrey, kGrey});
  const motion::SeenMotion own[] = {
      {{512, -256}, kSure}, {{-3000, 900}, {}}, {{77, 4000}, {}}, {{}, {}}};
  motion::MotionConsensus consensus;
  const auto priors = consensus.run(graph, own, Executor(1));
  for (size_t i = 1; i < 4; ++i) {
    EXPECT_NEAR(priors[i].at.x, 512, 16) << i;
    EXPECT_NEAR(priors[i].at.y, -256, 16) << i;
    EXPECT_GT(priors[i].weight, 0);
  }
}

TEST(MotionConsensus, TheNeighbourOfOneColourCountsMost) {
  const graph::Graph graph = chainOf({kGrey, kGrey, kRed});
  const motion::SeenMotion own[] = {{{512, 0}, kSure}, {{0, 0}, {}}, {{-2048, 0}, kSure}};
  motion::MotionConsensus consensus;
  EXPECT_NEAR(consensus.run(graph, own, Executor(1))[1].at.x, 512, 32);
}

TEST(MotionConsensus, TheVectorThatMostAgreeOnCountsAndNoMeanOfAll) {
  graph::Graph graph;
  graph.regions.resize(4);
  for (size_t other = 1; other < 4; ++other)
    graph.arcs.push_back({RegionLabel::ofIndex(0), RegionLabel::ofIndex(other), 20, 0});
  const motion::SeenMotion own[] = {
      {{0, 0}, {}}, {{512, 0}, kSure}, {{500, 0}, kSure}, {{-4000, 4000}, kSure}};
  motion::MotionConsensus consensus;
  const motion::MotionPrior prior = consensus.run(graph, own, Executor(1))[0];
  EXPECT_NEAR(prior.at.x, 506, 4);
  EXPECT_NEAR(prior.at.y, 0, 4);
}

TEST(MotionConsensus, ARegionWithoutNeighboursHasNoPrior) {
  graph::Graph graph;
  graph.regions.resize(2);
  const motion::SeenMotion own[] = {{{512, 0}, kSure}, {{}, {}}};
  motion::MotionConsensus consensus;
  for (const motion::MotionPrior& prior : consensus.run(graph, own, Executor(1)))
    EXPECT_EQ(prior.weight, 0);
}

}  // namespace
}  // namespace rg
