// SPDX-License-Identifier: LGPL-2.1-or-later
// What all threads of a block come to; for .cu files only.
#pragma once

#include "kernels/device.hpp"

#include <cstdint>

namespace rg::gpu {

inline constexpr int kReduceThreads = 256;
inline constexpr int kReduceWarps = kReduceThreads / kWarp;

/// For reduceBlock().
struct Total {
  template <class T>
  __device__ T operator()(T a, T b) const {
    return a + b;
  }
};
struct Least {
  template <class T>
  __device__ T operator()(T a, T b) const {
    return a < b ? a : b;
  }
};

/// join(a, b) of all threads' values, in every thread. join must not care for the order. values: a
/// block's array of as many as it has warps. All of its threads must call.
template <int warps = kReduceWarps, class T, class Array, class Join>
__device__ T reduceBlock(T value, Array& values, const Join& join) {
  for (int i = kWarp / 2; i > 0; i /= 2) {
    const T other = __shfl_xor_sync(kFullWarp, value, i);
    value = join(value, other);
  }
  const int thread = static_cast<int>(threadIdx.x);
  if (thread % kWarp == 0) values[thread / kWarp] = value;
  __syncthreads();
  T all = values[0];
  for (int i = 1; i < warps; ++i) {
    const T other = values[i];
    all = join(all, other);
  }
  __syncthreads();  // The next call may write.
  return all;
}

/// The sum of the threads before this one in the block; `total` is that of all. warpSums: a block's
/// array of as many as it has warps. All threads must call.
template <int warps = kReduceWarps, class Array>
__device__ uint32_t sumBefore(uint32_t value, Array& warpSums, uint32_t& total) {
  const int lane = static_cast<int>(threadIdx.x) % kWarp,
            warp = static_cast<int>(threadIdx.x) / kWarp;
  uint32_t sum = value;
  for (int i = 1; i < kWarp; i *= 2) {
    const uint32_t before = __shfl_up_sync(kFullWarp, sum, static_cast<unsigned>(i));
    if (lane >= i) sum += before;
  }
  if (lane == kWarp - 1) warpSums[warp] = sum;
  __syncthreads();
  uint32_t earlier = 0;
  total = 0;
  for (int i = 0; i < warps; ++i) {
    const uint32_t of = warpSums[i];
    if (i < warp) earlier += of;
    total += of;
  }
  __syncthreads();  // The next call may write.
  return earlier + sum - value;
}

}  // namespace rg::gpu
