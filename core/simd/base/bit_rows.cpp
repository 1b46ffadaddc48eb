// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/simd/base/bit_rows.hpp"

#include "core/simd/base/targets.hpp"

#include <algorithm>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/simd/base/bit_rows.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace rg::HWY_NAMESPACE {
#if HWY_TARGET == HWY_SCALAR
using plain::packEqualRow;
#else
namespace {

namespace hn = hwy::HWY_NAMESPACE;

uint64_t packWord(const uint8_t* bytes, uint8_t value) {
  const hn::CappedTag<uint8_t, 64> d;
  const size_t lanes = hn::Lanes(d);
  const auto wanted = hn::Set(d, value);
  uint8_t bits[16];  // StoreMaskBits may write eight bytes.
  for (size_t i = 0; i < 64; i += lanes)
    hn::StoreMaskBits(d, hn::Eq(hn::LoadU(d, bytes + i), wanted), bits + i / 8);
  uint64_t word = 0;
  std::memcpy(&word, bits, sizeof word);
  return word;
}

void packEqualRow(const uint8_t* bytes, int width, uint8_t value, uint64_t* words) {
  int x = 0;
  for (; x + 64 <= width; x += 64) *words++ = packWord(bytes + x, value);
  plain::packEqualRow(bytes + x, width - x, value, words);
}

}  // namespace
#endif
}  // namespace rg::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace rg {

void plain::packEqualRow(const uint8_t* bytes, int width, uint8_t value, uint64_t* words) {
  for (int x = 0; x < width; x += 64) {
    uint64_t word = 0;
    for (int i = 0; i < std::min(64, width - x); ++i) word |= uint64_t{bytes[x + i] == value} << i;
    *words++ = word;
  }
}

namespace {
HWY_EXPORT(packEqualRow);
}  // namespace

void simd::packEqualRow(const uint8_t* bytes, int width, uint8_t value, uint64_t* words) {
  HWY_DYNAMIC_DISPATCH(packEqualRow)(bytes, width, value, words);
}

}  // namespace rg
#endif
