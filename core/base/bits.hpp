// SPDX-License-Identifier: LGPL-2.1-or-later
// What <bit> counts, for functions that devices call, too: of std's functions of 64 bits nvcc makes
// constants there, and says nothing.
#pragma once

#include <bit>
#include <cstdint>

namespace rg {

/// How many bits it takes to write the number; none for 0.
[[nodiscard]] constexpr int bitWidth(uint64_t number) {
  const auto upper = static_cast<uint32_t>(number >> 32);
  return static_cast<int>(upper != 0 ? 32 + std::bit_width(upper)
                                     : std::bit_width(static_cast<uint32_t>(number)));
}
static_assert(bitWidth(0) == 0 && bitWidth(1) == 1 && bitWidth(0xFFFFFFFF) == 32 &&
              bitWidth(uint64_t{1} << 32) == 33 && bitWidth(~uint64_t{0}) == 64);

/// The least power of two that is not less than the number, which must be at most 2^31.
[[nodiscard]] constexpr uint32_t bitCeil(uint32_t number) {
  return std::bit_ceil(number);
}

}  // namespace rg
