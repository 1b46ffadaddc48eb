// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/simd/base/mean_rows.hpp"

#include "core/simd/base/conversion.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/simd/base/mean_rows.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace rg::simd::HWY_NAMESPACE {
namespace {

void addRow(const uint8_t* HWY_RESTRICT bytes, int count, uint16_t* HWY_RESTRICT sums) {
  for (int i = 0; i < count; ++i) sums[i] = static_cast<uint16_t>(sums[i] + bytes[i]);
}

void addRowOfTen(const uint8_t* HWY_RESTRICT bytes, int count, uint16_t* HWY_RESTRICT sums) {
  for (int i = 0; i < count; ++i)
    sums[i] = static_cast<uint16_t>(sums[i] + upperOfTen(bytes[2 * i] | bytes[2 * i + 1] << 8));
}

}  // namespace
}  // namespace rg::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace rg::simd {
namespace {
HWY_EXPORT(addRow);
HWY_EXPORT(addRowOfTen);
}  // namespace

void addRow(const uint8_t* bytes, int count, uint16_t* sums) {
  HWY_DYNAMIC_DISPATCH(addRow)(bytes, count, sums);
}

void addRowOfTen(const uint8_t* bytes, int count, uint16_t* sums) {
  HWY_DYNAMIC_DISPATCH(addRowOfTen)(bytes, count, sums);
}

}  // namespace rg::simd
#endif
