// SPDX-License-Identifier: LGPL-2.1-or-later
// The exact optimum that core/objects/merge/mrf_merge.hpp comes close to, by trying all partitions.
#pragma once

#include "core/objects/merge/mrf_merge.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace rg::testing {

inline constexpr uint32_t kMostNodes = 32;

/// Node by node, each joins a group that is there or begins one; what the rest could still gain
/// cuts the search.
class BestPartition {
 public:
  BestPartition(uint32_t nodeCount, std::span<const objects::WeightedArc> arcs)
      : weights_(nodeCount) {
    for (const objects::WeightedArc& arc : arcs) weights_[arc.b].push_back({arc.a, arc.weight});
    for (uint32_t node = nodeCount; node-- > 0;) {
      int64_t gain = node + 1 < nodeCount ? bound_[node + 1] : 0;
      for (const auto& [other, weight] : weights_[node]) gain += std::max<int64_t>(0, weight);
      bound_[node] = gain;
    }
    visit(0, 0, 0);
  }
  [[nodiscard]] int64_t keptWeight() const { return best_; }

 private:
  void visit(uint32_t node, uint32_t groups, int64_t kept) {
    if (node == weights_.size()) {
      best_ = std::max(best_, kept);
      return;
    }
    if (kept + bound_[node] <= best_) return;
    for (uint32_t group = 0; group <= groups; ++group) {
      groupOf_[node] = group;
      int64_t gain = 0;
      for (const auto& [other, weight] : weights_[node])
        if (groupOf_[other] == group) gain += weight;
      visit(node + 1, std::max(groups, group + 1), kept + gain);
    }
  }

  std::vector<std::vector<std::pair<uint32_t, int64_t>>> weights_;
  std::array<uint32_t, kMostNodes> groupOf_{};
  std::array<int64_t, kMostNodes + 1> bound_{};
  int64_t best_ = 0;
};

/// The most weight that any partition keeps. Arcs have a < b < nodeCount ≤ kMostNodes.
inline int64_t bestKeptWeight(uint32_t nodeCount, std::span<const objects::WeightedArc> arcs) {
  return BestPartition(nodeCount, arcs).keptWeight();
}

}  // namespace rg::testing
