// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/simd/base/run_rows.hpp"

#include "core/simd/base/targets.hpp"

#include <bit>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/simd/base/run_rows.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace rg::simd::HWY_NAMESPACE {
namespace {

void compareRest(const uint16_t* a, const uint16_t* b, int first, int count, uint64_t* words) {
  for (int i = first; i < count; ++i) {
    uint64_t& word = words[i / 64];
    if (i % 64 == 0) word = 0;
    word |= uint64_t{a[i] == b[i]} << (i % 64);
  }
}

uint32_t sumPlainly(const uint8_t* from, int count) {
  uint32_t sum = 0;
  for (int i = 0; i < count; ++i) sum += from[i];
  return sum;
}

#if HWY_TARGET == HWY_SCALAR

int findRuns(const uint16_t* labels, int count, uint16_t* begins) {
  int runs = 0;
  begins[runs++] = 0;
  for (int i = 1; i < count; ++i)
    if (labels[i] != labels[i - 1]) begins[runs++] = static_cast<uint16_t>(i);
  begins[runs] = static_cast<uint16_t>(count);
  return runs;
}

uint32_t sumOf(const uint8_t* from, int count, int) {
  return sumPlainly(from, count);
}

void compareLabels(const uint16_t* a, const uint16_t* b, int count, uint64_t* words) {
  compareRest(a, b, 0, count, words);
}

#else

namespace hn = hwy::HWY_NAMESPACE;

int findRuns(const uint16_t* labels, int count, uint16_t* begins) {
  constexpr hn::CappedTag<uint16_t, 32> d;
  const auto lanes = static_cast<int>(hn::Lanes(d));
  int runs = 0, i = 1;
  begins[runs++] = 0;
  for (; i + lanes <= count; i += lanes) {
    uint8_t bytes[8] = {};  // As many as StoreMaskBits may write.
    hn::StoreMaskBits(d, hn::Ne(hn::LoadU(d, labels + i), hn::LoadU(d, labels + i - 1)), bytes);
    uint32_t bits = 0;
    std::memcpy(&bits, bytes, sizeof bits);
    for (; bits != 0; bits &= bits - 1)
      begins[runs++] = static_cast<uint16_t>(i + std::countr_zero(bits));
  }
  for (; i < count; ++i)
    if (labels[i] != labels[i - 1]) begins[runs++] = static_cast<uint16_t>(i);
  begins[runs] = static_cast<uint16_t>(count);
  return runs;
}

void compareLabels(const uint16_t* a, const uint16_t* b, int count, uint64_t* words) {
  constexpr hn::CappedTag<uint16_t, 32> d;
  const auto lanes = static_cast<int>(hn::Lanes(d));
  int i = 0;
  for (; i + 64 <= count; i += 64) {
    uint8_t bytes[16] = {};  // More than the last StoreMaskBits may write.
    for (int k = 0; k < 64; k += lanes)
      hn::StoreMaskBits(d, hn::Eq(hn::LoadU(d, a + i + k), hn::LoadU(d, b + i + k)), bytes + k / 8);
    std::memcpy(words + i / 64, bytes, sizeof *words);
  }
  compareRest(a, b, i, count, words);
}

/// `readable`: so many bytes may be read, `count` of them are summed.
uint32_t sumOf(const uint8_t* from, int count, int readable) {
  constexpr int kFew = 8;
  if (count <= kFew) return sumPlainly(from, count);
  constexpr hn::CappedTag<uint8_t, 64> d;
  constexpr hn::Repartition<uint64_t, decltype(d)> d64;
  const auto lanes = static_cast<int>(hn::Lanes(d));
  auto sum = hn::Zero(d64);
  int i = 0;
  for (; i + lanes <= count; i += lanes) sum = hn::Add(sum, hn::SumsOf8(hn::LoadU(d, from + i)));
  const auto rest = static_cast<size_t>(count - i);
#if HWY_TARGET <= HWY_AVX3
  (void)readable;
  sum = hn::Add(sum, hn::SumsOf8(hn::MaskedLoad(hn::FirstN(d, rest), d, from + i)));
  return static_cast<uint32_t>(hn::GetLane(hn::SumOfLanes(d64, sum)));
#else
  uint32_t plain = 0;
  if (i + lanes <= readable)
    sum =
        hn::Add(sum, hn::SumsOf8(hn::IfThenElseZero(hn::FirstN(d, rest), hn::LoadU(d, from + i))));
  else
    plain = sumPlainly(from + i, count - i);
  return static_cast<uint32_t>(hn::GetLane(hn::SumOfLanes(d64, sum))) + plain;
#endif
}

#endif

void sumRuns(const ChannelRows& from, const uint16_t* begins, int runs, ChannelSums* to) {
  for (int i = 0; i < runs; ++i) {
    const int begin = begins[i], count = begins[i + 1] - begin, readable = begins[runs] - begin;
    for (int c = 0; c < 3; ++c) to[i].sums[c] = sumOf(from.rows[c] + begin, count, readable);
  }
}

}  // namespace
}  // namespace rg::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace rg::simd {
namespace {
HWY_EXPORT(compareLabels);
HWY_EXPORT(findRuns);
HWY_EXPORT(sumRuns);
}  // namespace

int findRuns(const uint16_t* labels, int count, uint16_t* begins) {
  return HWY_DYNAMIC_DISPATCH(findRuns)(labels, count, begins);
}

void compareLabels(const uint16_t* a, const uint16_t* b, int count, uint64_t* words) {
  HWY_DYNAMIC_DISPATCH(compareLabels)(a, b, count, words);
}

void sumRuns(const ChannelRows& from, const uint16_t* begins, int runs, ChannelSums* to) {
  HWY_DYNAMIC_DISPATCH(sumRuns)(from, begins, runs, to);
}

}  // namespace rg::simd
#endif
