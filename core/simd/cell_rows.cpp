// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/simd/cell_rows.hpp"

#include "core/row_spans.hpp"

#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/simd/cell_rows.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace rg::simd::HWY_NAMESPACE {
namespace {

void addRow(const uint8_t* HWY_RESTRICT from, int count, uint16_t* HWY_RESTRICT sums) {
  for (int i = 0; i < count; ++i) sums[i] = static_cast<uint16_t>(sums[i] + from[i]);
}

void addScopedRow(const uint8_t* HWY_RESTRICT from, const uint8_t* HWY_RESTRICT scope, int count,
                  uint16_t* HWY_RESTRICT sums) {
  for (int i = 0; i < count; ++i) {
    const uint8_t counted = scope[i] >= kInScopeApart ? from[i] : uint8_t{0};
    sums[i] = static_cast<uint16_t>(sums[i] + counted);
  }
}

void countRow(const uint8_t* HWY_RESTRICT scope, int count, uint16_t* HWY_RESTRICT sums) {
  for (int i = 0; i < count; ++i) {
    const uint16_t own = scope[i];
    const auto one = static_cast<uint16_t>(own == kInScope ? 257 : 256);
    sums[i] = static_cast<uint16_t>(sums[i] + (own >= kInScopeApart ? one : uint16_t{0}));
  }
}

void addPairs(const uint16_t* HWY_RESTRICT from, int count, uint16_t* HWY_RESTRICT to) {
  for (int i = 0; i < count; ++i) to[i] = static_cast<uint16_t>(from[2 * i] + from[2 * i + 1]);
}

void splitCounts(const uint16_t* HWY_RESTRICT sums, int count, uint8_t* HWY_RESTRICT counts,
                 uint8_t* HWY_RESTRICT scope) {
  for (int i = 0; i < count; ++i) {
    counts[i] = static_cast<uint8_t>(sums[i] >> 8);
    const uint8_t value = (sums[i] & 255) != 0 ? kInScope : kInScopeApart;
    scope[i] = sums[i] != 0 ? value : uint8_t{0};
  }
}

// Exact in floating point: a quotient below 2^8 by at most 64 is no nearer than 2^-6 to the next
// integer unless it is one.
void divideRow(const uint16_t* HWY_RESTRICT sums, const uint8_t* HWY_RESTRICT counts, int count,
               uint8_t* HWY_RESTRICT to) {
  for (int i = 0; i < count; ++i) {
    const int by = counts[i] > 1 ? counts[i] : 1;
    const auto mean = static_cast<float>(sums[i] + by / 2) / static_cast<float>(by);
    to[i] = static_cast<uint8_t>(static_cast<int>(mean));
  }
}

uint16_t difference(uint8_t a, uint8_t b) {
  return static_cast<uint16_t>(a > b ? a - b : b - a);
}

void chooseColours(const NearestColours& cell, uint16_t* HWY_RESTRICT to) {
  uint16_t least[kMostPixels];
  const int pixels = cell.pixels;
  for (int i = 0; i < pixels; ++i) least[i] = 0xFFFF;
  for (int k = 0; k < cell.count; ++k) {
    const uint8_t red = cell.candidates[0][k], green = cell.candidates[1][k];
    const uint8_t blue = cell.candidates[2][k];
    const uint16_t id = cell.ids[k];
    const uint16_t extra = k == 0 ? uint16_t{0} : cell.margin;
    for (int i = 0; i < pixels; ++i) {
      const auto distance = static_cast<uint16_t>(difference(cell.colours[0][i], red) +
                                                  difference(cell.colours[1][i], green) +
                                                  difference(cell.colours[2][i], blue) + extra);
      const bool isNearer = distance < least[i];
      least[i] = isNearer ? distance : least[i];
      to[i] = isNearer ? id : to[i];
    }
  }
}

void packSlowly(const uint16_t* a, const uint16_t* b, int count, uint64_t* words) {
  for (int x = 0; x < count; x += 64) {
    uint64_t word = 0;
    const int bits = count - x < 64 ? count - x : 64;
    for (int i = 0; i < bits; ++i) word |= uint64_t{a[x + i] == b[x + i]} << i;
    *words++ = word;
  }
}

void packEqual(const uint16_t* a, const uint16_t* b, int count, uint64_t* words) {
  int x = 0;
#if HWY_TARGET != HWY_SCALAR
  namespace hn = hwy::HWY_NAMESPACE;
  const hn::CappedTag<uint16_t, 32> d;
  const auto lanes = static_cast<int>(hn::Lanes(d));
  for (; x + 64 <= count; x += 64) {
    uint8_t bits[16];  // StoreMaskBits may write eight bytes at a time.
    for (int i = 0; i < 64; i += lanes)
      hn::StoreMaskBits(d, hn::Eq(hn::LoadU(d, a + x + i), hn::LoadU(d, b + x + i)), bits + i / 8);
    std::memcpy(words++, bits, sizeof *words);
  }
#endif
  packSlowly(a + x, b + x, count - x, words);
}

uint32_t sumRow(const uint8_t* from, int count) {
  uint32_t sum = 0;
  int x = 0;
#if HWY_TARGET != HWY_SCALAR
  namespace hn = hwy::HWY_NAMESPACE;
  const hn::CappedTag<uint8_t, 64> d;
  const hn::Repartition<uint64_t, decltype(d)> d64;
  const auto lanes = static_cast<int>(hn::Lanes(d));
  auto sums = hn::Zero(d64);
  for (; x + lanes <= count; x += lanes) sums = hn::Add(sums, hn::SumsOf8(hn::LoadU(d, from + x)));
  sum = static_cast<uint32_t>(hn::GetLane(hn::SumOfLanes(d64, sums)));
#endif
  for (; x < count; ++x) sum += from[x];
  return sum;
}

}  // namespace
}  // namespace rg::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace rg::simd {
namespace {
HWY_EXPORT(addRow);
HWY_EXPORT(addScopedRow);
HWY_EXPORT(countRow);
HWY_EXPORT(addPairs);
HWY_EXPORT(splitCounts);
HWY_EXPORT(divideRow);
HWY_EXPORT(chooseColours);
HWY_EXPORT(packEqual);
HWY_EXPORT(sumRow);
}  // namespace

void addRow(const uint8_t* from, int count, uint16_t* sums) {
  HWY_DYNAMIC_DISPATCH(addRow)(from, count, sums);
}

void addScopedRow(const uint8_t* from, const uint8_t* scope, int count, uint16_t* sums) {
  HWY_DYNAMIC_DISPATCH(addScopedRow)(from, scope, count, sums);
}

void countRow(const uint8_t* scope, int count, uint16_t* sums) {
  HWY_DYNAMIC_DISPATCH(countRow)(scope, count, sums);
}

void addPairs(const uint16_t* from, int count, uint16_t* to) {
  HWY_DYNAMIC_DISPATCH(addPairs)(from, count, to);
}

void splitCounts(const uint16_t* sums, int count, uint8_t* counts, uint8_t* scope) {
  HWY_DYNAMIC_DISPATCH(splitCounts)(sums, count, counts, scope);
}

void divideRow(const uint16_t* sums, const uint8_t* counts, int count, uint8_t* to) {
  HWY_DYNAMIC_DISPATCH(divideRow)(sums, counts, count, to);
}

void chooseColours(const NearestColours& cell, uint16_t* to) {
  HWY_DYNAMIC_DISPATCH(chooseColours)(cell, to);
}

void packEqual(const uint16_t* a, const uint16_t* b, int count, uint64_t* words) {
  HWY_DYNAMIC_DISPATCH(packEqual)(a, b, count, words);
}

uint32_t sumRow(const uint8_t* from, int count) {
  return HWY_DYNAMIC_DISPATCH(sumRow)(from, count);
}

}  // namespace rg::simd
#endif
