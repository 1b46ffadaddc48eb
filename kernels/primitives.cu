// SPDX-License-Identifier: LGPL-2.1-or-later
// Of our own and not CUB's: so the very code is tested on the host, and a scan of a frame's words
// is too small for a library to be faster.
#include "kernels/primitives.hpp"
#include "kernels/start.hpp"
#include "kernels/threads.hpp"

namespace rg::gpu {
namespace {

constexpr int kThreads = 256, kEach = 4;
constexpr int kChunk = kThreads * kEach;
constexpr int kWarps = kThreads / kWarp;

/// The sum of the threads before this one in the block; `total` is that of all. warpSums: a block's
/// array of kWarps. All threads must call.
template <class Array>
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
  for (int i = 0; i < kWarps; ++i) {
    const uint32_t of = warpSums[i];
    if (i < warp) earlier += of;
    total += of;
  }
  __syncthreads();  // The next call may write.
  return earlier + sum - value;
}

/// Sums within each chunk, and the chunks' totals.
__global__ void scanChunks(const uint32_t* numbers, int count, uint32_t* sums, uint32_t* totals) {
  RG_SHARED(uint32_t, warpSums, kWarps);
  const int first = static_cast<int>(blockIdx.x) * kChunk + static_cast<int>(threadIdx.x) * kEach;
  uint32_t own[kEach], sum = 0;
  for (int i = 0; i < kEach; ++i) {
    own[i] = first + i < count ? numbers[first + i] : 0;
    sum += own[i];
  }
  uint32_t total = 0;
  uint32_t before = sumBefore(sum, warpSums, total);
  for (int i = 0; i < kEach; ++i) {
    if (first + i < count) sums[first + i] = before;
    before += own[i];
  }
  if (threadIdx.x == 0) totals[blockIdx.x] = total;
}

/// One block, a chunk of threads after the other.
__global__ void scanTotals(uint32_t* totals, int count) {
  RG_SHARED(uint32_t, warpSums, kWarps);
  uint32_t carried = 0;
  for (int first = 0; first < count; first += kThreads) {
    const int i = first + static_cast<int>(threadIdx.x);
    uint32_t total = 0;
    const uint32_t before = sumBefore(i < count ? totals[i] : 0, warpSums, total);
    if (i < count) totals[i] = carried + before;
    carried += total;
  }
  if (threadIdx.x == 0) totals[count] = carried;
}

__global__ void addTotals(const uint32_t* totals, int chunks, int count, uint32_t* sums) {
  const int i = indexInGrid();
  if (i < count) sums[i] += totals[i / kChunk];
  if (i == count) sums[count] = totals[chunks];
}

}  // namespace

void scan(const uint32_t* numbers, int count, uint32_t* sums, uint32_t* scratch, Stream stream) {
  const int chunks = scanScratchOf(count);
  const double bytes = 4.0 * count;
  start({"scanChunks", {static_cast<unsigned>(chunks), 1, 1}, {kThreads, 1, 1}, {2 * bytes, bytes}},
        stream, scanChunks, numbers, count, sums, scratch);
  start({"scanTotals", {1, 1, 1}, {kThreads, 1, 1}, {8.0 * chunks, 4.0 * chunks}}, stream,
        scanTotals, scratch, chunks);
  start(launchOverList("addTotals", int64_t{count} + 1, {2 * bytes, bytes / 4}), stream, addTotals,
        static_cast<const uint32_t*>(scratch), chunks, count, sums);
}

}  // namespace rg::gpu
