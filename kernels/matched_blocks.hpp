// SPDX-License-Identifier: LGPL-2.1-or-later
// A block of threads for each region that is matched; for .cu files only.
#pragma once

#include "core/motion/textured_cells.hpp"
#include "kernels/block_reduce.hpp"
#include "kernels/shift_search.hpp"

#include <cstdint>

namespace rg::gpu::motion {

/// Calls visit(part, bit) for a thread's share of the blocks of the region that its block of
/// threads has.
template <class Visit>
__device__ void forOwnBits(const MatchedRegions& regions, const Visit& visit) {
  constexpr uint32_t kBlocks = 2 * rg::motion::kPartHeight;
  const uint32_t first = regions.starts[blockIdx.x], last = regions.starts[blockIdx.x + 1];
  for (uint32_t i = threadIdx.x; i < (last - first) * kBlocks; i += kReduceThreads) {
    const rg::motion::MatchedPart& part = regions.parts[first + i / kBlocks];
    const auto bit = static_cast<int>(i % kBlocks);
    if ((part.blocks >> bit & 1) != 0) visit(part, bit);
  }
}

/// The same, visit(x, y) with the block's first pixel.
template <class Visit>
__device__ void forOwnBlocks(const MatchedRegions& regions, const Visit& visit) {
  forOwnBits(regions, [&](const rg::motion::MatchedPart& part, int bit) {
    visit(part.x() + bit % 2 * rg::motion::kBlockWidth, part.y() + bit / 2);
  });
}

/// A block for each region, of which no more pixels are matched than are enough.
inline Launch overRegions(const char* name, int count, double bytes, double operations) {
  const double pixels = static_cast<double>(count) * rg::motion::kEnoughPx;
  return {name,
          {static_cast<unsigned>(count), 1, 1},
          {kReduceThreads, 1, 1},
          {bytes * pixels, operations * pixels}};
}

}  // namespace rg::gpu::motion
