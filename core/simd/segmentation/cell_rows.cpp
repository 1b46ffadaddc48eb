// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/simd/segmentation/cell_rows.hpp"

#include "core/base/row_spans.hpp"

#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/simd/segmentation/cell_rows.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace rg::segmentation::simd::HWY_NAMESPACE {
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
    const auto rounded = sums[i] + by / 2;
    const auto mean = static_cast<float>(rounded) / static_cast<float>(by);
    to[i] = static_cast<uint8_t>(static_cast<int>(mean));
  }
}

uint8_t smaller(uint8_t a, uint8_t b) {
  return a < b ? a : b;
}

uint8_t larger(uint8_t a, uint8_t b) {
  return a > b ? a : b;
}

void widenRow(const uint8_t* HWY_RESTRICT from, int count, uint8_t* HWY_RESTRICT least,
              uint8_t* HWY_RESTRICT most) {
  for (int i = 0; i < count; ++i) {
    least[i] = smaller(least[i], from[i]);
    most[i] = larger(most[i], from[i]);
  }
}

void widenScopedRow(const uint8_t* HWY_RESTRICT from, const uint8_t* HWY_RESTRICT scope, int count,
                    uint8_t* HWY_RESTRICT least, uint8_t* HWY_RESTRICT most) {
  for (int i = 0; i < count; ++i) {
    const bool isIn = scope[i] >= kInScopeApart;
    least[i] = smaller(least[i], isIn ? from[i] : uint8_t{255});
    most[i] = larger(most[i], isIn ? from[i] : uint8_t{0});
  }
}

// Blocks are read before they are written: in place, yet of independent elements.
void widenPairs(int count, uint8_t* HWY_RESTRICT least, uint8_t* HWY_RESTRICT most) {
  constexpr int kBlock = 64;
  for (int x = 0; x < count; x += kBlock) {
    const int n = count - x < kBlock ? count - x : kBlock;
    uint8_t low[kBlock], high[kBlock];
    for (int i = 0; i < n; ++i) low[i] = smaller(least[2 * (x + i)], least[2 * (x + i) + 1]);
    for (int i = 0; i < n; ++i) high[i] = larger(most[2 * (x + i)], most[2 * (x + i) + 1]);
    std::memcpy(least + x, low, static_cast<size_t>(n));
    std::memcpy(most + x, high, static_cast<size_t>(n));
  }
}

void raiseRanges(const uint8_t* HWY_RESTRICT least, const uint8_t* HWY_RESTRICT most, int count,
                 uint8_t* HWY_RESTRICT ranges) {
  for (int i = 0; i < count; ++i)
    ranges[i] = larger(ranges[i], static_cast<uint8_t>(larger(most[i], least[i]) - least[i]));
}

constexpr int kMostPixels = 64;

template <int kSide>
void gather(const uint8_t* from, ptrdiff_t stride, int rows, uint8_t* HWY_RESTRICT to) {
  for (int y = 0; y < rows; ++y) std::memcpy(to + y * kSide, from + y * stride, kSide);
}

void gather(const CellColours& cell, uint8_t (&pixels)[3][kMostPixels]) {
  for (int c = 0; c < 3; ++c) {
    if (cell.side == 2) gather<2>(cell.pixels[c], cell.strides[c], cell.rows, pixels[c]);
    if (cell.side == 4) gather<4>(cell.pixels[c], cell.strides[c], cell.rows, pixels[c]);
    if (cell.side == 8) gather<8>(cell.pixels[c], cell.strides[c], cell.rows, pixels[c]);
  }
}

bool chooseColours(const CellColours& cell, uint8_t* HWY_RESTRICT choices) {
  namespace hn = hwy::HWY_NAMESPACE;
  const hn::CappedTag<uint8_t, 16> d;
  using V = hn::Vec<decltype(d)>;
  alignas(64) uint8_t pixels[3][kMostPixels] = {};
  gather(cell, pixels);
  const auto difference = [](V a, V b) {
    return hn::Or(hn::SaturatedSub(a, b), hn::SaturatedSub(b, a));
  };
  V any = hn::Zero(d);
  for (int i = 0; i < cell.side * cell.side; i += static_cast<int>(hn::Lanes(d))) {
    const V red = hn::Load(d, pixels[0] + i), green = hn::Load(d, pixels[1] + i);
    const V blue = hn::Load(d, pixels[2] + i);
    V least = hn::Zero(d), choice = hn::Zero(d);
    for (int k = 0; k < cell.count; ++k) {
      const uint8_t* colour = cell.candidates[k];
      const V distance =
          hn::SaturatedAdd(hn::SaturatedAdd(difference(red, hn::Set(d, colour[0])),
                                            difference(green, hn::Set(d, colour[1]))),
                           hn::SaturatedAdd(difference(blue, hn::Set(d, colour[2])),
                                            hn::Set(d, k == 0 ? uint8_t{0} : cell.margin)));
      if (k == 0) least = distance;
      choice = hn::IfThenElse(hn::Lt(distance, least), hn::Set(d, static_cast<uint8_t>(k)), choice);
      least = hn::Min(distance, least);
    }
    any = hn::Or(any, choice);
    hn::StoreU(choice, d, choices + i);
  }
  return !hn::AllTrue(d, hn::Eq(any, hn::Zero(d)));
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
}  // namespace rg::segmentation::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace rg::segmentation::simd {
namespace {
HWY_EXPORT(addRow);
HWY_EXPORT(addScopedRow);
HWY_EXPORT(countRow);
HWY_EXPORT(addPairs);
HWY_EXPORT(splitCounts);
HWY_EXPORT(divideRow);
HWY_EXPORT(widenRow);
HWY_EXPORT(widenScopedRow);
HWY_EXPORT(widenPairs);
HWY_EXPORT(raiseRanges);
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

void widenRow(const uint8_t* from, int count, uint8_t* least, uint8_t* most) {
  HWY_DYNAMIC_DISPATCH(widenRow)(from, count, least, most);
}

void widenScopedRow(const uint8_t* from, const uint8_t* scope, int count, uint8_t* least,
                    uint8_t* most) {
  HWY_DYNAMIC_DISPATCH(widenScopedRow)(from, scope, count, least, most);
}

void widenPairs(int count, uint8_t* least, uint8_t* most) {
  HWY_DYNAMIC_DISPATCH(widenPairs)(count, least, most);
}

void raiseRanges(const uint8_t* least, const uint8_t* most, int count, uint8_t* ranges) {
  HWY_DYNAMIC_DISPATCH(raiseRanges)(least, most, count, ranges);
}

bool chooseColours(const CellColours& cell, uint8_t* choices) {
  return HWY_DYNAMIC_DISPATCH(chooseColours)(cell, choices);
}

void packEqual(const uint16_t* a, const uint16_t* b, int count, uint64_t* words) {
  HWY_DYNAMIC_DISPATCH(packEqual)(a, b, count, words);
}

uint32_t sumRow(const uint8_t* from, int count) {
  return HWY_DYNAMIC_DISPATCH(sumRow)(from, count);
}

}  // namespace rg::segmentation::simd
#endif
