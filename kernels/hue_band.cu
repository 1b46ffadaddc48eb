// SPDX-License-Identifier: LGPL-2.1-or-later
#include "kernels/block_reduce.hpp"
#include "kernels/hue_of.hpp"
#include "kernels/hues.hpp"
#include "kernels/start.hpp"
#include "kernels/threads.hpp"

namespace rg::gpu::segmentation {
namespace {

using rg::segmentation::HueBand;
using rg::segmentation::kHueCount;
using rg::segmentation::kHueSampleStep;

constexpr int kCountedRows = 8;

/// Each block counts for itself first: backgrounds are of few hues.
__global__ void countHues(const __grid_constant__ Planes picture, Size samples, uint32_t* levels) {
  RG_SHARED(uint32_t, own, kHueCount);
  for (int i = threadOfBlock(); i < kHueCount; i += kTile.x * kTile.y) own[i] = 0;
  __syncthreads();
  const int x = static_cast<int>(blockIdx.x * kTile.x + threadIdx.x);
  const int top = static_cast<int>((blockIdx.y * kTile.y + threadIdx.y) * kCountedRows);
  for (int y = top; y < std::min(top + kCountedRows, samples.height); ++y) {
    const int hue = x < samples.width ? hueAt(picture, {x * kHueSampleStep, y * kHueSampleStep})
                                      : rg::segmentation::kAchromatic;
    if (hue != rg::segmentation::kAchromatic) atomicAdd(&own[hue], 1u);
  }
  __syncthreads();
  for (int i = threadOfBlock(); i < kHueCount; i += kTile.x * kTile.y) {
    const uint32_t count = own[i];
    if (count != 0) atomicAdd(levels + i, count);
  }
}

struct Larger {
  __device__ unsigned long long operator()(unsigned long long a, unsigned long long b) const {
    return a > b ? a : b;
  }
};

/// One block. The lowest of equal peaks is the best of keys in which lower hues win; the band ends
/// before the nearest hue on either side that is too rare.
__global__ void chooseBand(const uint32_t* levels, uint64_t samples, HueBand* band) {
  RG_SHARED(uint32_t, sums, kHueCount);
  RG_SHARED(unsigned long long, values, kReduceWarps);
  using Key = unsigned long long;
  const auto thread = static_cast<int>(threadIdx.x);
  Key counted = 0, key = 0;
  for (int hue = thread; hue < kHueCount; hue += kReduceThreads) {
    uint32_t sum = 0;
    constexpr int kReach = rg::segmentation::kSmoothingReach;
    for (int d = -kReach; d <= kReach; ++d) sum += levels[rg::segmentation::wrapped(hue + d)];
    sums[hue] = sum;
    counted += levels[hue];
    key = Larger{}(key, Key{sum} << 16 | static_cast<Key>(kHueCount - 1 - hue));
  }
  counted = reduceBlock(counted, values, Total{});
  key = reduceBlock(key, values, Larger{});
  const int peak = kHueCount - 1 - static_cast<int>(key & 0xFFFF);
  const auto least = static_cast<uint32_t>(key >> 16) / rg::segmentation::kTailShare;
  constexpr int kMost = kHueCount / 2;
  Key below = 0, above = 0;  // By how much the nearest rare hue lies before the farthest.
  for (int d = 1 + thread; d <= kMost; d += kReduceThreads) {
    const auto before = static_cast<Key>(kMost - (d - 1));
    if (sums[rg::segmentation::wrapped(peak - d)] <= least) below = Larger{}(below, before);
    if (sums[rg::segmentation::wrapped(peak + d)] <= least) above = Larger{}(above, before);
  }
  below = reduceBlock(below, values, Larger{});
  above = reduceBlock(above, values, Larger{});
  if (thread != 0) return;
  *band = rg::segmentation::isColourful(counted, samples)
              ? rg::segmentation::bandRound(peak, kMost - static_cast<int>(below),
                                            kMost - static_cast<int>(above))
              : HueBand{};
}

}  // namespace

void findFrameBand(const Planes& picture, uint32_t* levels, HueBand* band, Stream stream) {
  const auto along = [](int length) { return (length + kHueSampleStep - 1) / kHueSampleStep; };
  const Size samples{along(picture.size().width), along(picture.size().height)};
  const auto count = static_cast<double>(samples.area());
  clear(levels, kHueCount * sizeof *levels, stream);
  if (picture.channels == 3)
    start(
        {"countHues",
         {blocksFor(samples.width, kTile.x), blocksFor(samples.height, kTile.y * kCountedRows), 1},
         kTile,
         {3 * kHueSampleStep * count, 30 * count}},
        stream, countHues, picture, samples, levels);
  start({"chooseBand", {1, 1, 1}, {kReduceThreads, 1, 1}, {4 * kHueCount, 40 * kHueCount}}, stream,
        chooseBand, static_cast<const uint32_t*>(levels), static_cast<uint64_t>(samples.area()),
        band);
}

}  // namespace rg::gpu::segmentation
