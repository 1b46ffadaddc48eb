// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/merge/mrf_merge.hpp"

#include "core/base/forest.hpp"
#include "core/base/pixel.hpp"
#include "core/objects/merge/empty_groups.hpp"
#include "core/objects/merge/merge_chains.hpp"
#include "core/objects/merge/merge_contraction.hpp"
#include "core/objects/objects.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace rg::objects {
namespace {

constexpr int kMaxSweeps = 12;
constexpr int kMaxRestarts = 4;

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
uint32_t bestGroup(uint32_t node, GroupIndex emptyGroup, const std::vector<uint32_t>& groupOf,
                   MergeScratch& s) {
  s.touched.clear();
  for (const WeightedArc& arc : s.arcsOf(node)) {
    const uint32_t group = groupOf[arc.b];
    if (s.pull[group] == 0) s.touched.push_back(group);
    s.pull[group] += arc.weight;
  }
  uint32_t best = groupOf[node];
  int64_t most = s.pull[best];
  if (most < 0 && emptyGroup) {
    best = emptyGroup.index();
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
  s.isSettled.assign(nodeCount, 0);
  bool hasMoved = false;
  EmptyGroups empty(s.groupSize, s.emptied);
  for (int sweep = 0; sweep < kMaxSweeps; ++sweep) {
    bool isChanged = false;
    for (uint32_t node = 0; node < nodeCount; ++node) {
      if (s.isSettled[node] != 0) continue;
      s.isSettled[node] = 1;
      const uint32_t from = groupOf[node];
      const uint32_t free = empty.first();
      const GroupIndex alone = free < nodeCount ? GroupIndex::ofIndex(free) : GroupIndex();
      const uint32_t to = bestGroup(node, alone, groupOf, s);
      if (to == from) continue;
      if (--s.groupSize[from] == 0) empty.add(from);
      ++s.groupSize[to];
      groupOf[node] = to;
      for (const WeightedArc& arc : s.arcsOf(node)) s.isSettled[arc.b] = 0;
      isChanged = hasMoved = true;
    }
    if (!isChanged) break;
  }
  return hasMoved;
}

/// Replaces groups by their connected parts, numbered by their first nodes. Returns their count.
uint32_t splitAndNumber(std::span<const WeightedArc> arcs, MergeScratch& s,
                        std::vector<uint32_t>& groupOf) {
  s.parent.resize(groupOf.size());
  std::iota(s.parent.begin(), s.parent.end(), 0u);
  for (const WeightedArc& arc : arcs)
    if (groupOf[arc.a] == groupOf[arc.b]) join(s.parent, arc.a, arc.b);
  const uint32_t count = numberSets(s.parent);
  std::copy(s.parent.begin(), s.parent.end(), groupOf.begin());
  return count;
}

void improve(uint64_t mostVisits, MergeScratch& s, std::vector<uint32_t>& groupOf) {
  s.visitLimit = s.visits + mostVisits;
  s.searched.clear();
  contract(s, groupOf);
  for (int restart = 0; restart < kMaxRestarts; ++restart) {
    const bool hasMoved = moveNodes(groupOf, s);
    if (!moveChains(groupOf, s) && !hasMoved) return;
    contract(s, groupOf);
    if (s.visits >= s.visitLimit) return;
  }
}

}  // namespace

int64_t nsPerPixel(const Params& params, Size frame) {
  constexpr double kSecond = 1e9;
  const double pxPerSecond = std::clamp(params.motionThreshold, 0.0, 1000.0) / 100 *
                             integerSqrt(static_cast<uint64_t>(frame.area()));
  return std::llround(kSecond / std::max(pxPerSecond, 1.0));
}

MergeWeights weightsOf(const Params& params, Size frame, int64_t stepNs) {
  const auto q8 = [](double value) {
    return static_cast<int32_t>(std::lround(std::clamp(value, 0.0, 1000.0) * 256));
  };
  MergeWeights weights;
  weights.numbers = params.numbers.energy;
  weights.motion = q8(params.motionWeight);
  weights.border = q8(params.borderWeight);
  weights.arc = q8(params.arcWeight);
  weights.prediction = q8(params.predictionWeight);
  // Vectors of small regions are no better than to a pixel.
  constexpr int64_t kLeast = motion::kMotionUnit, kMost = 64 * motion::kMotionUnit;
  weights.motionThreshold = static_cast<int32_t>(std::clamp<int64_t>(
      divideRounded(motion::kMotionUnit * stepNs, nsPerPixel(params, frame)), kLeast, kMost));
  return weights;
}

ArcWeigher::ArcWeigher(Size frame, const MergeWeights& weights)
    : weights_(weights),
      threshold2_(int64_t{weights.motionThreshold} * weights.motionThreshold),
      mostExcess_(weights.numbers.mostExcess.of(threshold2_)),
      halfContrast_(weights.numbers.halfContrast.whole()),
      halfColour_(weights.numbers.halfColour.whole()),
      arcUnit_(weights.numbers.arcLength.of(
          weights.arc * int64_t{integerSqrt(static_cast<uint64_t>(frame.area()))})) {}

int64_t ArcWeigher::motion(const motion::RegionMotion& v, const motion::RegionMotion& u,
                           int64_t rootArea) const {
  const int64_t dx = v.dx - u.dx, dy = v.dy - u.dy;
  const int64_t excess = std::clamp(dx * dx + dy * dy - threshold2_, int64_t{0}, mostExcess_);
  const int64_t pull = std::min(v.reliability, u.reliability) * rootArea;
  return weights_.motion * (pull * excess / threshold2_) / motion::kFullReliability;
}

int64_t ArcWeigher::border(uint32_t borderPx, uint32_t meanContrast) const {
  return int64_t{weights_.border} * borderPx * halfContrast_ / (halfContrast_ + meanContrast);
}

int64_t ArcWeigher::arc(graph::Colour a, graph::Colour b) const {
  return arcUnit_ * halfColour_ / (halfColour_ + graph::difference(a, b));
}

void weighArcs(const motion::Motion& motion, std::span<const TrackIndex> predicted,
               const MergeWeights& weights, std::vector<ArcEnergy>& energies) {
  const graph::Graph& graph = *motion.graph;
  const ArcWeigher weigher(graph.size, weights);
  energies.clear();
  energies.reserve(graph.arcs.size());
  for (const graph::Arc& arc : graph.arcs) {
    const uint32_t s = arc.a.index(), t = arc.b.index();
    const graph::Region &a = graph.regions[s], &b = graph.regions[t];
    const int64_t rootArea = integerSqrt(std::min(a.areaPx, b.areaPx));
    const bool isPredicted = !predicted.empty() && predicted[s] && predicted[s] == predicted[t];
    energies.push_back({.motion = weigher.motion(motion.regions[s], motion.regions[t], rootArea),
                        .border = weigher.border(arc.borderPx, arc.meanContrast()),
                        .arc = weigher.arc(a.colour, b.colour),
                        .prediction = isPredicted ? weigher.prediction(rootArea) : 0});
  }
}

GroundEnergy weighGround(int64_t gain, int64_t areaPx, bool isExpected, const MergeWeights& weights,
                         int64_t stoppedPx) {
  const int64_t rootArea = integerSqrt(static_cast<uint64_t>(areaPx));
  const int64_t unexpectedPx = isExpected ? 0 : rootArea;
  return {.motion = weights.motion * gain / kGainUnit,
          .prediction = weights.prediction * (unexpectedPx - stoppedPx)};
}

void listArcs(const graph::Graph& graph, std::span<const ArcEnergy> energies,
              std::vector<WeightedArc>& arcs) {
  arcs.clear();
  arcs.reserve(graph.arcs.size());
  for (size_t i = 0; i < graph.arcs.size(); ++i)
    arcs.push_back({graph.arcs[i].a.index(), graph.arcs[i].b.index(), energies[i].weight()});
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
  const uint64_t visitsOfStart = mostVisits(nodeCount, arcs.size()) / 2;
  scratch.visits = 0;
  scratch.contractionVisits = 0;
  scratch.isCutShort = false;
  const bool hasStart =
      groupOf.size() == nodeCount && splitAndNumber(arcs, scratch, groupOf) < nodeCount;
  if (hasStart) scratch.alternative = groupOf;
  groupOf.resize(nodeCount);
  std::iota(groupOf.begin(), groupOf.end(), 0u);
  improve(visitsOfStart, scratch, groupOf);
  if (hasStart) {
    improve(visitsOfStart, scratch, scratch.alternative);
    if (keptWeight(arcs, scratch.alternative) >= keptWeight(arcs, groupOf))
      groupOf.swap(scratch.alternative);
  }
  splitAndNumber(arcs, scratch, groupOf);
}

void describeGroups(const motion::Motion& motion, std::span<const GroupIndex> groupOf,
                    std::vector<Group>& groups) {
  const std::vector<graph::Region>& regions = motion.graph->regions;
  groups.clear();
  for (size_t i = 0; i < groupOf.size(); ++i) {
    if (groupOf[i].number() > groups.size()) groups.resize(groupOf[i].number());
    Group& group = groups[groupOf[i].index()];
    const motion::RegionMotion& m = motion.regions[i];
    const int64_t weight = int64_t{regions[i].areaPx} * m.reliability;
    group.areaPx += regions[i].areaPx;
    group.box = unite(group.box, regions[i].box);
    ++group.regionCount;
    group.momentX += weight * m.dx;  // 2^26 px · 2^8 · 2^19 (a frame in 1/16 px) fit in 64 bits.
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

GroupIndex largestGroup(std::span<const Group> groups, Size frame) {
  GroupIndex largest;
  int64_t most = 0, left = frame.area();
  for (size_t i = 0; i < groups.size(); ++i) {
    left -= groups[i].areaPx;
    if (groups[i].areaPx <= most) continue;
    most = groups[i].areaPx;
    largest = GroupIndex::ofIndex(i);
  }
  return left > most ? GroupIndex() : largest;
}

}  // namespace rg::objects
