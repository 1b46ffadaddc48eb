// SPDX-License-Identifier: LGPL-2.1-or-later
// What all threads of a block come to; for .cu files only.
#pragma once

#include "kernels/device.hpp"

namespace rg::gpu {

inline constexpr int kReduceThreads = 256;
inline constexpr int kReduceWarps = kReduceThreads / kWarp;

/// join(a, b) of all threads' values, in every thread. join must not care for the order. values: a
/// block's array of kReduceWarps. All threads of a block of kReduceThreads must call.
template <class T, class Array, class Join>
__device__ T reduceBlock(T value, Array& values, const Join& join) {
  for (int i = kWarp / 2; i > 0; i /= 2) {
    const T other = __shfl_xor_sync(kFullWarp, value, i);
    value = join(value, other);
  }
  const int thread = static_cast<int>(threadIdx.x);
  if (thread % kWarp == 0) values[thread / kWarp] = value;
  __syncthreads();
  T all = values[0];
  for (int i = 1; i < kReduceWarps; ++i) {
    const T other = values[i];
    all = join(all, other);
  }
  __syncthreads();  // The next call may write.
  return all;
}

}  // namespace rg::gpu
