// SPDX-License-Identifier: LGPL-2.1-or-later
// Where a thread is, and words of 64 columns from the bits of a warp; for .cu files only.
#pragma once

#include "kernels/device.hpp"
#include "kernels/views.hpp"

namespace rg::gpu {

/// The pixel of a thread of launchOver().
__device__ inline Point pixelOfThread() {
  return {static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x),
          static_cast<int>(blockIdx.y * blockDim.y + threadIdx.y)};
}

/// The word (x) and row (y) of a warp of launchOverWords().
__device__ inline Point wordOfWarp() {
  return {static_cast<int>(blockIdx.x), static_cast<int>(blockIdx.y * blockDim.y + threadIdx.y)};
}

__device__ inline bool isWithin(Point p, Size size) {
  return p.x < size.width && p.y < size.height;
}

__device__ inline int threadOfBlock() {
  return static_cast<int>(threadIdx.y * blockDim.x + threadIdx.x);
}

__device__ inline int indexInGrid() {
  return static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x);
}

__device__ inline uint32_t threadsOfGrid() {
  return gridDim.x * blockDim.x;
}

/// Calls visit(column) for each set bit of a word whose first column is `first`.
template <class Visit>
__device__ void forBits(uint64_t bits, int first, const Visit& visit) {
  for (; bits != 0; bits &= bits - 1) visit(first + __ffsll(static_cast<long long>(bits)) - 1);
}

/// A word of which each lane knows the columns `lane` and `lane` + 32. The whole warp must call.
__device__ inline uint64_t packWord(bool low, bool high) {
  const uint64_t lower = __ballot_sync(kFullWarp, low);
  const uint64_t upper = __ballot_sync(kFullWarp, high);
  return lower | upper << kWarp;
}

/// Bits of one word that `isChosen` is true for, looked at by a warp.
template <class Choice>
__device__ inline uint64_t chooseBits(uint64_t bits, Point word, const Choice& isChosen) {
  const int lane = static_cast<int>(threadIdx.x);
  const auto at = [&](int column) {
    return (bits >> column & 1) != 0 && isChosen(Point{word.x * kWordColumns + column, word.y});
  };
  return packWord(at(lane), at(lane + kWarp));
}

}  // namespace rg::gpu
