// SPDX-License-Identifier: LGPL-2.1-or-later
// Sets that are joined step by step: a forest of parents, each no larger than its children, so that
// a set is called by its smallest member whatever the order of the joins.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

namespace rg {

/// The smallest member of the node's set; shortens the way there.
[[nodiscard]] inline uint32_t rootOf(std::vector<uint32_t>& parent, uint32_t node) {
  while (parent[node] != node) node = parent[node] = parent[parent[node]];
  return node;
}

inline void join(std::vector<uint32_t>& parent, uint32_t a, uint32_t b) {
  const uint32_t rootA = rootOf(parent, a), rootB = rootOf(parent, b);
  parent[std::max(rootA, rootB)] = std::min(rootA, rootB);
}

/// Replaces each parent by the number of its set: sets count from 0 in the order of their smallest
/// members. Returns how many there are.
inline uint32_t numberSets(std::vector<uint32_t>& parent) {
  uint32_t count = 0;
  for (uint32_t i = 0; i < parent.size(); ++i)
    parent[i] = parent[i] == i ? count++ : parent[parent[i]];
  return count;
}

}  // namespace rg
