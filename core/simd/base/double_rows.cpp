// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/simd/base/double_rows.hpp"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/simd/base/double_rows.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace rg::simd::HWY_NAMESPACE {
namespace {

constexpr int kMiddle = 128;  // Of a byte.

constexpr int tapped(int here, int next, int behind, int afterNext) {
  return QuarterTaps::kHere * here + QuarterTaps::kNext * next + QuarterTaps::kBehind * behind +
         QuarterTaps::kAfterNext * afterNext;
}

constexpr uint8_t byteOf(int sum) {
  constexpr int kUnit = QuarterTaps::kUnit * QuarterTaps::kUnit;
  const int level = ((sum + kUnit / 2) >> 14) + kMiddle;
  static_assert(kUnit == 1 << 14);
  return static_cast<uint8_t>(std::min(std::max(level, 0), 255));
}

void sumQuarter(const QuarterRows& rows, int count, int16_t* HWY_RESTRICT sums) {
  const uint8_t* HWY_RESTRICT here = rows.here;
  const uint8_t* HWY_RESTRICT next = rows.next;
  const uint8_t* HWY_RESTRICT behind = rows.behind;
  const uint8_t* HWY_RESTRICT afterNext = rows.afterNext;
  for (int i = 0; i < count; ++i)
    sums[i] = static_cast<int16_t>(
        tapped(here[i] - kMiddle, next[i] - kMiddle, behind[i] - kMiddle, afterNext[i] - kMiddle));
}

void doubleSums(const int16_t* HWY_RESTRICT sums, int count, uint8_t* HWY_RESTRICT to) {
  for (int i = 0; i < count; ++i) {
    const int16_t* at = sums + i;
    to[2 * i] = byteOf(tapped(at[0], at[-1], at[1], at[-2]));
    to[2 * i + 1] = byteOf(tapped(at[0], at[1], at[-1], at[2]));
  }
}

}  // namespace
}  // namespace rg::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace rg::simd {
namespace {
HWY_EXPORT(sumQuarter);
HWY_EXPORT(doubleSums);
}  // namespace

void sumQuarter(const QuarterRows& rows, int count, int16_t* sums) {
  HWY_DYNAMIC_DISPATCH(sumQuarter)(rows, count, sums);
}

void doubleSums(const int16_t* sums, int count, uint8_t* to) {
  HWY_DYNAMIC_DISPATCH(doubleSums)(sums, count, to);
}

}  // namespace rg::simd
#endif
