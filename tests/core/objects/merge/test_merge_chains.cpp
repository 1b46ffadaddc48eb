// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/pixel.hpp"
#include "core/objects/merge/merge_chains.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <set>

namespace rg {
namespace {

using Arcs = std::vector<objects::WeightedArc>;
using Groups = std::vector<uint32_t>;

constexpr size_t kMostInChain = 6;

int64_t weightOf(uint32_t a, uint32_t b, uint32_t seed) {
  return static_cast<int64_t>(mixHash(a, b, seed) % 9) - 4;
}

/// A grid of 4-neighbours, and one node more that all of them touch.
Arcs wallWithSpecks(uint32_t side, uint32_t seed) {
  Arcs arcs;
  const uint32_t wall = side * side;
  for (uint32_t i = 0; i < wall; ++i) {
    if (i % side + 1 < side) arcs.push_back({i, i + 1, weightOf(i, i + 1, seed)});
    if (i + side < wall) arcs.push_back({i, i + side, weightOf(i, i + side, seed)});
    arcs.push_back({i, wall, weightOf(i, wall, seed)});
  }
  return arcs;
}

Groups someGroups(uint32_t nodes, uint32_t seed) {
  Groups groupOf(nodes);
  for (uint32_t i = 0; i < nodes; ++i) groupOf[i] = mixHash(i, seed, 5) % nodes / 3;
  return groupOf;
}

objects::MergeScratch scratchOf(uint32_t nodes, const Arcs& arcs) {
  objects::MergeScratch scratch;
  scratch.firstArc.assign(1, 0);
  for (uint32_t node = 0; node < nodes; ++node) {
    for (const objects::WeightedArc& arc : arcs) {
      if (arc.a == node) scratch.neighbours.push_back(arc);
      if (arc.b == node) scratch.neighbours.push_back({arc.b, arc.a, arc.weight});
    }
    scratch.firstArc.push_back(static_cast<uint32_t>(scratch.neighbours.size()));
  }
  return scratch;
}

/// The chain of one node between its group and `to`, to the letter: all sums anew at each step.
bool tryPlainChain(const Arcs& arcs, uint32_t node, uint32_t to, Groups& groupOf) {
  const uint32_t from = groupOf[node];
  const int64_t before = objects::keptWeight(arcs, groupOf);
  Groups best = groupOf;
  int64_t most = before;
  std::set<uint32_t> chain, near;
  for (uint32_t next = node; chain.size() < kMostInChain;) {
    groupOf[next] = groupOf[next] == from ? to : from;
    chain.insert(next);
    if (objects::keptWeight(arcs, groupOf) > most) {
      most = objects::keptWeight(arcs, groupOf);
      best = groupOf;
    }
    for (const objects::WeightedArc& arc : arcs) {
      if (arc.a == next) near.insert(arc.b);
      if (arc.b == next) near.insert(arc.a);
    }
    int64_t gain = INT64_MIN;
    for (const uint32_t other : near) {
      if (chain.contains(other) || (groupOf[other] != from && groupOf[other] != to)) continue;
      Groups tried = groupOf;
      tried[other] = groupOf[other] == from ? to : from;
      if (objects::keptWeight(arcs, tried) <= gain) continue;
      gain = objects::keptWeight(arcs, tried);
      next = other;
    }
    if (gain == INT64_MIN) break;
  }
  groupOf = best;
  return most > before;
}

Groups plainChains(const Arcs& arcs, Groups groupOf) {
  for (uint32_t node = 0; node < groupOf.size(); ++node) {
    Groups targets;
    bool hasMotive = false;
    for (const objects::WeightedArc& arc : arcs) {
      if (arc.a != node && arc.b != node) continue;
      const uint32_t group = groupOf[arc.a == node ? arc.b : arc.a];
      hasMotive |= group == groupOf[node] ? arc.weight < 0 : arc.weight > 0;
      const bool isNew = std::find(targets.begin(), targets.end(), group) == targets.end();
      if (group != groupOf[node] && isNew) targets.push_back(group);
    }
    if (!hasMotive) continue;
    uint32_t empty = 0;
    while (std::find(groupOf.begin(), groupOf.end(), empty) != groupOf.end()) ++empty;
    if (empty < groupOf.size()) targets.push_back(empty);
    for (const uint32_t to : targets)
      if (tryPlainChain(arcs, node, to, groupOf)) break;
  }
  return groupOf;
}

/// What moveNodes() and contract() might do between two searches.
void stir(Groups& groupOf, uint32_t seed) {
  const auto nodes = static_cast<uint32_t>(groupOf.size());
  for (uint32_t i = 0; i < 3; ++i)
    groupOf[mixHash(seed, i, 7) % nodes] = groupOf[mixHash(seed, i, 8) % nodes];
}

TEST(MergeChains, WhatIsLeftOutGainedNothingBeforeAndWouldNotNow) {
  for (uint32_t seed = 0; seed < 20; ++seed) {
    const uint32_t side = 4 + 5 * (seed % 2), nodes = side * side + 1;
    const Arcs arcs = wallWithSpecks(side, seed);
    objects::MergeScratch scratch = scratchOf(nodes, arcs), forgetful = scratch;
    Groups groupOf = someGroups(nodes, seed), expected = groupOf;
    for (uint32_t search = 0; search < 8; ++search) {
      forgetful.searched.clear();
      EXPECT_EQ(objects::moveChains(groupOf, scratch), objects::moveChains(expected, forgetful));
      ASSERT_EQ(groupOf, expected) << "seed " << seed << ", search " << search;
      if (search % 2 == 1) stir(groupOf, seed + 100 * search);
      expected = groupOf;
    }
    while (objects::moveChains(groupOf, scratch)) continue;
    const uint64_t before = scratch.visits;
    EXPECT_FALSE(objects::moveChains(groupOf, scratch));
    EXPECT_LE(scratch.visits - before, scratch.neighbours.size());
  }
}

TEST(MergeChains, AreThoseOfSumsMadeAnewAtEachStep) {
  for (uint32_t seed = 0; seed < 6; ++seed) {
    const uint32_t side = 4 + 5 * (seed % 2), nodes = side * side + 1;  // The wall is a hub at 9.
    const Arcs arcs = wallWithSpecks(side, seed);
    objects::MergeScratch scratch = scratchOf(nodes, arcs);
    Groups groupOf = someGroups(nodes, seed);
    const Groups expected = plainChains(arcs, groupOf);
    EXPECT_TRUE(objects::moveChains(groupOf, scratch));
    EXPECT_EQ(groupOf, expected) << "seed " << seed;
    EXPECT_FALSE(scratch.isCutShort);
  }
}

/// Work of minimise() for a graph, which must not grow with its square. It contracts ten times at
/// most, the later ones with little left to join.
objects::MergeScratch workFor(uint32_t nodes, const Arcs& arcs) {
  objects::MergeScratch scratch;
  Groups groupOf(nodes);
  for (uint32_t i = 0; i < nodes; ++i) groupOf[i] = i / 64;
  const int64_t before = objects::keptWeight(arcs, groupOf);
  objects::minimise(nodes, arcs, scratch, groupOf);
  EXPECT_GE(objects::keptWeight(arcs, groupOf), before);
  EXPECT_LE(scratch.contractionVisits, (uint64_t{10} << 20) + 40 * arcs.size());
  return scratch;
}

/// The last chains of the two starts may look at all arcs, each six times at most.
uint64_t bound(uint32_t nodes, const Arcs& arcs) {
  return objects::mostVisits(nodes, arcs.size()) + 64 * (nodes + arcs.size());
}

TEST(MergeChains, WorkFollowsTheArcsWhereOneNodeTouchesAll) {
  constexpr uint32_t kSide = 255, kNodes = kSide * kSide + 1;
  for (uint32_t seed = 0; seed < 2; ++seed) {
    const Arcs arcs = wallWithSpecks(kSide, seed);
    EXPECT_LE(workFor(kNodes, arcs).visits, bound(kNodes, arcs));
  }
}

TEST(MergeChains, WorkFollowsTheArcsWhereManyNodesTouchMany) {
  constexpr uint32_t kSpecks = 65000, kWalls = 8;
  Arcs arcs;
  for (uint32_t i = 0; i < kSpecks; ++i)
    for (uint32_t wall = 0; wall < kWalls; ++wall)
      arcs.push_back({i, kSpecks + wall, weightOf(i, wall, 1)});
  EXPECT_LE(workFor(kSpecks + kWalls, arcs).visits, bound(kSpecks + kWalls, arcs));
}

TEST(MergeChains, OrdinaryGraphsAreSearchedToTheEnd) {
  constexpr uint32_t kSide = 16, kNodes = kSide * kSide + 1;
  for (uint32_t seed = 0; seed < 4; ++seed)
    EXPECT_FALSE(workFor(kNodes, wallWithSpecks(kSide, seed)).isCutShort) << "seed " << seed;
}

}  // namespace
}  // namespace rg
