// SPDX-License-Identifier: LGPL-2.1-or-later
// Of our own and not CUB's: so the very code is tested on the host, and a scan of a frame's words
// is too small for a library to be faster.
#include "kernels/block_reduce.hpp"
#include "kernels/primitives.hpp"
#include "kernels/start.hpp"
#include "kernels/threads.hpp"

namespace rg::gpu {
namespace {

constexpr int kThreads = kReduceThreads, kEach = 4;
constexpr int kChunk = kThreads * kEach;
constexpr int kWarps = kReduceWarps;

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
