// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/simd/base/motion_rows.hpp"

#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/simd/base/motion_rows.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace rg::simd::HWY_NAMESPACE {
namespace {

uint8_t smoothed(const ThreeRows& rows, int left, int at, int right) {
  const auto across = [&](const uint8_t* row) {
    return binomialMean(row[left], row[at], row[right]);
  };
  return static_cast<uint8_t>(
      binomialMean(across(rows.above), across(rows.at), across(rows.below)));
}

void smoothRow(const ThreeRows& rows, int count, uint8_t* HWY_RESTRICT to) {
  const int last = count - 1;
  to[0] = smoothed(rows, 0, 0, count > 1 ? 1 : 0);
  if (last > 0) to[last] = smoothed(rows, last - 1, last, last);
  for (int i = 1; i < last; ++i) to[i] = smoothed(rows, i - 1, i, i + 1);
}

// 255 · 16 · 16 + 128 < 2^16.
void warpRow(const WarpRow& row, int count, uint8_t* HWY_RESTRICT to) {
  const uint8_t *HWY_RESTRICT upper = row.upper, *HWY_RESTRICT lower = row.lower;
  const auto right = static_cast<uint16_t>(row.right), left = static_cast<uint16_t>(16 - row.right);
  const auto low = static_cast<uint16_t>(row.low), high = static_cast<uint16_t>(16 - row.low);
  for (int i = 0; i < count; ++i) {
    const auto above = static_cast<uint16_t>(upper[i] * left + upper[i + 1] * right);
    const auto below = static_cast<uint16_t>(lower[i] * left + lower[i + 1] * right);
    const auto sum = static_cast<uint16_t>(above * high + below * low + 128);
    to[i] = static_cast<uint8_t>(sum >> 8);
  }
}

void warpSpan(const WarpSpan& span, uint8_t* HWY_RESTRICT to) {
  constexpr int kUnitBits = 4, kPlaceBits = 8, kUnit = 1 << kUnitBits;
  constexpr int kHalf = 1 << (kPlaceBits - kUnitBits - 1), kRest = (1 << kPlaceBits) - 1;
  int columns[kWarpSpan], rows[kWarpSpan];
  uint16_t right[kWarpSpan], low[kWarpSpan];
  for (int i = 0; i < kWarpSpan; ++i) {
    const int x = span.x + span.acrossX * i / kWarpSpan + kHalf;
    const int y = span.y + span.acrossY * i / kWarpSpan + kHalf;
    columns[i] = x >> kPlaceBits;
    rows[i] = y >> kPlaceBits;
    right[i] = static_cast<uint16_t>((x & kRest) >> (kPlaceBits - kUnitBits));
    low[i] = static_cast<uint16_t>((y & kRest) >> (kPlaceBits - kUnitBits));
  }
  uint8_t upper[2 * kWarpSpan], lower[2 * kWarpSpan];
  for (int i = 0; i < kWarpSpan; ++i) {
    const uint8_t* at = span.pixels + rows[i] * span.stride + columns[i];
    std::memcpy(upper + 2 * i, at, 2);
    std::memcpy(lower + 2 * i, at + span.stride, 2);
  }
  for (int i = 0; i < kWarpSpan; ++i) {
    const auto left = static_cast<uint16_t>(kUnit - right[i]);
    const auto above = static_cast<uint16_t>(upper[2 * i] * left + upper[2 * i + 1] * right[i]);
    const auto below = static_cast<uint16_t>(lower[2 * i] * left + lower[2 * i + 1] * right[i]);
    const auto sum = static_cast<uint16_t>(above * (kUnit - low[i]) + below * low[i] + 128);
    to[i] = static_cast<uint8_t>(sum >> 8);
  }
}

// First down, then across, where no sum is overwritten that is still needed.
void sumBoxRow(const BoxRows& from, int count, uint16_t* HWY_RESTRICT to) {
  const uint8_t *HWY_RESTRICT a = from.rows[0], *HWY_RESTRICT b = from.rows[1],
                              *HWY_RESTRICT c = from.rows[2], *HWY_RESTRICT d = from.rows[3];
  const int columns = count + 3;
  for (int i = 0; i < columns; ++i) to[i] = static_cast<uint16_t>(a[i] + b[i] + c[i] + d[i]);
  for (int i = 0; i < count; ++i)
    to[i] = static_cast<uint16_t>(to[i] + to[i + 1] + to[i + 2] + to[i + 3]);
}

uint8_t difference(uint8_t a, uint8_t b, uint8_t most) {
  const auto d = static_cast<uint8_t>(a > b ? a - b : b - a);
  return d < most ? d : most;
}

DifferenceSums sumDifferences(const ComparedRows& rows, int count, uint8_t most) {
  const uint8_t *HWY_RESTRICT now = rows.now, *HWY_RESTRICT still = rows.still,
                              *HWY_RESTRICT moved = rows.moved;
  DifferenceSums sums;
  for (int i = 0; i < count; ++i) {
    sums.still += difference(now[i], still[i], most);
    sums.moved += difference(now[i], moved[i], most);
  }
  return sums;
}

bool isAnySet(const uint16_t* values, int count) {
  uint16_t all = 0;
  for (int i = 0; i < count; ++i) all = static_cast<uint16_t>(all | values[i]);
  return all != 0;
}

void raiseRow(uint16_t* values, int count, uint16_t to) {
  for (int i = 0; i < count; ++i) values[i] = values[i] > to ? values[i] : to;
}

}  // namespace
}  // namespace rg::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace rg::simd {
namespace {
HWY_EXPORT(smoothRow);
HWY_EXPORT(warpRow);
HWY_EXPORT(warpSpan);
HWY_EXPORT(sumBoxRow);
HWY_EXPORT(sumDifferences);
HWY_EXPORT(isAnySet);
HWY_EXPORT(raiseRow);

/// What is shorter (the runs of a frame of noise) is done before a target is looked up.
constexpr int kShort = 16;
}  // namespace

void smoothRow(const ThreeRows& rows, int count, uint8_t* to) {
  HWY_DYNAMIC_DISPATCH(smoothRow)(rows, count, to);
}

void warpRow(const WarpRow& row, int count, uint8_t* to) {
  HWY_DYNAMIC_DISPATCH(warpRow)(row, count, to);
}

void warpSpan(const WarpSpan& span, uint8_t* to) {
  HWY_DYNAMIC_DISPATCH(warpSpan)(span, to);
}

void sumBoxRow(const BoxRows& from, int count, uint16_t* to) {
  HWY_DYNAMIC_DISPATCH(sumBoxRow)(from, count, to);
}

DifferenceSums sumDifferences(const ComparedRows& rows, int count, uint8_t most) {
  if (count < kShort) return HWY_STATIC_DISPATCH(sumDifferences)(rows, count, most);
  return HWY_DYNAMIC_DISPATCH(sumDifferences)(rows, count, most);
}

bool isAnySet(const uint16_t* values, int count) {
  if (count < kShort) return HWY_STATIC_DISPATCH(isAnySet)(values, count);
  return HWY_DYNAMIC_DISPATCH(isAnySet)(values, count);
}

void raiseRow(uint16_t* values, int count, uint16_t to) {
  if (count < kShort) return HWY_STATIC_DISPATCH(raiseRow)(values, count, to);
  HWY_DYNAMIC_DISPATCH(raiseRow)(values, count, to);
}

}  // namespace rg::simd
#endif
