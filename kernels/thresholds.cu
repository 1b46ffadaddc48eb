// SPDX-License-Identifier: LGPL-2.1-or-later
// One block, of which each thread has a level: what core looks for upwards is the best of keys in
// which the lower level wins.
#include "kernels/block_reduce.hpp"
#include "kernels/start.hpp"
#include "kernels/thresholds.hpp"

namespace rg::gpu {
namespace {

constexpr int kLevels = 256;
static_assert(kReduceThreads == kLevels);

using Key = unsigned long long;

struct Larger {
  template <class T>
  __device__ T operator()(T a, T b) const {
    return a > b ? a : b;
  }
};

/// The largest value of all levels, at the lowest of the levels that have it.
struct Best {
  Key value;
  int level;
};
/// value: below 2^56.
template <class Array>
__device__ Best bestOf(Key value, Array& values) {
  const Key own = value << 8 | (kLevels - 1 - threadIdx.x);
  const Key best = reduceBlock(own, values, Larger{});
  return {best >> 8, kLevels - 1 - static_cast<int>(best & (kLevels - 1))};
}

/// How many pixels do not exceed the thread's level, and how many there are.
struct Below {
  uint32_t upTo, total;
};
template <class Array>
__device__ Below countBelow(const uint32_t* levels, Array& sums) {
  const uint32_t own = levels[threadIdx.x];
  uint32_t total = 0;
  const uint32_t before = sumBefore(own, sums, total);
  return {before + own, total};
}

template <class Array>
__device__ int quantileOf(const Below& below, int share, Array& values) {
  const bool isReached =
      uint64_t{below.upTo} * kLevels >= uint64_t{below.total} * static_cast<uint64_t>(share);
  return bestOf(isReached ? 1 : 0, values).level;
}

/// The level below the line from the histogram's peak to its last level by most (Rosin).
template <class Array>
__device__ int cornerOf(const uint32_t* levels, Array& values) {
  const int level = static_cast<int>(threadIdx.x);
  const int64_t count = levels[level];
  const Best peak = bestOf(static_cast<Key>(count), values);
  const int tail =
      static_cast<int>(reduceBlock(Key{count > 0 ? threadIdx.x : 0}, values, Larger{}));
  const auto height = static_cast<int64_t>(peak.value);
  const int64_t distance = height * (tail - level) - count * (tail - peak.level);
  const bool isBetween = level >= peak.level && level <= tail && distance > 0;
  const Best corner = bestOf(isBetween ? static_cast<Key>(distance) : 0, values);
  return corner.value > 0 ? corner.level : peak.level;
}

__global__ void findQuantile(const uint32_t* levels, int share, int* out) {
  RG_SHARED(uint32_t, sums, kReduceWarps);
  RG_SHARED(Key, values, kReduceWarps);
  const int level = quantileOf(countBelow(levels, sums), share, values);
  if (threadIdx.x == 0) *out = level;
}

__global__ void findDifferenceThreshold(const uint32_t* levels, int least, int* out) {
  RG_SHARED(uint32_t, sums, kReduceWarps);
  RG_SHARED(Key, values, kReduceWarps);
  const int noise = 3 * (quantileOf(countBelow(levels, sums), 128, values) + 1);
  const int threshold = std::max(cornerOf(levels, values), std::max(noise, least));
  if (threadIdx.x == 0) *out = std::min(255, threshold);
}

__global__ void findContrastThreshold(const uint32_t* levels, int least, int* out) {
  RG_SHARED(uint32_t, sums, kReduceWarps);
  RG_SHARED(Key, values, kReduceWarps);
  constexpr int kTenth = 26;  // Of 256.
  const Below below = countBelow(levels, sums);
  const int high = quantileOf(below, 256 - kTenth, values);
  const int low = quantileOf(below, kTenth, values);
  if (threadIdx.x == 0) *out = std::min(255, std::max((high - low) / 8, least));
}

constexpr Launch oneBlock(const char* name) {
  return {name, {1, 1, 1}, {kReduceThreads, 1, 1}, {1024, 8192}};
}

}  // namespace

void quantile(const uint32_t* levels, int share, int* level, Stream stream) {
  start(oneBlock("quantile"), stream, findQuantile, levels, share, level);
}

void differenceThreshold(const uint32_t* levels, int least, int* threshold, Stream stream) {
  start(oneBlock("differenceThreshold"), stream, findDifferenceThreshold, levels, least, threshold);
}

void contrastThreshold(const uint32_t* levels, int least, int* threshold, Stream stream) {
  start(oneBlock("contrastThreshold"), stream, findContrastThreshold, levels, least, threshold);
}

}  // namespace rg::gpu
