// SPDX-License-Identifier: LGPL-2.1-or-later
// Arithmetic of times in nanoseconds. Streams may say any time at all, so that sums and differences
// stop at the ends of the range instead of leaving it.
#pragma once

#include <cstdint>

namespace rg {

/// How far apart frames are taken to be whose times say nothing.
inline constexpr int64_t kNominalStepNs = 40'000'000;

/// a + b, or the end of the range that it lies beyond.
[[nodiscard]] constexpr int64_t addTimes(int64_t a, int64_t b) {
  int64_t sum = 0;
  if (!__builtin_add_overflow(a, b, &sum)) return sum;
  return b > 0 ? INT64_MAX : INT64_MIN;
}
static_assert(addTimes(2, 3) == 5 && addTimes(INT64_MAX, 1) == INT64_MAX &&
              addTimes(INT64_MIN, -1) == INT64_MIN);

/// later - earlier, or the end of the range that it lies beyond.
[[nodiscard]] constexpr int64_t timeBetween(int64_t earlier, int64_t later) {
  int64_t difference = 0;
  if (!__builtin_sub_overflow(later, earlier, &difference)) return difference;
  return later > earlier ? INT64_MAX : INT64_MIN;
}
static_assert(timeBetween(2, 5) == 3 && timeBetween(INT64_MIN, 1) == INT64_MAX &&
              timeBetween(INT64_MAX, -2) == INT64_MIN);

}  // namespace rg
