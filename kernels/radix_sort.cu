// SPDX-License-Identifier: LGPL-2.1-or-later
// Of our own and not CUB's: so the very code is tested on the host, and how many pairs there are
// need not be known there.
#include "kernels/block_reduce.hpp"
#include "kernels/primitives.hpp"
#include "kernels/start.hpp"
#include "kernels/threads.hpp"

#include <utility>

namespace rg::gpu {
namespace {

constexpr int kRounds = kSortTile / kReduceThreads, kDigitBits = 8;
static_assert(kSortDigits == kReduceThreads);  // A thread for each digit.

/// A digit of the keys.
struct Digit {
  int shift;
  __device__ int of(uint32_t key) const { return static_cast<int>(key >> shift & 255); }
};

/// The lanes whose digit is that of this one, and none that have none (below 0).
__device__ unsigned lanesLike(int digit) {
  unsigned lanes = __ballot_sync(kFullWarp, digit >= 0);
  for (int bit = 0; bit < kDigitBits; ++bit) {
    const unsigned set = __ballot_sync(kFullWarp, (digit >> bit & 1) != 0);
    lanes &= (digit >> bit & 1) != 0 ? set : ~set;
  }
  return lanes;
}

/// A warp has a piece of a tile to itself, 32 pairs after the other: visit(place, isInside).
template <class Visit>
__device__ void forPieceOf(uint32_t count, const Visit& visit) {
  const auto warp = static_cast<int>(threadIdx.x) / kWarp;
  const auto lane = static_cast<int>(threadIdx.x) % kWarp;
  for (int round = 0; round < kRounds; ++round) {
    const auto place = static_cast<uint32_t>(static_cast<int>(blockIdx.x) * kSortTile +
                                             (warp * kRounds + round) * kWarp + lane);
    visit(place, place < count);
  }
}

/// How many of each digit a block's warps have: counts[warp · kSortDigits + digit].
template <class Array>
__device__ void countDigits(const uint32_t* keys, uint32_t count, Digit digit, Array& counts) {
  for (int i = static_cast<int>(threadIdx.x); i < kReduceWarps * kSortDigits; i += kReduceThreads)
    counts[i] = 0;
  __syncthreads();
  const int own = static_cast<int>(threadIdx.x) / kWarp * kSortDigits;
  forPieceOf(count, [&](uint32_t place, bool isInside) {
    if (isInside) atomicAdd(&counts[own + digit.of(keys[place])], 1u);
  });
  __syncthreads();
}

/// offsets: of each digit, of each block. So their sums are where a block's pairs go.
__global__ void countTiles(const uint32_t* keys, const uint32_t* count, Digit digit,
                           uint32_t* offsets) {
  RG_SHARED(uint32_t, counts, kReduceWarps * kSortDigits);
  countDigits(keys, *count, digit, counts);
  uint32_t sum = 0;
  for (int warp = 0; warp < kReduceWarps; ++warp)
    sum += counts[warp * kSortDigits + static_cast<int>(threadIdx.x)];
  offsets[threadIdx.x * gridDim.x + blockIdx.x] = sum;
}

__global__ void placePairs(SortView pairs, const uint32_t* count, Digit digit) {
  RG_SHARED(uint32_t, places, kReduceWarps * kSortDigits);
  countDigits(pairs.keys, *count, digit, places);
  uint32_t next = pairs.offsets[threadIdx.x * gridDim.x + blockIdx.x];
  for (int warp = 0; warp < kReduceWarps; ++warp) {
    const int at = warp * kSortDigits + static_cast<int>(threadIdx.x);
    const uint32_t own = places[at];
    places[at] = next;
    next += own;
  }
  __syncthreads();
  const int own = static_cast<int>(threadIdx.x) / kWarp * kSortDigits;
  const unsigned below = (1u << threadIdx.x % kWarp) - 1;
  forPieceOf(*count, [&](uint32_t place, bool isInside) {
    const uint32_t key = isInside ? pairs.keys[place] : 0;
    const int found = isInside ? digit.of(key) : -1;
    const unsigned like = lanesLike(found);
    uint32_t to = 0;
    if (isInside) to = places[own + found];
    __syncwarp();
    const auto before = static_cast<uint32_t>(__popcll(like & below));
    if (isInside) {
      pairs.otherKeys[to + before] = key;
      pairs.otherValues[to + before] = pairs.values[place];
      if (before == 0) places[own + found] = to + static_cast<uint32_t>(__popcll(like));
    }
    __syncwarp();
  });
}

}  // namespace

void sortPairs(const SortView& pairs, int capacity, const uint32_t* count, Stream stream) {
  const unsigned tiles = blocksFor(capacity, kSortTile);
  const int offsets = sortOffsetsOf(capacity);
  SortView view = pairs;
  for (int shift = 0; shift < 32; shift += kDigitBits) {
    const Digit digit{shift};
    start({"countTiles", {tiles, 1, 1}, {kReduceThreads, 1, 1}, {4.0 * offsets, 4.0 * offsets}},
          stream, countTiles, static_cast<const uint32_t*>(view.keys), count, digit, view.offsets);
    scan(view.offsets, offsets, view.offsets, view.scratch, stream);
    start({"placePairs", {tiles, 1, 1}, {kReduceThreads, 1, 1}, {4.0 * offsets, 8.0 * offsets}},
          stream, placePairs, view, count, digit);
    std::swap(view.keys, view.otherKeys);
    std::swap(view.values, view.otherValues);
  }
}

}  // namespace rg::gpu
