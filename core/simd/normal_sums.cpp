// SPDX-License-Identifier: LGPL-2.1-or-later
// sumNormals for every instruction set: eight pixels at a time, a row of a part.
#include "core/normal_sums.hpp"

#include <algorithm>
#include <bit>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/simd/normal_sums.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace rg::simd::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET != HWY_SCALAR

using D8 = hn::Simd<uint8_t, 8, 0>;
using D16 = hn::Full128<int16_t>;
using D32 = hn::Full128<int32_t>;
using Words = hn::Vec<D16>;
static_assert(kPartWidth == 8);

Words load(const uint8_t* from) {
  return hn::PromoteTo(D16(), hn::LoadU(D8(), from));
}

/// Two sums, of even and odd pairs. Of a part's 32 rows at most: 32 · 2 · 255 · 32767 < 2^31.
struct Sum {
  hn::Vec<D32> even, odd;

  void add(Words a, Words b) { even = hn::ReorderWidenMulAccumulate(D32(), a, b, even, odd); }
  [[nodiscard]] int64_t total() const {
    return hn::GetLane(hn::SumOfLanes(D32(), hn::Add(even, odd)));
  }
};

struct Weights {
  Words fractionX, fractionY, limit;
  ptrdiff_t before;  ///< From a pixel's place in the padded picture to what it is compared with.
};

/// Where two rows of the previous picture are looked at.
Words sample(const uint8_t* upper, ptrdiff_t stride, const Weights& weights) {
  const auto across = [&](const uint8_t* row) {
    const Words first = load(row);
    return hn::Add(hn::ShiftLeft<kFineBits>(first),
                   hn::Mul(hn::Sub(load(row + 1), first), weights.fractionX));
  };
  const Words top = across(upper), bottom = across(upper + stride);
  return hn::Add(top, hn::MulFixedPoint15(hn::Sub(bottom, top), weights.fractionY));
}

/// For each pixel of a row of a part −1 if it counts.
Words countedPixels(const MatchedPart& part, int row, int width) {
  const auto pair = static_cast<int>(part.blocks >> (2 * row) & 3);
  const Words lane = hn::Iota(D16(), int16_t{0});
  const int first = (pair & 1) != 0 ? (part.column == 0 ? 1 : 0) : kBlockWidth;
  const int last = std::min((pair & 2) != 0 ? kPartWidth : kBlockWidth, width - 1 - part.x());
  const auto isIn = hn::And(hn::Gt(lane, hn::Set(D16(), static_cast<int16_t>(first - 1))),
                            hn::Lt(lane, hn::Set(D16(), static_cast<int16_t>(last))));
  return hn::VecFromMask(D16(), isIn);
}

void addPart(const MatchedPart& part, ImageView<const uint8_t> luma, const PaddedLuma& previous,
             const Weights& weights, NormalSums& sums) {
  const Sum none{hn::Zero(D32()), hn::Zero(D32())};
  Sum xx = none, xy = none, yy = none, xr = none, yr = none;
  Words negativeCount = hn::Zero(D16());
  for (int row = std::countr_zero(part.blocks) / 2;
       row < kPartHeight && part.blocks >> (2 * row) != 0; ++row) {
    const int x = part.x(), y = part.y() + row;
    if ((part.blocks >> (2 * row) & 3) == 0 || y == 0 || y == luma.height() - 1) continue;
    const uint8_t* here = luma.row(y) + x;
    const Words before = sample(previous.along(x, y) + weights.before, previous.stride(), weights);
    const Words residual = hn::Sub(hn::ShiftLeft<kFineBits>(load(here)), before);
    const Words misfits = hn::VecFromMask(D16(), hn::Gt(hn::Abs(residual), weights.limit));
    const Words counts = hn::AndNot(misfits, countedPixels(part, row, luma.width()));
    const Words gx = hn::And(counts, hn::Sub(load(here + 1), load(here - 1)));
    const Words gy = hn::And(counts, hn::Sub(load(luma.row(y + 1) + x), load(luma.row(y - 1) + x)));
    xx.add(gx, gx);
    xy.add(gx, gy);
    yy.add(gy, gy);
    xr.add(gx, residual);
    yr.add(gy, residual);
    negativeCount = hn::Add(negativeCount, counts);
  }
  sums.xx += xx.total();
  sums.xy += xy.total();
  sums.yy += yy.total();
  sums.xr += xr.total();
  sums.yr += yr.total();
  Sum count = none;
  count.add(negativeCount, hn::Set(D16(), int16_t{-1}));
  sums.pixels += count.total();
}

NormalSums sumAll(std::span<const MatchedPart> parts, ImageView<const uint8_t> luma,
                  const PaddedLuma& previous, Point d, int limit) {
  const detail::FinePlace place(d);
  const auto everywhere = [](int value) { return hn::Set(D16(), static_cast<int16_t>(value)); };
  const Weights weights{
      everywhere(place.fractionX), everywhere(place.fractionY << (15 - kFineBits)),
      everywhere(std::min(limit, kNoLimit)), place.whole.y * previous.stride() + place.whole.x};
  NormalSums sums;
  for (const MatchedPart& part : parts) addPart(part, luma, previous, weights, sums);
  return sums;
}

#else

NormalSums sumAll(std::span<const MatchedPart> parts, ImageView<const uint8_t> luma,
                  const PaddedLuma& previous, Point d, int limit) {
  return sumNormalsPlainly(parts, luma, previous, d, limit);
}

#endif

}  // namespace rg::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace rg {
namespace simd {
HWY_EXPORT(sumAll);
}  // namespace simd

NormalSums sumNormals(std::span<const MatchedPart> parts, ImageView<const uint8_t> luma,
                      const PaddedLuma& previous, Point d, int limit) {
  return HWY_DYNAMIC_DISPATCH(simd::sumAll)(parts, luma, previous, d, limit);
}

}  // namespace rg
#endif
