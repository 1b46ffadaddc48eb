// SPDX-License-Identifier: LGPL-2.1-or-later
// Sums over neighbouring lanes that belong together, so that a warp adds them to memory once; for
// .cu files only. All lanes of a warp must call.
#pragma once

#include "kernels/device.hpp"

#include <cstdint>

namespace rg::gpu {

/// Of all lanes, in each of them.
template <class T>
__device__ T sumOfWarp(T value) {
  for (int i = kWarp / 2; i > 0; i /= 2) value += __shfl_xor_sync(kFullWarp, value, i);
  return value;
}

template <class T>
__device__ T leastOfWarp(T value) {
  for (int i = kWarp / 2; i > 0; i /= 2) {
    const T other = __shfl_xor_sync(kFullWarp, value, i);
    value = other < value ? other : value;
  }
  return value;
}

/// Neighbouring lanes of one key.
struct LaneRun {
  int before;   ///< Lanes of it before this one.
  bool isLast;  ///< This lane is its last one.
};
__device__ inline LaneRun runOfLane(uint32_t key) {
  const unsigned lane = threadIdx.x % kWarp;
  const uint32_t left = __shfl_up_sync(kFullWarp, key, 1);
  const unsigned begins = __ballot_sync(kFullWarp, lane == 0 || left != key);
  const int first = kWarp - 1 - __clz(begins & kFullWarp >> (kWarp - 1 - lane));
  return {static_cast<int>(lane) - first,
          lane == kWarp - 1 || (begins >> (lane + 1) % kWarp & 1) != 0};
}

/// Of the run's lanes up to this one.
template <class T>
__device__ T sumOfRun(const LaneRun& run, T value) {
  for (int i = 1; i < kWarp; i *= 2) {
    const T before = __shfl_up_sync(kFullWarp, value, static_cast<unsigned>(i));
    if (run.before >= i) value += before;
  }
  return value;
}

template <class T>
__device__ void addSum(T& to, uint64_t value) {
  static_assert(sizeof(T) == sizeof(unsigned long long));
  atomicAdd(reinterpret_cast<unsigned long long*>(&to), static_cast<unsigned long long>(value));
}

}  // namespace rg::gpu
