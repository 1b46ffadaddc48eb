// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/pixel.hpp"
#include "core/objects/merge/merge_contraction.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

namespace rg {
namespace {

using Arcs = std::map<std::pair<uint32_t, uint32_t>, int64_t>;

/// Heavier arcs are smaller; equal ones are told apart by a hash of their ends.
auto keyOf(const Arcs::value_type& arc) {
  const auto [a, b] = arc.first;
  return std::tuple(-arc.second, mixHash(a, b, 1), a, b);
}

/// The arc that each group likes best, if any keeps weight.
std::map<uint32_t, std::pair<uint32_t, uint32_t>> choices(const Arcs& arcs) {
  std::map<uint32_t, std::pair<uint32_t, uint32_t>> best;
  for (const auto& arc : arcs) {
    if (arc.second <= 0) continue;
    for (const uint32_t group : {arc.first.first, arc.first.second}) {
      const auto [at, isNew] = best.try_emplace(group, arc.first);
      if (!isNew && keyOf(arc) < keyOf(*arcs.find(at->second))) at->second = arc.first;
    }
  }
  return best;
}

/// Contraction to the letter: all arcs anew in every round.
std::vector<uint32_t> plainContraction(const std::vector<objects::WeightedArc>& list,
                                       std::vector<uint32_t> groupOf) {
  for (int round = 0; round < 64; ++round) {
    Arcs arcs;
    for (const objects::WeightedArc& arc : list) {
      const auto [low, high] = std::minmax(groupOf[arc.a], groupOf[arc.b]);
      if (low != high) arcs[{low, high}] += arc.weight;
    }
    const auto best = choices(arcs);
    if (best.empty()) break;
    std::vector<uint32_t> nameOf(groupOf.size());
    std::iota(nameOf.begin(), nameOf.end(), 0u);
    for (const auto& [group, pair] : best) {
      if (round < 24 && (group != pair.first || best.at(pair.second) != pair)) continue;
      const auto [low, high] = std::minmax(nameOf[pair.first], nameOf[pair.second]);
      const uint32_t from = high, to = low;
      std::replace(nameOf.begin(), nameOf.end(), from, to);
    }
    for (uint32_t& group : groupOf) group = nameOf[group];
  }
  return groupOf;
}

/// A grid of 4-neighbours with weights of few different values, so that ties decide much.
std::vector<objects::WeightedArc> gridArcs(uint32_t side, uint32_t seed) {
  std::vector<objects::WeightedArc> arcs;
  const auto weightOf = [&](uint32_t a, uint32_t b) {
    return static_cast<int64_t>(mixHash(a, b, seed) % 7) - 2;
  };
  for (uint32_t i = 0; i < side * side; ++i) {
    if (i % side + 1 < side) arcs.push_back({i, i + 1, weightOf(i, i + 1)});
    if (i + side < side * side) arcs.push_back({i, i + side, weightOf(i, i + side)});
  }
  return arcs;
}

/// Neighbours of each node as contract() takes them.
objects::MergeScratch scratchOf(uint32_t nodeCount, const std::vector<objects::WeightedArc>& arcs) {
  std::vector<std::vector<objects::WeightedArc>> arcsOf(nodeCount);
  for (const objects::WeightedArc& arc : arcs) {
    arcsOf[arc.a].push_back(arc);
    arcsOf[arc.b].push_back({arc.b, arc.a, arc.weight});
  }
  objects::MergeScratch scratch;
  scratch.firstArc.assign(1, 0);
  for (const std::vector<objects::WeightedArc>& list : arcsOf) {
    scratch.neighbours.insert(scratch.neighbours.end(), list.begin(), list.end());
    scratch.firstArc.push_back(static_cast<uint32_t>(scratch.neighbours.size()));
  }
  return scratch;
}

TEST(MergeContraction, IsThatOfAllArcsInEveryRound) {
  for (uint32_t seed = 0; seed < 20; ++seed) {
    const uint32_t side = 2 + seed % 9;
    const std::vector<objects::WeightedArc> arcs = gridArcs(side, seed);
    objects::MergeScratch scratch = scratchOf(side * side, arcs);
    std::vector<uint32_t> alone(side * side), pairs(side * side);
    std::iota(alone.begin(), alone.end(), 0u);
    for (uint32_t i = 0; i < pairs.size(); ++i) pairs[i] = (i / 2 * 5 + 3) % (side * side);
    for (const std::vector<uint32_t>& start : {alone, pairs}) {
      std::vector<uint32_t> groupOf = start;
      objects::contract(scratch, groupOf);
      EXPECT_EQ(groupOf, plainContraction(arcs, start)) << "seed " << seed;
    }
  }
}

/// A chain, all nodes of which touch a few others, too. Those like one of them best after the
/// other, and all see it when one has joined.
std::vector<objects::WeightedArc> chainBelowWalls(uint32_t nodes, uint32_t walls) {
  std::vector<objects::WeightedArc> arcs;
  for (uint32_t i = 0; i + 1 < nodes; ++i) arcs.push_back({i, i + 1, 1 + i % 5});
  for (uint32_t i = 0; i < nodes; ++i)
    for (uint32_t wall = 0; wall < walls; ++wall)
      arcs.push_back({i, nodes + wall, 10 + mixHash(i, wall, 3) % 5});
  return arcs;
}

TEST(MergeContraction, WorkFollowsTheLinksWhereSomeNodesTouchAll) {
  for (const uint32_t walls : {1u, 4u, 64u}) {
    const uint32_t nodes = 600'000 / (walls + 1);
    const std::vector<objects::WeightedArc> arcs = chainBelowWalls(nodes, walls);
    objects::MergeScratch scratch = scratchOf(nodes + walls, arcs);
    std::vector<uint32_t> groupOf(nodes + walls);
    std::iota(groupOf.begin(), groupOf.end(), 0u);
    objects::contract(scratch, groupOf);
    EXPECT_TRUE(scratch.isCutShort);
    EXPECT_LE(scratch.contractionVisits, 40 * arcs.size()) << walls;
    EXPECT_EQ(std::count(groupOf.begin(), groupOf.end(), 0u), nodes + walls) << walls;
  }
}

TEST(MergeContraction, OrdinaryGraphsAreContractedToTheEnd) {
  constexpr uint32_t kSide = 100;
  for (uint32_t seed = 0; seed < 3; ++seed) {
    const std::vector<objects::WeightedArc> arcs = gridArcs(kSide, seed);
    objects::MergeScratch scratch = scratchOf(kSide * kSide, arcs);
    std::vector<uint32_t> groupOf(kSide * kSide);
    std::iota(groupOf.begin(), groupOf.end(), 0u);
    objects::contract(scratch, groupOf);
    EXPECT_FALSE(scratch.isCutShort) << "seed " << seed;
  }
}

}  // namespace
}  // namespace rg
