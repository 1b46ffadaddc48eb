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
/// scanScratchOf(count) + 1.
void scan(const uint32_t* numbers, int count, uint32_t* sums, uint32_t* scratch, Stream stream);

}  // namespace rg::gpu
