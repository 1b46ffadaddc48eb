// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/simd/background/difference_rows.hpp"

#include "core/base/pixel.hpp"
#include "core/simd/base/targets.hpp"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/simd/background/difference_rows.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace rg::background::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// Calls step(d, x) for vectors that cover 0 … count − 1: wide ones, then narrower ones for what is
/// left, down to single bytes.
template <class Step>
void forVectors(int count, const Step& step) {
  int x = 0;
  const auto cover = [&](auto d) {
    const auto lanes = static_cast<int>(hn::Lanes(d));
    for (; x + lanes <= count; x += lanes) step(d, x);
  };
  cover(hn::CappedTag<uint8_t, 64>());
  cover(hn::CappedTag<uint8_t, 16>());
  cover(hn::CappedTag<uint8_t, 8>());
  cover(hn::CappedTag<uint8_t, 1>());
}

template <class D>
hn::Vec<D> distanceOf(D d, const RowPair& pair, int x) {
  hn::Vec<D> most = hn::Zero(d);
  for (size_t c = 0; c < static_cast<size_t>(pair.channels); ++c) {
    const auto a = hn::LoadU(d, pair.a[c] + x), b = hn::LoadU(d, pair.b[c] + x);
    most = hn::Max(most, hn::Sub(hn::Max(a, b), hn::Min(a, b)));
  }
  return most;
}

template <class D>
hn::Vec<D> isAbove(D d, hn::Vec<D> value, uint8_t limit) {
  const auto most = hn::Set(d, limit);
  return hn::VecFromMask(d, hn::Ne(hn::Max(value, most), most));
}

void measureDistances(const RowPair& pair, uint8_t* out) {
  forVectors(pair.count, [&](auto d, int x) { hn::StoreU(distanceOf(d, pair, x), d, out + x); });
}

void markFar(const RowPair& pair, uint8_t limit, uint8_t* out) {
  forVectors(pair.count, [&](auto d, int x) {
    hn::StoreU(isAbove(d, distanceOf(d, pair, x), limit), d, out + x);
  });
}

void addFar(const RowPair& pair, uint8_t limit, const uint8_t* where, uint8_t* out) {
  forVectors(pair.count, [&](auto d, int x) {
    const auto far = hn::And(isAbove(d, distanceOf(d, pair, x), limit), hn::LoadU(d, where + x));
    hn::StoreU(hn::Or(far, hn::LoadU(d, out + x)), d, out + x);
  });
}

void keepDense(const BinaryRows& rows, int count, uint8_t* out) {
  forVectors(count, [&](auto d, int x) {
    auto sum = hn::Zero(d);  // Each set pixel takes one away.
    for (const uint8_t* row : {rows.above, rows.here, rows.below})
      for (int i = -1; i <= 1; ++i) sum = hn::Sub(sum, hn::LoadU(d, row + x + i));
    hn::StoreU(isAbove(d, sum, 3), d, out + x);
  });
}

}  // namespace
}  // namespace rg::background::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace rg::background {
namespace {

HWY_EXPORT(measureDistances);
HWY_EXPORT(markFar);
HWY_EXPORT(addFar);
HWY_EXPORT(keepDense);

int distanceAt(const RowPair& pair, int x) {
  int most = 0;
  for (size_t c = 0; c < static_cast<size_t>(pair.channels); ++c)
    most = std::max(most, absDiff(pair.a[c][x], pair.b[c][x]));
  return most;
}

constexpr uint8_t allBitsIf(bool isSet) {
  return static_cast<uint8_t>(isSet ? 255 : 0);
}

}  // namespace

void plain::measureDistances(const RowPair& pair, uint8_t* out) {
  for (int x = 0; x < pair.count; ++x) out[x] = static_cast<uint8_t>(distanceAt(pair, x));
}

void plain::markFar(const RowPair& pair, uint8_t limit, uint8_t* out) {
  for (int x = 0; x < pair.count; ++x) out[x] = allBitsIf(distanceAt(pair, x) > limit);
}

void plain::addFar(const RowPair& pair, uint8_t limit, const uint8_t* where, uint8_t* out) {
  for (int x = 0; x < pair.count; ++x)
    if (where[x] == 255 && distanceAt(pair, x) > limit) out[x] = 255;
}

void plain::keepDense(const BinaryRows& rows, int count, uint8_t* out) {
  for (int x = 0; x < count; ++x) {
    int set = 0;
    for (const uint8_t* row : {rows.above, rows.here, rows.below})
      for (int i = x - 1; i <= x + 1; ++i) set += row[i] & 1;
    out[x] = allBitsIf(set >= 4);
  }
}

void simd::measureDistances(const RowPair& pair, uint8_t* out) {
  HWY_DYNAMIC_DISPATCH(measureDistances)(pair, out);
}

void simd::markFar(const RowPair& pair, uint8_t limit, uint8_t* out) {
  HWY_DYNAMIC_DISPATCH(markFar)(pair, limit, out);
}

void simd::addFar(const RowPair& pair, uint8_t limit, const uint8_t* where, uint8_t* out) {
  HWY_DYNAMIC_DISPATCH(addFar)(pair, limit, where, out);
}

void simd::keepDense(const BinaryRows& rows, int count, uint8_t* out) {
  HWY_DYNAMIC_DISPATCH(keepDense)(rows, count, out);
}

}  // namespace rg::background
#endif
