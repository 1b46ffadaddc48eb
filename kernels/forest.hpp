// SPDX-License-Identifier: LGPL-2.1-or-later
// Sets that are joined by atomicMin on the least member, so that any order of joins ends in the
// same forest; for .cu files only.
#pragma once

#include "kernels/device.hpp"

#include <algorithm>
#include <cstdint>

namespace rg::gpu {

__device__ inline uint32_t rootOf(const uint32_t* parents, uint32_t node) {
  while (parents[node] != node) node = parents[node];
  return node;
}

/// The same, and makes the way to it half as long. A parent may be written that has got a lesser
/// one meanwhile: it is an ancestor still, and who gave the lesser one joins both.
__device__ inline uint32_t shortenToRoot(uint32_t* parents, uint32_t node) {
  for (uint32_t parent = parents[node]; parent != node;) {
    const uint32_t next = parents[parent];
    if (next == parent) return parent;
    parents[node] = next;
    node = next;
    parent = parents[node];
  }
  return node;
}

/// Parents are less than what they are of, so one that was read too early is still one of the
/// ancestors; who loses a race goes on with what the winner wrote.
__device__ inline void join(uint32_t* parents, uint32_t a, uint32_t b) {
  for (;;) {
    a = shortenToRoot(parents, a);
    b = shortenToRoot(parents, b);
    if (a == b) return;
    const uint32_t less = isMutated(Mutant::WrongTieBreak) ? std::max(a, b) : std::min(a, b);
    const uint32_t more = a ^ b ^ less;
    if (isMutated(Mutant::WrongTieBreak)) {
      parents[more] = less;
      return;
    }
    const uint32_t old = atomicMin(parents + more, less);
    if (old == more) return;
    a = old;
    b = less;
  }
}

}  // namespace rg::gpu
