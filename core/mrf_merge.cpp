// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/mrf_merge.hpp"

#include "core/merge_chains.hpp"
#include "core/pixel.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace rg {
namespace {

constexpr uint32_t kNone = UINT32_MAX;
constexpr int kMutualRounds =
    24;  // Random weights need under 20; a chain of rising ones any number.
constexpr int kMaxRounds = 64;
constexpr int kMaxSweeps = 12;
constexpr int kMaxRestarts = 4;
// A thing inside another has a border of four to five times the root of its area: what clearly
// moves otherwise has to outweigh that.
constexpr int kMostExcess = 6;

/// The total order that makes contraction independent of any other: heavier first. The hash keeps
/// equal weights (a checkerboard) from queueing up along ids, which would cost a round per node.
bool isBetter(const WeightedArc& p, const WeightedArc& q) {
  if (p.weight != q.weight) return p.weight > q.weight;
  return std::tuple(mixHash(p.a, p.b, 1), p.a, p.b) < std::tuple(mixHash(q.a, q.b, 1), q.a, q.b);
}

void chooseBest(uint32_t nodeCount, MergeScratch& s) {
  s.best.assign(nodeCount, kNone);
  for (uint32_t i = 0; i < s.arcs.size(); ++i) {
    const WeightedArc& arc = s.arcs[i];
    if (arc.weight <= 0) continue;
    for (const uint32_t node : {arc.a, arc.b})
      if (s.best[node] == kNone || isBetter(arc, s.arcs[s.best[node]])) s.best[node] = i;
  }
}

/// Makes parent[i] the root of i's tree; parents are never larger than their children.
void flatten(std::vector<uint32_t>& parent) {
  for (uint32_t i = 0; i < parent.size(); ++i) parent[i] = parent[parent[i]];
}

uint32_t rootOf(std::vector<uint32_t>& parent, uint32_t node) {
  while (parent[node] != node) node = parent[node] = parent[parent[node]];
  return node;
}

void join(std::vector<uint32_t>& parent, uint32_t a, uint32_t b) {
  const uint32_t rootA = rootOf(parent, a), rootB = rootOf(parent, b);
  parent[std::max(rootA, rootB)] = std::min(rootA, rootB);
}

/// One round: joins the pairs that choose each other, or (isHooking) everybody with its choice.
/// Returns false when nothing is left to join.
bool joinChoices(uint32_t nodeCount, bool isHooking, MergeScratch& s) {
  chooseBest(nodeCount, s);
  bool hasJoined = false;
  s.parent.resize(nodeCount);
  std::iota(s.parent.begin(), s.parent.end(), 0u);
  for (uint32_t node = 0; node < nodeCount; ++node) {
    if (s.best[node] == kNone) continue;
    const WeightedArc& arc = s.arcs[s.best[node]];
    if (!isHooking && (node != arc.a || s.best[arc.b] != s.best[node])) continue;
    join(s.parent, arc.a, arc.b);
    hasJoined = true;
  }
  flatten(s.parent);
  return hasJoined;
}

/// Rewrites the arcs between the groups of `parent`, parallel ones added up.
void contractArcs(MergeScratch& s) {
  size_t kept = 0;
  for (const WeightedArc& arc : s.arcs) {
    const auto [low, high] = std::minmax(s.parent[arc.a], s.parent[arc.b]);
    if (low != high) s.arcs[kept++] = {low, high, arc.weight};
  }
  s.arcs.resize(kept);
  const auto keyOf = [](const WeightedArc& arc) { return uint64_t{arc.a} << 32 | arc.b; };
  std::sort(s.arcs.begin(), s.arcs.end(),
            [&](const WeightedArc& p, const WeightedArc& q) { return keyOf(p) < keyOf(q); });
  kept = 0;
  for (const WeightedArc& arc : s.arcs) {
    if (kept > 0 && s.arcs[kept - 1].a == arc.a && s.arcs[kept - 1].b == arc.b)
      s.arcs[kept - 1].weight += arc.weight;
    else
      s.arcs[kept++] = arc;
  }
  s.arcs.resize(kept);
}

/// Joins groups of `groupOf` (numbers below its size) as long as that keeps more weight.
void contract(std::span<const WeightedArc> arcs, MergeScratch& s, std::vector<uint32_t>& groupOf) {
  s.arcs.assign(arcs.begin(), arcs.end());
  s.parent = groupOf;
  contractArcs(s);
  const auto nodeCount = static_cast<uint32_t>(groupOf.size());
  for (int round = 0; round < kMaxRounds; ++round) {
    if (!joinChoices(nodeCount, round >= kMutualRounds, s)) return;
    for (uint32_t& group : groupOf) group = s.parent[group];
    contractArcs(s);
  }
}

void listNeighbours(uint32_t nodeCount, std::span<const WeightedArc> arcs, MergeScratch& s) {
  s.firstArc.assign(nodeCount + 2, 0);
  for (const WeightedArc& arc : arcs) {
    ++s.firstArc[arc.a + 2];
    ++s.firstArc[arc.b + 2];
  }
  std::partial_sum(s.firstArc.begin(), s.firstArc.end(), s.firstArc.begin());
  s.neighbours.resize(2 * arcs.size());
  for (const WeightedArc& arc : arcs) {
    s.neighbours[s.firstArc[arc.a + 1]++] = arc;
    s.neighbours[s.firstArc[arc.b + 1]++] = {arc.b, arc.a, arc.weight};
  }
}

/// Where node `node` is best off: its own group, a neighbour's, or an empty one to be alone in.
uint32_t bestGroup(uint32_t node, uint32_t emptyGroup, const std::vector<uint32_t>& groupOf,
                   MergeScratch& s) {
  s.touched.clear();
  for (uint32_t i = s.firstArc[node]; i < s.firstArc[node + 1]; ++i) {
    const uint32_t group = groupOf[s.neighbours[i].b];
    if (s.pull[group] == 0) s.touched.push_back(group);
    s.pull[group] += s.neighbours[i].weight;
  }
  uint32_t best = groupOf[node];
  int64_t most = s.pull[best];
  if (most < 0 && emptyGroup != kNone) {
    best = emptyGroup;
    most = 0;
  }
  for (const uint32_t group : s.touched)
    if (s.pull[group] > most || (s.pull[group] == most && best != groupOf[node] && group < best)) {
      best = group;
      most = s.pull[group];
    }
  for (const uint32_t group : s.touched) s.pull[group] = 0;
  return best;
}

/// Moves single nodes in the order of their numbers, each where it keeps most weight. True if any
/// moved.
bool moveNodes(std::vector<uint32_t>& groupOf, MergeScratch& s) {
  const auto nodeCount = static_cast<uint32_t>(groupOf.size());
  s.groupSize.assign(nodeCount, 0);
  for (const uint32_t group : groupOf) ++s.groupSize[group];
  s.pull.assign(nodeCount, 0);
  bool hasMoved = false;
  uint32_t empty = 0;
  for (int sweep = 0; sweep < kMaxSweeps; ++sweep) {
    bool isChanged = false;
    for (uint32_t node = 0; node < nodeCount; ++node) {
      while (empty < nodeCount && s.groupSize[empty] != 0) ++empty;
      const uint32_t from = groupOf[node];
      const uint32_t to = bestGroup(node, empty < nodeCount ? empty : kNone, groupOf, s);
      if (to == from) continue;
      if (--s.groupSize[from] == 0) empty = std::min(empty, from);
      ++s.groupSize[to];
      groupOf[node] = to;
      isChanged = hasMoved = true;
    }
    if (!isChanged) break;
  }
  return hasMoved;
}

/// Replaces groups by their connected parts, numbered by their first nodes.
void splitAndNumber(std::span<const WeightedArc> arcs, MergeScratch& s,
                    std::vector<uint32_t>& groupOf) {
  s.parent.resize(groupOf.size());
  std::iota(s.parent.begin(), s.parent.end(), 0u);
  for (const WeightedArc& arc : arcs)
    if (groupOf[arc.a] == groupOf[arc.b]) join(s.parent, arc.a, arc.b);
  flatten(s.parent);
  uint32_t count = 0;
  for (uint32_t i = 0; i < groupOf.size(); ++i)
    groupOf[i] = s.parent[i] == i ? count++ : groupOf[s.parent[i]];
}

void improve(std::span<const WeightedArc> arcs, MergeScratch& s, std::vector<uint32_t>& groupOf) {
  contract(arcs, s, groupOf);
  for (int restart = 0; restart < kMaxRestarts; ++restart) {
    const bool hasMoved = moveNodes(groupOf, s);
    if (!moveChains(groupOf, s) && !hasMoved) return;
    contract(arcs, s, groupOf);
  }
}

}  // namespace

void weighArcs(const Motion& motion, std::span<const uint32_t> predicted,
               const MergeWeights& weights, std::vector<ArcEnergy>& energies) {
  const Graph& graph = *motion.graph;
  const int64_t threshold2 = int64_t{weights.motionThreshold} * weights.motionThreshold;
  energies.clear();
  for (const Arc& arc : graph.arcs) {
    const uint32_t s = arc.a - 1u, t = arc.b - 1u;
    const RegionMotion &v = motion.regions[s], &u = motion.regions[t];
    const int64_t dx = v.dx - u.dx, dy = v.dy - u.dy;
    const int64_t excess =
        std::clamp(dx * dx + dy * dy - threshold2, int64_t{0}, kMostExcess * threshold2);
    const int64_t rootArea =
        integerSqrt(std::min(graph.regions[s].areaPx, graph.regions[t].areaPx));
    const int64_t pull = std::min(v.reliability, u.reliability) * rootArea;
    const bool isPredicted =
        !predicted.empty() && predicted[s] != 0 && predicted[s] == predicted[t];
    energies.push_back({.motion = weights.motion * (pull * excess / threshold2) / kFullReliability,
                        .border = int64_t{weights.border} * arc.borderPx,
                        .arc = weights.arc,
                        .prediction = isPredicted ? weights.prediction * rootArea : 0});
  }
}

void listArcs(const Graph& graph, std::span<const ArcEnergy> energies,
              std::vector<WeightedArc>& arcs) {
  arcs.clear();
  for (size_t i = 0; i < graph.arcs.size(); ++i)
    arcs.push_back({graph.arcs[i].a - 1u, graph.arcs[i].b - 1u, energies[i].weight()});
}

int64_t keptWeight(std::span<const WeightedArc> arcs, std::span<const uint32_t> groupOf) {
  int64_t sum = 0;
  for (const WeightedArc& arc : arcs)
    if (groupOf[arc.a] == groupOf[arc.b]) sum += arc.weight;
  return sum;
}

void minimise(uint32_t nodeCount, std::span<const WeightedArc> arcs, MergeScratch& scratch,
              std::vector<uint32_t>& groupOf) {
  listNeighbours(nodeCount, arcs, scratch);
  const bool hasStart = groupOf.size() == nodeCount;
  if (hasStart) {
    splitAndNumber(arcs, scratch, groupOf);
    scratch.alternative = groupOf;
  }
  groupOf.resize(nodeCount);
  std::iota(groupOf.begin(), groupOf.end(), 0u);
  improve(arcs, scratch, groupOf);
  if (hasStart) {
    improve(arcs, scratch, scratch.alternative);
    if (keptWeight(arcs, scratch.alternative) >= keptWeight(arcs, groupOf))
      groupOf.swap(scratch.alternative);
  }
  splitAndNumber(arcs, scratch, groupOf);
}

void describeGroups(const Motion& motion, std::span<const uint32_t> groupOf,
                    std::vector<Group>& groups) {
  const std::vector<Region>& regions = motion.graph->regions;
  groups.clear();
  for (size_t i = 0; i < groupOf.size(); ++i) {
    if (groupOf[i] >= groups.size()) groups.resize(groupOf[i] + 1u);
    Group& group = groups[groupOf[i]];
    const RegionMotion& m = motion.regions[i];
    const int64_t weight = int64_t{regions[i].areaPx} * m.reliability;
    group.areaPx += regions[i].areaPx;
    group.box = unite(group.box, regions[i].box);
    ++group.regionCount;
    group.momentX += weight * m.dx;  // 2^32 px · 2^8 · 2^11 (64 px in 1/16) fit in 64 bits.
    group.momentY += weight * m.dy;
    group.weight += weight;
    group.sumX += int64_t{regions[i].areaPx} * regions[i].centroidX;
    group.sumY += int64_t{regions[i].areaPx} * regions[i].centroidY;
  }
  for (Group& group : groups) {
    if (group.weight == 0) continue;
    group.dx = static_cast<int32_t>(divideRounded(group.momentX, group.weight));
    group.dy = static_cast<int32_t>(divideRounded(group.momentY, group.weight));
    group.reliability = static_cast<uint16_t>(divideRounded(group.weight, group.areaPx));
  }
}

RegionMotion dominantMotion(const Motion& motion, VoteScratch& scratch) {
  constexpr int kReach = VoteScratch::kReach, kSide = VoteScratch::kSide;
  scratch.cells.assign(size_t{kSide} * kSide, {});
  const auto cellAt = [&](int x, int y) -> VoteScratch::Cell& {
    return scratch.cells[static_cast<size_t>((y + kReach) * kSide + x + kReach)];
  };
  for (size_t i = 0; i < motion.regions.size(); ++i) {
    const RegionMotion& m = motion.regions[i];
    const int64_t weight = int64_t{motion.graph->regions[i].areaPx} * m.reliability;
    const auto wholePx = [](int32_t v) {
      return std::clamp(static_cast<int>(divideRounded(v, kMotionUnit)), 1 - kReach, kReach - 1);
    };
    VoteScratch::Cell& cell = cellAt(wholePx(m.dx), wholePx(m.dy));
    cell.weight += weight;
    cell.momentX += weight * m.dx;
    cell.momentY += weight * m.dy;
  }
  RegionMotion best;
  std::tuple<int64_t, int, int, int> bestKey{0, 0, 0, 0};
  for (int y = 1 - kReach; y < kReach; ++y)
    for (int x = 1 - kReach; x < kReach; ++x) {
      VoteScratch::Cell sum{};
      for (int n = 0; n < 9; ++n) {
        const VoteScratch::Cell& cell = cellAt(x + n % 3 - 1, y + n / 3 - 1);
        sum.weight += cell.weight;
        sum.momentX += cell.momentX;
        sum.momentY += cell.momentY;
      }
      const std::tuple key{-sum.weight, x * x + y * y, y, x};
      if (sum.weight == 0 || key >= bestKey) continue;
      bestKey = key;
      best.dx = static_cast<int32_t>(divideRounded(sum.momentX, sum.weight));
      best.dy = static_cast<int32_t>(divideRounded(sum.momentY, sum.weight));
      best.reliability = kFullReliability;
    }
  return best;
}

}  // namespace rg
