// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/simd/background/consensus_rows.hpp"

#include "core/background/models/consensus_turns.hpp"
#include "core/base/pixel.hpp"
#include "core/simd/base/targets.hpp"

#include <algorithm>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/simd/background/consensus_rows.cpp"
#include <hwy/cache_control.h>
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace rg::background::HWY_NAMESPACE {
#if HWY_TARGET == HWY_SCALAR
using plain::followNoiseRow;
using plain::judgeRow;
using plain::meanOfFour;
using plain::smoothRow;
#else
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Bytes = hn::CappedTag<uint8_t, 64>;
using Words = hn::Repartition<uint16_t, Bytes>;
using V = hn::Vec<Bytes>;
constexpr Bytes kBytes;
constexpr Words kWords;

/// Sums of 16 bits over the bytes with even and with odd column.
struct Halves {
  hn::Vec<Words> even, odd;
};

Halves split(V bytes) {
  const auto words = hn::BitCast(kWords, bytes);
  return {hn::And(words, hn::Set(kWords, 0xFF)), hn::ShiftRight<8>(words)};
}

Halves add(const Halves& a, const Halves& b) {
  return {hn::Add(a.even, b.even), hn::Add(a.odd, b.odd)};
}

Halves twice(const Halves& a) {
  return {hn::ShiftLeft<1>(a.even), hn::ShiftLeft<1>(a.odd)};
}

/// a / 2^shift; the results must be below 256.
template <int shift>
V join(const Halves& a) {
  const auto even = hn::ShiftRight<shift>(a.even);
  const auto odd = hn::ShiftLeft<8>(hn::ShiftRight<shift>(a.odd));
  return hn::BitCast(kBytes, hn::Or(even, odd));
}

Halves sumDown(const RowsAround& in, ptrdiff_t x) {
  const Halves outer =
      add(split(hn::LoadU(kBytes, in.above + x)), split(hn::LoadU(kBytes, in.below + x)));
  return add(outer, twice(split(hn::LoadU(kBytes, in.here + x))));
}

/// What lies to the left of one column lies to the right of the one before the last.
void smoothVector(const RowsAround& in, int x, uint8_t* out) {
  const Halves half{hn::Set(kWords, 8), hn::Set(kWords, 8)};
  const Halves left = sumDown(in, x - 1), right = sumDown(in, x + 1);
  const Halves here{left.odd, right.even};
  const Halves sides{hn::Add(left.even, right.even), hn::Add(left.odd, right.odd)};
  hn::StoreU(join<4>(add(add(sides, half), twice(here))), kBytes, out + x);
}

void smoothRow(const RowsAround& in, uint8_t* out) {
  const auto lanes = static_cast<int>(hn::Lanes(kBytes));
  const int last = in.width - 1;
  if (lanes + 2 > in.width) return plain::smoothRow(in, out);
  plain::smoothColumns(in, 0, 1, out);
  plain::smoothColumns(in, last, in.width, out);
  int x = 1;
  for (; x + lanes <= last; x += lanes) smoothVector(in, x, out);
  if (x < last) smoothVector(in, last - lanes, out);  // Again what the vector before ended with.
}

/// The samples of the columns from x on.
const uint8_t* samplesAt(const ModelRow& row, int x) {
  return row.samples + x / 64 * (64 * row.sampleCount * row.channels) + x % 64;
}

template <int channels>
V distance(const std::array<V, 3>& pixels, const uint8_t* samples) {
  V most = hn::Zero(kBytes);
  for (size_t c = 0; c < channels; ++c) {
    const V there = hn::LoadU(kBytes, samples + 64 * c);
    most = hn::Max(most,
                   hn::Or(hn::SaturatedSub(pixels[c], there), hn::SaturatedSub(there, pixels[c])));
  }
  return most;
}

std::array<V, 3> loadPixels(const ModelRow& row, int x) {
  const V first = hn::LoadU(kBytes, row.pixels[0] + x);
  if (row.channels == 1) return {first, first, first};
  return {first, hn::LoadU(kBytes, row.pixels[1] + x), hn::LoadU(kBytes, row.pixels[2] + x)};
}

V radiusOf(V brightness, const RadiusRow& radius, int x) {
  const Halves levels = split(brightness);
  const auto share = hn::Set(kWords, radius.brightness);
  const V added = join<8>({hn::Mul(levels.even, share), hn::Mul(levels.odd, share)});
  V sum = hn::SaturatedAdd(hn::Set(kBytes, radius.least), added);
  sum = hn::SaturatedAdd(sum, hn::ShiftRight<2>(hn::LoadU(kBytes, radius.noise + x)));
  return hn::SaturatedAdd(sum, hn::ShiftRight<4>(hn::LoadU(kBytes, radius.unrest + x)));
}

/// Distance to the second nearest sample. Stops as soon as no pixel can turn to background by
/// another sample.
template <int channels>
V secondDistance(const ModelRow& row, V radius, int x) {
  const std::array<V, 3> pixels = loadPixels(row, x);
  const uint8_t* samples = samplesAt(row, x);
  V nearest = distance<channels>(pixels, samples), second = hn::Set(kBytes, 255);
  for (int sample = 1; sample < row.sampleCount; ++sample) {
    const V d = distance<channels>(pixels, samples + 64 * channels * sample);
    second = hn::Min(second, hn::Max(nearest, d));
    nearest = hn::Min(nearest, d);
    if (hn::AllTrue(kBytes, hn::Eq(hn::Max(second, radius), radius))) break;
  }
  return second;
}

/// The first samples of a word some words on; behind the row's end these are of the next row.
void prefetch(const ModelRow& row, int x) {
  constexpr int kAhead = 2, kSamplesAhead = 3;
  const ptrdiff_t word = ptrdiff_t{64} * row.sampleCount * row.channels;
  const uint8_t* from = row.samples + (x / 64 + kAhead) * word;
  for (int i = 0; i < kSamplesAhead * row.channels; ++i) hwy::Prefetch(from + ptrdiff_t{64} * i);
}

template <int channels>
void judgeWords(const ModelRow& row, const RadiusRow& radius, const VerdictRow& out) {
  const size_t lanes = hn::Lanes(kBytes);
  for (int begin = 0; begin < row.width; begin += 64) {
    prefetch(row, begin);
    uint8_t raw[16], strong[16], faint[16];  // StoreMaskBits may write eight bytes.
    for (size_t i = 0; i < 64; i += lanes) {
      const int x = begin + static_cast<int>(i);
      const V reach = radiusOf(hn::LoadU(kBytes, row.pixels[0] + x), radius, x);
      const V half = hn::ShiftRight<1>(reach);
      const V wide =
          hn::Min(hn::SaturatedAdd(hn::SaturatedAdd(reach, reach), half), hn::Set(kBytes, 254));
      const V eighth = hn::ShiftRight<3>(hn::SaturatedAdd(reach, hn::Set(kBytes, 7)));
      const V inner = hn::Sub(reach, eighth);
      const V second = secondDistance<channels>(row, inner, x);
      const auto isRaw = hn::Ne(hn::Max(second, reach), reach);
      const auto isFar = hn::Ne(hn::Max(second, wide), wide);
      hn::StoreMaskBits(kBytes, isRaw, raw + i / 8);
      hn::StoreMaskBits(kBytes, hn::Ne(hn::Max(second, inner), inner), faint + i / 8);
      hn::StoreMaskBits(kBytes, hn::And(isRaw, isFar), strong + i / 8);
    }
    std::memcpy(out.raw + begin / 64, raw, 8);
    std::memcpy(out.strong + begin / 64, strong, 8);
    std::memcpy(out.faint + begin / 64, faint, 8);
  }
  plain::clearBeyond(row.width, out);
}

void judgeRow(const ModelRow& row, const RadiusRow& radius, const VerdictRow& out) {
  row.channels == 1 ? judgeWords<1>(row, radius, out) : judgeWords<3>(row, radius, out);
}

/// a / 4, rounded up.
V quarter(V a) {
  const auto rest = hn::Min(hn::And(a, hn::Set(kBytes, 3)), hn::Set(kBytes, 1));
  return hn::Add(hn::ShiftRight<2>(a), rest);
}

template <int channels>
void followNoiseWords(const ModelRow& row, const NoiseRow& out) {
  const auto lanes = static_cast<int>(hn::Lanes(kBytes));
  for (int x = 0; x < row.width; x += lanes) {
    const std::array<V, 3> pixels = loadPixels(row, x);
    const uint8_t* samples = samplesAt(row, x);
    V near = hn::Set(kBytes, 31);
    for (int sample = 0; sample < row.sampleCount; ++sample)
      near = hn::Min(near, distance<channels>(pixels, samples + 64 * channels * sample));
    const V seen = hn::ShiftLeft<3>(near), before = hn::LoadU(kBytes, out.noise + x);
    const V less = hn::Sub(before, quarter(hn::SaturatedSub(before, seen)));
    const V after = hn::Add(less, quarter(hn::SaturatedSub(seen, before)));
    const auto kept = hn::LoadMaskBits(kBytes, reinterpret_cast<const uint8_t*>(out.kept) + x / 8);
    hn::StoreU(hn::IfThenElse(kept, before, after), kBytes, out.noise + x);
  }
}

void followNoiseRow(const ModelRow& row, const NoiseRow& out) {
  row.channels == 1 ? followNoiseWords<1>(row, out) : followNoiseWords<3>(row, out);
}

void meanOfFour(const uint8_t* first, ptrdiff_t step, uint8_t* out) {
  for (size_t i = 0; i < 64; i += hn::Lanes(kBytes)) {
    Halves sum = split(hn::LoadU(kBytes, first + i));
    for (int k = 1; k < 4; ++k) sum = add(sum, split(hn::LoadU(kBytes, first + k * step + i)));
    hn::StoreU(join<2>(sum), kBytes, out + i);
  }
}

}  // namespace
#endif
}  // namespace rg::background::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace rg::background {

void plain::smoothColumns(const RowsAround& in, int begin, int end, uint8_t* out) {
  const auto sum = [&](int x) {
    x = std::clamp(x, 0, in.width - 1);
    return in.above[x] + 2 * in.here[x] + in.below[x];
  };
  for (int x = begin; x < end; ++x)
    out[x] = static_cast<uint8_t>(roundShift(sum(x - 1) + 2 * sum(x) + sum(x + 1), 4));
}

void plain::smoothRow(const RowsAround& in, uint8_t* out) {
  smoothColumns(in, 0, in.width, out);
}

void plain::clearBeyond(int width, const VerdictRow& out) {
  if (width % 64 == 0) return;
  const uint64_t columns = (uint64_t{1} << width % 64) - 1;
  out.raw[width / 64] &= columns;
  out.strong[width / 64] &= columns;
  out.faint[width / 64] &= columns;
}

namespace {

/// Largest difference of a channel.
int distanceAt(const ModelRow& row, int sample, int x) {
  int most = 0;
  for (int c = 0; c < row.channels; ++c) {
    const int block = (x / 64 * row.sampleCount + sample) * row.channels + c;
    const uint8_t there = row.samples[ptrdiff_t{64} * block + x % 64];
    most = std::max(most, absDiff(row.pixels[static_cast<size_t>(c)][x], there));
  }
  return most;
}

HWY_EXPORT(smoothRow);
HWY_EXPORT(judgeRow);
HWY_EXPORT(followNoiseRow);
HWY_EXPORT(meanOfFour);

}  // namespace

void plain::judgeRow(const ModelRow& row, const RadiusRow& radius, const VerdictRow& out) {
  for (int word = 0; word * 64 < row.width; ++word)
    out.raw[word] = out.strong[word] = out.faint[word] = 0;
  for (int x = 0; x < row.width; ++x) {
    const int reach = radiusAt(radius, row.pixels[0][x], x);
    int nearest = 255, second = 255;
    for (int sample = 0; sample < row.sampleCount; ++sample) {
      const int d = distanceAt(row, sample, x);
      second = std::min(second, std::max(nearest, d));
      nearest = std::min(nearest, d);
    }
    const bool isRaw = second > reach, isFar = second > farRadius(reach);
    out.raw[x / 64] |= uint64_t{isRaw} << x % 64;
    out.strong[x / 64] |= uint64_t{isRaw && isFar} << x % 64;
    out.faint[x / 64] |= uint64_t{second > faintRadius(reach)} << x % 64;
  }
}

void plain::followNoiseRow(const ModelRow& row, const NoiseRow& out) {
  for (int x = 0; x < row.width; ++x) {
    if ((out.kept[x / 64] >> x % 64 & 1) != 0) continue;
    int nearest = 31;
    for (int sample = 0; sample < row.sampleCount; ++sample)
      nearest = std::min(nearest, distanceAt(row, sample, x));
    out.noise[x] = followedNoise(out.noise[x], nearest);
  }
}

void plain::meanOfFour(const uint8_t* first, ptrdiff_t step, uint8_t* out) {
  for (int x = 0; x < 64; ++x)
    out[x] = static_cast<uint8_t>(
        (first[x] + first[x + step] + first[x + 2 * step] + first[x + 3 * step]) / 4);
}

void simd::smoothRow(const RowsAround& in, uint8_t* out) {
  HWY_DYNAMIC_DISPATCH(smoothRow)(in, out);
}

void simd::judgeRow(const ModelRow& row, const RadiusRow& radius, const VerdictRow& out) {
  HWY_DYNAMIC_DISPATCH(judgeRow)(row, radius, out);
}

void simd::followNoiseRow(const ModelRow& row, const NoiseRow& noise) {
  HWY_DYNAMIC_DISPATCH(followNoiseRow)(row, noise);
}

void simd::meanOfFour(const uint8_t* first, ptrdiff_t step, uint8_t* out) {
  HWY_DYNAMIC_DISPATCH(meanOfFour)(first, step, out);
}

}  // namespace rg::background
#endif
