// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/motion/motion_consensus.hpp"

#include "core/base/pixel.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <numeric>

namespace rg::motion {
namespace {

constexpr size_t kMostSweeps = 8;
/// Bounds on the time: of more than 8192 regions fewer sweeps are made, among fewer neighbours.
constexpr size_t kMostVisits = 65536;
constexpr size_t kManyRegions = kMostVisits / kMostSweeps;
constexpr size_t kMostNeighbours = 16, kMostNeighboursOfMany = 6;
constexpr int64_t kOne = 256;
/// Neighbours are expected to differ by half a pixel: a weight of 4 px⁻².
constexpr int64_t kLikeness = 4 * kOne;
/// Neighbours a pixel apart agree half.
constexpr int64_t kAgreement = int64_t{kFine} * kFine;
constexpr int64_t kLeastTrust = 3;
constexpr int64_t kFarthest = int64_t{2} * kMostReach * kFine;
/// Contrast and difference of colour, in grey levels, that halve a neighbour's weight.
constexpr int64_t kContrast = 8;
constexpr int64_t kColour = 30;

/// kOne where the points are one, half of it where they are a pixel apart.
int64_t agreement(Point a, Point b) {
  const int64_t dx = a.x - b.x, dy = a.y - b.y;
  return kOne * kAgreement / (kAgreement + dx * dx + dy * dy);
}

int64_t kinship(const graph::Arc& arc, const graph::Colour& a, const graph::Colour& b) {
  constexpr int64_t kScale = 256;
  return int64_t{arc.borderPx} * kScale * kContrast / (kContrast + arc.meanContrast()) * kColour /
         (kColour + graph::difference(a, b));
}

/// weight / (weight + unit), of kOne.
int32_t trustOf(int64_t weight, int64_t unit) {
  return static_cast<int32_t>(kOne * weight / (weight + unit));
}

/// The vector between the two that both together ask for.
Point combine(const SeenMotion& own, const MotionPrior& prior) {
  const Information& i = own.information;
  const Step step = solveStep(i.xx + prior.weight, i.xy, i.yy + prior.weight,
                              {i.xx * (own.at.x - prior.at.x) + i.xy * (own.at.y - prior.at.y),
                               i.xy * (own.at.x - prior.at.x) + i.yy * (own.at.y - prior.at.y)});
  const auto moved = [](int at, int64_t by) {
    return at + static_cast<int>(std::clamp<int64_t>(by, -kFarthest, kFarthest));
  };
  return {moved(prior.at.x, step.x), moved(prior.at.y, step.y)};
}

}  // namespace

std::span<const MotionPrior> MotionConsensus::run(const graph::Graph& graph,
                                                  std::span<const SeenMotion> own,
                                                  const Executor& executor) {
  findNeighbours(graph);
  ownTrust_.resize(own.size());
  before_.resize(own.size());
  after_.resize(own.size());
  priors_.assign(own.size(), {});
  for (size_t i = 0; i < own.size(); ++i) {
    ownTrust_[i] = trustOf(leastInformation(own[i].information), kLikeness);
    before_[i] = {own[i].at, ownTrust_[i]};
  }
  const size_t sweeps =
      std::clamp<size_t>(kMostVisits / std::max<size_t>(own.size(), 1), 1, kMostSweeps);
  for (size_t turn = 0; turn < sweeps; ++turn) {
    executor.forRows(static_cast<int>(own.size()), [&](int first, int last) {
      for (auto i = static_cast<size_t>(first); i < static_cast<size_t>(last); ++i)
        sweep(i, own[i]);
    });
    std::swap(before_, after_);
  }
  return priors_;
}

void MotionConsensus::findNeighbours(const graph::Graph& graph) {
  const size_t count = graph.regions.size();
  counts_.assign(count, 0);
  for (const graph::Arc& arc : graph.arcs) {
    ++counts_[arc.a.index()];
    ++counts_[arc.b.index()];
  }
  starts_.resize(count + 1);
  starts_[0] = 0;
  std::partial_sum(counts_.begin(), counts_.end(), starts_.begin() + 1);
  neighbours_.resize(starts_.back());
  std::fill(counts_.begin(), counts_.end(), 0u);
  for (const graph::Arc& arc : graph.arcs) {
    const uint32_t a = arc.a.index(), b = arc.b.index();
    const auto weight = static_cast<int32_t>(std::min<int64_t>(
        kinship(arc, graph.regions[a].colour, graph.regions[b].colour), INT32_MAX));
    neighbours_[starts_[a] + counts_[a]++] = {b, weight};
    neighbours_[starts_[b] + counts_[b]++] = {a, weight};
  }
  for (size_t i = 0; i < count; ++i) keepStrongest(i);
}

// A bound on the time: a region may have thousands of neighbours. Weights become shares of kOne².
void MotionConsensus::keepStrongest(size_t region) {
  Neighbour* first = neighbours_.data() + starts_[region];
  const size_t kept = std::min<size_t>(
      counts_[region], counts_.size() > kManyRegions ? kMostNeighboursOfMany : kMostNeighbours);
  std::partial_sort(first, first + kept, first + counts_[region],
                    [](const Neighbour& a, const Neighbour& b) {
                      return a.weight != b.weight ? a.weight > b.weight : a.region < b.region;
                    });
  counts_[region] = static_cast<uint32_t>(kept);
  int64_t sum = 1;
  for (size_t i = 0; i < kept; ++i) sum += first[i].weight;
  for (size_t i = 0; i < kept; ++i)
    first[i].weight = static_cast<int32_t>(first[i].weight * kOne * kOne / sum);
}

/// How much a vector is at odds with what the region saw and what its neighbours have.
int64_t MotionConsensus::disagreement(size_t region, const SeenMotion& own, Point at) const {
  constexpr int64_t kOwnShare = 77;  // Of kOne: 0.3.
  const int64_t dx = at.x - own.at.x, dy = at.y - own.at.y;
  const Information& i = own.information;
  // Quadratic form in units of kLikeness, 2^16 = one px².
  const int64_t form = (i.xx * dx * dx + 2 * i.xy * dx * dy + i.yy * dy * dy) / kLikeness;
  int64_t sum = kOwnShare * trustOf(std::max<int64_t>(form, 0), kAgreement) * kOne;
  for (const Neighbour& n : neighboursOf(region)) {
    const Belief& belief = before_[n.region];
    sum += n.weight * (belief.trust + kLeastTrust) / kOne * (kOne - agreement(at, belief.at));
  }
  return sum;
}

/// Of the region's vector and its neighbours', the one that all agree with best.
Point MotionConsensus::findCentre(size_t region, const SeenMotion& own) const {
  Point best = before_[region].at;
  int64_t least = disagreement(region, own, best);
  for (const Neighbour& n : neighboursOf(region)) {
    const Point at = before_[n.region].at;
    const int64_t cost = disagreement(region, own, at);
    if (cost < least) {
      least = cost;
      best = at;
    }
  }
  return best;
}

void MotionConsensus::sweep(size_t region, const SeenMotion& own) {
  after_[region] = before_[region];
  const Point centre = findCentre(region, own);
  int64_t weight = 0, x = 0, y = 0;
  for (const Neighbour& n : neighboursOf(region)) {
    const Belief& belief = before_[n.region];
    const int64_t fit = agreement(centre, belief.at);
    const int64_t share = n.weight * (belief.trust + kLeastTrust) / kOne * fit / kOne * fit / kOne;
    weight += share;
    x += share * (belief.at.x - centre.x);
    y += share * (belief.at.y - centre.y);
  }
  if (weight == 0) return;
  const Point mean{centre.x + static_cast<int>(divideRounded(x, weight)),
                   centre.y + static_cast<int>(divideRounded(y, weight))};
  // Shares of kOne² to 1/256 px⁻².
  const int64_t expected = std::max<int64_t>(weight * kLikeness / (kOne * kOne), 1);
  priors_[region] = {mean, expected};
  after_[region].at = combine(own, priors_[region]);
  const int64_t known = kLikeness * ownTrust_[region] / (kOne + 1 - ownTrust_[region]);
  after_[region].trust = trustOf(known + expected * 7 / 10, kLikeness);
}

}  // namespace rg::motion
