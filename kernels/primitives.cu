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
static_assert(kChunk % kThreads == 0 && kThreads == 256);  // A block of a list is in one chunk.

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

/// Each block sums the totals of the chunks before its own once more: they are few, and a launch
/// that does it for all blocks would take longer.
__global__ void addTotals(const uint32_t* totals, int count, uint32_t* sums) {
  RG_SHARED(uint32_t, warpSums, kWarps);
  const int i = indexInGrid(), chunk = i / kChunk;
  uint32_t own = 0;
  for (int k = static_cast<int>(threadIdx.x); k < chunk; k += kThreads) own += totals[k];
  const uint32_t before = reduceBlock(own, warpSums, Total{});
  if (i < count) sums[i] += before;
  if (i == count - 1) sums[count] = before + totals[chunk];
}

}  // namespace

void scan(const uint32_t* numbers, int count, uint32_t* sums, uint32_t* scratch, Stream stream) {
  const int chunks = scanScratchOf(count);
  const double bytes = 4.0 * count;
  start({"scanChunks", {static_cast<unsigned>(chunks), 1, 1}, {kThreads, 1, 1}, {2 * bytes, bytes}},
        stream, scanChunks, numbers, count, sums, scratch);
  start(launchOverList("addTotals", count, {2 * bytes, bytes}), stream, addTotals,
        static_cast<const uint32_t*>(scratch), count, sums);
}

}  // namespace rg::gpu
