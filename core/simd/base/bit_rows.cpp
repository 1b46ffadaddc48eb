// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/simd/base/bit_rows.hpp"

#include "core/simd/base/targets.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/simd/base/bit_rows.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace rg::HWY_NAMESPACE {
#if HWY_TARGET == HWY_SCALAR
using plain::countBits;
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

uint32_t countBits(const uint64_t* words, int count) {
  const hn::CappedTag<uint64_t, 8> d;
  const auto lanes = static_cast<int>(hn::Lanes(d));
  auto sum = hn::Zero(d);
  int i = 0;
  for (; i + lanes <= count; i += lanes)
    sum = hn::Add(sum, hn::PopulationCount(hn::LoadU(d, words + i)));
  return static_cast<uint32_t>(hn::GetLane(hn::SumOfLanes(d, sum))) +
         plain::countBits(words + i, count - i);
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

uint32_t plain::countBits(const uint64_t* words, int count) {
  uint32_t bits = 0;
  for (int i = 0; i < count; ++i) bits += static_cast<uint32_t>(std::popcount(words[i]));
  return bits;
}

namespace {
HWY_EXPORT(packEqualRow);
HWY_EXPORT(countBits);
}  // namespace

void simd::packEqualRow(const uint8_t* bytes, int width, uint8_t value, uint64_t* words) {
  HWY_DYNAMIC_DISPATCH(packEqualRow)(bytes, width, value, words);
}

uint32_t simd::countBits(const uint64_t* words, int count) {
  return HWY_DYNAMIC_DISPATCH(countBits)(words, count);
}

}  // namespace rg
#endif
