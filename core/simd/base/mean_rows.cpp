// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/simd/base/mean_rows.hpp"

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

}  // namespace
}  // namespace rg::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace rg::simd {
namespace {
HWY_EXPORT(addRow);
}  // namespace

void addRow(const uint8_t* bytes, int count, uint16_t* sums) {
  HWY_DYNAMIC_DISPATCH(addRow)(bytes, count, sums);
}

}  // namespace rg::simd
#endif
