// SPDX-License-Identifier: LGPL-2.1-or-later
// What kernels of all stages are made of.
#pragma once

#include "kernels/launch.hpp"

#include <cstdint>

namespace rg::gpu {

/// How many sums a scan of `count` numbers needs as scratch.
[[nodiscard]] constexpr int scanScratchOf(int count) {
  return static_cast<int>(blocksFor(count, 1024));
}

/// sums[i] = numbers[0] + … + numbers[i − 1] for i = 0 … count: so sums holds one more than
/// numbers, and the last one is the total. They may be the same memory. scratch:
/// scanScratchOf(count).
void scan(const uint32_t* numbers, int count, uint32_t* sums, uint32_t* scratch, Stream stream);

/// Keys with a value each, room for as many again, and what sorting needs, all for `capacity`
/// pairs.
inline constexpr int kSortTile = 2048, kSortDigits = 256;
[[nodiscard]] constexpr int sortOffsetsOf(int capacity) {
  return kSortDigits * static_cast<int>(blocksFor(capacity, kSortTile));
}
struct SortView {
  uint32_t *keys, *values, *otherKeys, *otherValues;
  uint32_t* offsets;  ///< sortOffsetsOf(capacity) + 1.
  uint32_t* scratch;  ///< scanScratchOf(sortOffsetsOf(capacity)).
};
/// Sorts the first *count pairs by their keys; equal keys stay in their order.
void sortPairs(const SortView& pairs, int capacity, const uint32_t* count, Stream stream);

}  // namespace rg::gpu
