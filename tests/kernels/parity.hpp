// SPDX-License-Identifier: LGPL-2.1-or-later
// What the comparisons of kernels with core share: sizes, pictures, the list of them.
#pragma once

#include "core/base/memory/executor.hpp"
#include "kernels/kernels.hpp"
#include "tests/core/fills.hpp"
#include "tests/kernels/device_memory.hpp"

#include <gtest/gtest.h>

#include <array>
#include <memory>
#include <string>

namespace rg::test {

#define RG_DECLARE(name, core, gpu) void parity_##name();
RG_GPU_OPERATIONS(RG_DECLARE)
#undef RG_DECLARE

/// Narrower than a warp, as wide as a word and one more or less, several blocks in both directions.
inline constexpr std::array kSizes{Size{1, 1},   Size{2, 3},   Size{31, 9},  Size{63, 8},
                                   Size{64, 17}, Size{65, 16}, Size{131, 67}};

[[nodiscard]] inline const Executor& oneThread() {
  static const Executor only(1);
  return only;
}

/// Calls check(size, fill) for all sizes and pictures, until one fails.
template <class Check>
void forSizesAndFills(const Check& check) {
  for (const Size size : kSizes)
    for (int fill = 0; fill < kFills && !::testing::Test::HasFailure(); ++fill) {
      SCOPED_TRACE(std::to_string(size.width) + "x" + std::to_string(size.height) + ", fill " +
                   std::to_string(fill));
      check(size, fill);
    }
}

/// Pixels that are set in one of eight places, in patches and alone.
[[nodiscard]] inline BitMask scattered(Size size, uint32_t what) {
  BitMask mask(size);
  mask.clear();
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      if (hashOf(x / 5, y / 4, what) % 4 == 0 || hashOf(x, y, what + 1) % 16 == 0) mask.set(x, y);
  return mask;
}

}  // namespace rg::test
