// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/simd/base/picture_rows.hpp"

#include "core/simd/base/targets.hpp"

#include <algorithm>
#include <cstddef>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/simd/base/picture_rows.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace rg::HWY_NAMESPACE {
#if HWY_TARGET == HWY_SCALAR
using plain::gatherRow;
using plain::loadPackedRow;
using plain::loadPlanarRow;
namespace {
int loadYuvVectors(const YuvRows&, int, const YuvToRgb&, const ColourRows&) {
  return 0;
}
}  // namespace
#else
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Bytes = hn::CappedTag<uint8_t, 64>;
using Words = hn::Repartition<int16_t, Bytes>;
using HalfWords = hn::Half<Words>;
using Longs = hn::Repartition<int32_t, Words>;
using V = hn::Vec<Bytes>;
constexpr Bytes kBytes;
constexpr Words kWords;
constexpr HalfWords kHalfWords;
constexpr Longs kLongs;

constexpr hn::Repartition<uint16_t, Bytes> kUnsigned;

auto lumaOf(hn::Vec<decltype(kUnsigned)> red, hn::Vec<decltype(kUnsigned)> green,
            hn::Vec<decltype(kUnsigned)> blue) {
  const auto sum =
      hn::Add(hn::Mul(red, hn::Set(kUnsigned, 77)), hn::Mul(green, hn::Set(kUnsigned, 150)));
  const auto rest = hn::Add(hn::Mul(blue, hn::Set(kUnsigned, 29)), hn::Set(kUnsigned, 128));
  return hn::ShiftRight<8>(hn::Add(sum, rest));
}

V lumaOf(V red, V green, V blue) {
  const auto low = hn::Set(kUnsigned, 0xFF);
  const auto words = [](V v) { return hn::BitCast(kUnsigned, v); };
  const auto even =
      lumaOf(hn::And(words(red), low), hn::And(words(green), low), hn::And(words(blue), low));
  const auto odd = lumaOf(hn::ShiftRight<8>(words(red)), hn::ShiftRight<8>(words(green)),
                          hn::ShiftRight<8>(words(blue)));
  return hn::BitCast(kBytes, hn::Or(even, hn::ShiftLeft<8>(odd)));
}

ColourRows after(const ColourRows& rows, int x) {
  return {rows.red + x, rows.green + x, rows.blue + x, rows.luma + x};
}

void storePacked(V red, V green, V blue, const ColourRows& to) {
  hn::StoreU(red, kBytes, to.red);
  hn::StoreU(green, kBytes, to.green);
  hn::StoreU(blue, kBytes, to.blue);
  hn::StoreU(lumaOf(red, green, blue), kBytes, to.luma);
}

void loadPlanarRow(const uint8_t* red, const uint8_t* green, const uint8_t* blue, int width,
                   const ColourRows& to) {
  const auto lanes = static_cast<int>(hn::Lanes(kBytes));
  int x = 0;
  for (; x + lanes <= width; x += lanes)
    storePacked(hn::LoadU(kBytes, red + x), hn::LoadU(kBytes, green + x),
                hn::LoadU(kBytes, blue + x), after(to, x));
  plain::loadPlanarRow(red + x, green + x, blue + x, width - x, after(to, x));
}

/// As many samples as a vector has bytes, of which one more sample must follow.
V gather(const SpacedRow& from, int x) {
  const uint8_t* at = from.first + ptrdiff_t{x} * from.stepBytes;
  V low, high, third, fourth;
  if (from.stepBytes == 4) {
    hn::LoadInterleaved4(kBytes, at, low, high, third, fourth);
    return low;
  }
  hn::LoadInterleaved2(kBytes, at, low, high);
  if (!from.hasTenBits) return low;
  return hn::Or(hn::ShiftRight<2>(low), hn::ShiftLeft<6>(high));
}

void gatherRow(const SpacedRow& from, int count, uint8_t* to) {
  const auto lanes = static_cast<int>(hn::Lanes(kBytes));
  int x = 0;
  for (; x + lanes < count; x += lanes) hn::StoreU(gather(from, x), kBytes, to + x);
  const SpacedRow rest{from.first + ptrdiff_t{x} * from.stepBytes, from.stepBytes, from.hasTenBits};
  plain::gatherRow(rest, count - x, to + x);
}

void loadPackedRow(const uint8_t* from, int width, const PackedOrder& order, const ColourRows& to) {
  const auto lanes = static_cast<int>(hn::Lanes(kBytes));
  const bool isRedFirst = order.red == 0;
  int x = 0;
  for (; x + lanes <= width; x += lanes) {
    V first, green, third, rest;
    if (order.bytesPerPixel == 3)
      hn::LoadInterleaved3(kBytes, from + 3 * x, first, green, third);
    else
      hn::LoadInterleaved4(kBytes, from + 4 * x, first, green, third, rest);
    storePacked(isRedFirst ? first : third, green, isRedFirst ? third : first, after(to, x));
  }
  plain::loadPackedRow(from + order.bytesPerPixel * x, width - x, order, after(to, x));
}

/// Sums of 32 bits for the lower and the upper half of a vector of 16 bits.
struct Sums {
  hn::Vec<Longs> lower, upper;
};

Sums multiply(hn::Vec<Words> a, int factor) {
  const auto by = hn::Set(kLongs, factor);
  return {hn::Mul(hn::PromoteTo(kLongs, hn::LowerHalf(kHalfWords, a)), by),
          hn::Mul(hn::PromoteTo(kLongs, hn::UpperHalf(kHalfWords, a)), by)};
}

Sums add(const Sums& a, const Sums& b) {
  return {hn::Add(a.lower, b.lower), hn::Add(a.upper, b.upper)};
}

/// From Q14 to 0 … 255.
hn::Vec<Words> level(const Sums& sums) {
  const auto half = hn::Set(kLongs, 1 << 13);
  const auto lower = hn::DemoteTo(kHalfWords, hn::ShiftRight<14>(hn::Add(sums.lower, half)));
  const auto upper = hn::DemoteTo(kHalfWords, hn::ShiftRight<14>(hn::Add(sums.upper, half)));
  const auto both = hn::Combine(kWords, upper, lower);
  return hn::Min(hn::Max(both, hn::Zero(kWords)), hn::Set(kWords, 255));
}

/// What chroma adds to the columns of a pair, and the luma of both.
struct Pairs {
  Sums even, odd;
};

void storeColour(const Pairs& luma, const Sums& chroma, uint8_t* out) {
  const auto even = level(add(luma.even, chroma)), odd = level(add(luma.odd, chroma));
  hn::StoreU(hn::BitCast(kBytes, hn::Or(even, hn::ShiftLeft<8>(odd))), kBytes, out);
}

/// The even or odd bytes as numbers of 16 bits, less `offset`.
template <bool odd>
hn::Vec<Words> numbers(V bytes, int offset) {
  const auto words = hn::BitCast(kUnsigned, bytes);
  const auto chosen = odd ? hn::ShiftRight<8>(words) : hn::And(words, hn::Set(kUnsigned, 0xFF));
  return hn::Sub(hn::BitCast(kWords, chosen), hn::Set(kWords, static_cast<int16_t>(offset)));
}

struct Chroma {
  hn::Vec<Words> cb, cr;
};

Chroma loadChroma(const YuvRows& from, int x) {
  if (from.chromaStep == 2) {
    const V both = hn::LoadU(kBytes, from.cb + x);
    return {numbers<false>(both, 128), numbers<true>(both, 128)};
  }
  const hn::Half<Bytes> half;
  const auto numbersOf = [&](const uint8_t* samples) {
    const auto wide = hn::PromoteTo(kWords, hn::LoadU(half, samples + x / 2));
    return hn::Sub(wide, hn::Set(kWords, 128));
  };
  return {numbersOf(from.cb), numbersOf(from.cr)};
}

/// Returns how many columns fill vectors: the others are for plain::loadYuvRow(). It is not called
/// here, as gcc 12 would leave the vectors' upper halves in use then (tests/vector_state.py).
int loadYuvVectors(const YuvRows& from, int width, const YuvToRgb& k, const ColourRows& to) {
  const auto lanes = static_cast<int>(hn::Lanes(kBytes));
  int x = 0;
  for (; x + lanes <= width; x += lanes) {
    const V stored = hn::LoadU(kBytes, from.luma + x);
    const Pairs luma{multiply(numbers<false>(stored, k.offset), k.luma),
                     multiply(numbers<true>(stored, k.offset), k.luma)};
    const Chroma chroma = loadChroma(from, x);
    const Sums green = add(multiply(chroma.cb, -k.greenByCb), multiply(chroma.cr, -k.greenByCr));
    storeColour(luma, multiply(chroma.cr, k.redByCr), to.red + x);
    storeColour(luma, green, to.green + x);
    storeColour(luma, multiply(chroma.cb, k.blueByCb), to.blue + x);
    hn::StoreU(stored, kBytes, to.luma + x);
  }
  return x;
}

}  // namespace
#endif
}  // namespace rg::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace rg {
namespace {

HWY_EXPORT(gatherRow);
HWY_EXPORT(loadPackedRow);
HWY_EXPORT(loadPlanarRow);
HWY_EXPORT(loadYuvVectors);

}  // namespace

void plain::gatherRow(const SpacedRow& from, int count, uint8_t* to) {
  const uint8_t* at = from.first;
  for (int x = 0; x < count; ++x, at += from.stepBytes)
    to[x] = from.hasTenBits ? upperOfTen(at[0] | at[1] << 8) : at[0];
}

void plain::loadPlanarRow(const uint8_t* red, const uint8_t* green, const uint8_t* blue, int width,
                          const ColourRows& to) {
  std::copy_n(red, width, to.red);
  std::copy_n(green, width, to.green);
  std::copy_n(blue, width, to.blue);
  for (int x = 0; x < width; ++x) to.luma[x] = lumaOf(red[x], green[x], blue[x]);
}

void plain::loadPackedRow(const uint8_t* from, int width, const PackedOrder& order,
                          const ColourRows& to) {
  for (int x = 0; x < width; ++x, from += order.bytesPerPixel) {
    const int red = from[order.red], green = from[order.green], blue = from[order.blue];
    to.red[x] = static_cast<uint8_t>(red);
    to.green[x] = static_cast<uint8_t>(green);
    to.blue[x] = static_cast<uint8_t>(blue);
    to.luma[x] = lumaOf(red, green, blue);
  }
}

void plain::loadYuvRow(const YuvRows& from, int width, const YuvToRgb& k, const ColourRows& to) {
  for (int x = 0; x < width; ++x) {
    const ptrdiff_t chroma = ptrdiff_t{x >> 1} * from.chromaStep;
    const Rgb colour = rgbOf(from.luma[x], from.cb[chroma], from.cr[chroma], k);
    to.red[x] = colour.red;
    to.green[x] = colour.green;
    to.blue[x] = colour.blue;
    to.luma[x] = from.luma[x];
  }
}

void simd::gatherRow(const SpacedRow& from, int count, uint8_t* to) {
  HWY_DYNAMIC_DISPATCH(gatherRow)(from, count, to);
}

void simd::loadPlanarRow(const uint8_t* red, const uint8_t* green, const uint8_t* blue, int width,
                         const ColourRows& to) {
  HWY_DYNAMIC_DISPATCH(loadPlanarRow)(red, green, blue, width, to);
}

void simd::loadPackedRow(const uint8_t* from, int width, const PackedOrder& order,
                         const ColourRows& to) {
  HWY_DYNAMIC_DISPATCH(loadPackedRow)(from, width, order, to);
}

void simd::loadYuvRow(const YuvRows& from, int width, const YuvToRgb& k, const ColourRows& to) {
  const int done = HWY_DYNAMIC_DISPATCH(loadYuvVectors)(from, width, k, to);
  const int chromaAt = done / 2 * from.chromaStep;
  plain::loadYuvRow({from.luma + done, from.cb + chromaAt, from.cr + chromaAt, from.chromaStep},
                    width - done, k,
                    {to.red + done, to.green + done, to.blue + done, to.luma + done});
}

}  // namespace rg
#endif
