// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/simd/background/majority_rows.hpp"

#include "core/simd/base/targets.hpp"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/simd/background/majority_rows.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace rg::background::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Words = hn::CappedTag<uint64_t, 8>;
using V = hn::Vec<Words>;
constexpr Words kWords;

void countAlongRow(const uint64_t* row, size_t words, int radius, uint64_t* counts) {
  for (size_t word = 0; word < words; word += hn::Lanes(kWords)) {
    const V before = hn::LoadU(kWords, row + word - 1), here = hn::LoadU(kWords, row + word);
    const V after = hn::LoadU(kWords, row + word + 1);
    V sum[kCountDigits] = {here, hn::Zero(kWords), hn::Zero(kWords), hn::Zero(kWords)};
    const auto add = [&](V carry) {
      for (V& digit : sum) {
        const V both = hn::And(digit, carry);
        digit = hn::Xor(digit, carry);
        carry = both;
      }
    };
    for (int i = 1; i <= radius; ++i) {
      add(hn::Or(hn::ShiftLeftSame(here, i), hn::ShiftRightSame(before, 64 - i)));
      add(hn::Or(hn::ShiftRightSame(here, i), hn::ShiftLeftSame(after, 64 - i)));
    }
    for (size_t i = 0; i < kCountDigits; ++i) hn::StoreU(sum[i], kWords, counts + i * words + word);
  }
}

V isAbove(const V (&sum)[kSumDigits], int limit) {
  V above = hn::Zero(kWords), equal = hn::Not(above);
  for (size_t i = kSumDigits; i-- > 0;) {
    if ((limit >> i & 1) != 0) {
      equal = hn::And(equal, sum[i]);
    } else {
      above = hn::Or(above, hn::And(equal, sum[i]));
      equal = hn::AndNot(sum[i], equal);
    }
  }
  return above;
}

void compareSums(std::span<const uint64_t* const> counts, size_t words, int limit, uint64_t* out) {
  for (size_t word = 0; word < words; word += hn::Lanes(kWords)) {
    const V zero = hn::Zero(kWords);
    V sum[kSumDigits] = {zero, zero, zero, zero, zero, zero, zero, zero};
    for (const uint64_t* row : counts) {
      V carry = zero;
      for (size_t i = 0; i < kCountDigits; ++i) {
        const V digit = hn::LoadU(kWords, row + i * words + word);
        const V half = hn::Xor(sum[i], digit);
        const V next = hn::Or(hn::And(sum[i], digit), hn::And(half, carry));
        sum[i] = hn::Xor(half, carry);
        carry = next;
      }
      for (size_t i = kCountDigits; i < kSumDigits; ++i) {
        const V next = hn::And(sum[i], carry);
        sum[i] = hn::Xor(sum[i], carry);
        carry = next;
      }
    }
    hn::StoreU(isAbove(sum, limit), kWords, out + word);
  }
}

}  // namespace
}  // namespace rg::background::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace rg::background {
namespace {

HWY_EXPORT(countAlongRow);
HWY_EXPORT(compareSums);

/// The number that the digits of a column make.
int numberAt(const uint64_t* counts, size_t words, size_t x) {
  int number = 0;
  for (size_t i = 0; i < kCountDigits; ++i)
    number |= static_cast<int>(counts[i * words + x / 64] >> x % 64 & 1) << i;
  return number;
}

}  // namespace

void plain::countAlongRow(const uint64_t* row, size_t words, int radius, uint64_t* counts) {
  std::fill_n(counts, kCountDigits * words, uint64_t{0});
  for (size_t x = 0; x < 64 * words; ++x) {
    uint64_t count = 0;
    for (int i = -radius; i <= radius; ++i) {
      const auto bit = static_cast<ptrdiff_t>(x) + i + 64;  // Of the word before the row.
      count += row[bit / 64 - 1] >> bit % 64 & 1;
    }
    for (size_t i = 0; i < kCountDigits; ++i)
      counts[i * words + x / 64] |= (count >> i & 1) << x % 64;
  }
}

void plain::compareSums(std::span<const uint64_t* const> counts, size_t words, int limit,
                        uint64_t* out) {
  std::fill_n(out, words, uint64_t{0});
  for (size_t x = 0; x < 64 * words; ++x) {
    int sum = 0;
    for (const uint64_t* row : counts) sum += numberAt(row, words, x);
    out[x / 64] |= uint64_t{sum > limit} << x % 64;
  }
}

void simd::countAlongRow(const uint64_t* row, size_t words, int radius, uint64_t* counts) {
  HWY_DYNAMIC_DISPATCH(countAlongRow)(row, words, radius, counts);
}

void simd::compareSums(std::span<const uint64_t* const> counts, size_t words, int limit,
                       uint64_t* out) {
  HWY_DYNAMIC_DISPATCH(compareSums)(counts, words, limit, out);
}

}  // namespace rg::background
#endif
