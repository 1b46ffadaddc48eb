// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/motion/refinement/motion_consensus.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace rg::motion {
namespace {

constexpr size_t kManyRegions = kMostVisits / kMostSweeps, kMostNeighboursOfMany = 6;
/// Contrast and difference of colour, in grey levels, that halve a neighbour's weight.
constexpr int64_t kContrast = 8;
constexpr int64_t kColour = 30;
constexpr int64_t kAllShares = int64_t{1} << 16;

int64_t kinship(const graph::Arc& arc, const graph::Colour& a, const graph::Colour& b) {
  constexpr int64_t kScale = 256;
  return int64_t{arc.borderPx} * kScale * kContrast / (kContrast + arc.meanContrast()) * kColour /
         (kColour + graph::difference(a, b));
}

/// Of the region's vector and its neighbours', the one that all agree with best.
Point findCentre(const ConsensusSweep& s, size_t region) {
  Point best = s.before[region].at;
  int64_t least = disagreement(s, region, best);
  for (uint32_t k = 0; k < s.counts[region]; ++k) {
    const Point at = s.before[s.neighbour(region, k).region].at;
    const int64_t cost = disagreement(s, region, at);
    if (cost < least) {
      least = cost;
      best = at;
    }
  }
  return best;
}

void sweep(const ConsensusSweep& s, size_t region) {
  const Point centre = findCentre(s, region);
  ConsensusSums sums;
  for (uint32_t k = 0; k < s.counts[region]; ++k)
    addNeighbour(s, s.neighbour(region, k), centre, sums);
  conclude(s, region, centre, sums);
}

}  // namespace

std::span<const MotionPrior> MotionConsensus::run(const graph::Graph& graph,
                                                  std::span<const SeenMotion> own,
                                                  const Executor& executor) {
  neighbours_.find(graph);
  ownTrust_.resize(own.size());
  before_.resize(own.size());
  after_.resize(own.size());
  priors_.assign(own.size(), {});
  for (size_t i = 0; i < own.size(); ++i) {
    ownTrust_[i] = ownTrustOf(own[i]);
    before_[i] = {own[i].at, ownTrust_[i]};
  }
  for (size_t turn = 0; turn < sweepsFor(own.size()); ++turn) {
    const ConsensusSweep s{neighbours_.starts().data(),
                           neighbours_.counts().data(),
                           neighbours_.list().data(),
                           own.data(),
                           ownTrust_.data(),
                           before_.data(),
                           after_.data(),
                           priors_.data()};
    executor.forRows(static_cast<int>(own.size()), [&](int first, int last) {
      for (auto i = static_cast<size_t>(first); i < static_cast<size_t>(last); ++i) sweep(s, i);
    });
    std::swap(before_, after_);
  }
  return priors_;
}

void MotionNeighbours::find(const graph::Graph& graph) {
  const size_t count = graph.regions.size();
  counts_.assign(count, 0);
  for (const graph::Arc& arc : graph.arcs) {
    ++counts_[arc.a.index()];
    ++counts_[arc.b.index()];
  }
  starts_.resize(count + 1);
  starts_[0] = 0;
  std::partial_sum(counts_.begin(), counts_.end(), starts_.begin() + 1);
  list_.resize(starts_.back());
  std::fill(counts_.begin(), counts_.end(), 0u);
  for (const graph::Arc& arc : graph.arcs) {
    const uint32_t a = arc.a.index(), b = arc.b.index();
    const auto weight = static_cast<int32_t>(std::min<int64_t>(
        kinship(arc, graph.regions[a].colour, graph.regions[b].colour), INT32_MAX));
    list_[starts_[a] + counts_[a]++] = {b, weight};
    list_[starts_[b] + counts_[b]++] = {a, weight};
  }
  for (size_t i = 0; i < count; ++i) keepStrongest(i);
}

// A bound on the time: a region may have thousands of neighbours. Weights become shares.
void MotionNeighbours::keepStrongest(size_t region) {
  MotionNeighbour* first = list_.data() + starts_[region];
  const size_t kept = std::min<size_t>(
      counts_[region], counts_.size() > kManyRegions ? kMostNeighboursOfMany : kMostNeighbours);
  std::partial_sort(first, first + kept, first + counts_[region],
                    [](const MotionNeighbour& a, const MotionNeighbour& b) {
                      return a.weight != b.weight ? a.weight > b.weight : a.region < b.region;
                    });
  counts_[region] = static_cast<uint32_t>(kept);
  int64_t sum = 1;
  for (size_t i = 0; i < kept; ++i) sum += first[i].weight;
  for (size_t i = 0; i < kept; ++i)
    first[i].weight = static_cast<int32_t>(first[i].weight * kAllShares / sum);
}

}  // namespace rg::motion
