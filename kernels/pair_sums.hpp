// SPDX-License-Identifier: LGPL-2.1-or-later
// Adding to a PairTable and reading it; for .cu files only.
#pragma once

#include "core/base/pixel.hpp"
#include "kernels/device.hpp"
#include "kernels/pair_table.hpp"

namespace rg::gpu {

/// Returns the pair's slot.
__device__ inline uint32_t addPair(const PairTable& table, uint32_t slots, unsigned long long key,
                                   uint32_t value) {
  auto slot = static_cast<uint32_t>(mixHash64(key)) & (slots - 1);
  for (;; slot = (slot + 1) & (slots - 1)) {
    const unsigned long long old = atomicCAS(table.keys + slot, 0ull, key);
    if (old != 0 && old != key) continue;
    atomicAdd(table.sums + slot, value);
    return slot;
  }
}

__device__ inline void clearSlot(const PairTable& table, uint32_t slot) {
  table.keys[slot] = 0;
  table.sums[slot] = 0;
}

/// The places of those lanes that are `chosen` in a list of which *count are taken. All of the warp
/// must call.
__device__ inline uint32_t appendChosen(bool chosen, uint32_t* count) {
  const unsigned lanes = __ballot_sync(kFullWarp, chosen);
  const unsigned lane = threadIdx.x % kWarp;
  uint32_t first = 0;
  if (lane == 0 && lanes != 0) first = atomicAdd(count, static_cast<uint32_t>(__popcll(lanes)));
  first = __shfl_sync(kFullWarp, first, 0);
  return first + static_cast<uint32_t>(__popcll(lanes & ((1u << lane) - 1)));
}

}  // namespace rg::gpu
