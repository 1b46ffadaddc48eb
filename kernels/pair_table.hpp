// SPDX-License-Identifier: LGPL-2.1-or-later
// Sums by pairs of numbers: a hash table of open addresses in device memory. In which slot a pair
// ends depends on the order of the threads, its sum does not.
#pragma once

#include "core/base/pixel.hpp"

#include <algorithm>
#include <cstdint>

namespace rg::gpu {

struct PairTable {
  unsigned long long* keys;  ///< a << 32 | b with a < b; 0 = free.
  uint32_t* sums;
};

/// How many slots so many different pairs take: a power of two, at least half of them free.
[[nodiscard]] constexpr uint32_t slotsFor(uint64_t pairs) {
  return bitCeil(static_cast<uint32_t>(std::max(uint64_t{64}, 2 * pairs)));
}

[[nodiscard]] constexpr unsigned long long pairKey(uint32_t a, uint32_t b) {
  const uint32_t less = a < b ? a : b;
  return static_cast<unsigned long long>(less) << 32 | (a ^ b ^ less);
}

}  // namespace rg::gpu
