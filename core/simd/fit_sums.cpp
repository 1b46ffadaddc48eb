// SPDX-License-Identifier: LGPL-2.1-or-later
// sumFit for every instruction set: a row of a cell, or half of it, at a time in 32 bits.
#include "core/fit_sums.hpp"

#include <algorithm>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/simd/fit_sums.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace rg::simd::HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR

FitSums sumCell(const MatchedCell& cell, ImageView<const uint8_t> luma, const PaddedLuma& previous,
                Point d, int limit) {
  return sumFitPlainly(cell, luma, previous, d, limit);
}

#else
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr hn::CappedTag<int32_t, kCellSize> kInts;
constexpr hn::Rebind<uint8_t, decltype(kInts)> kBytes;
using Ints = hn::Vec<decltype(kInts)>;

Ints load(const uint8_t* from) {
  return hn::PromoteTo(kInts, hn::LoadU(kBytes, from));
}

Ints everywhere(int value) {
  return hn::Set(kInts, value);
}

struct Sums {
  Ints seen, misfit, pixels, x, y, r, xx, xy, yy, xr, yr, rr;
};

/// Where two rows of the previous picture are looked at, in 1/256 grey levels.
struct Weights {
  Ints left, right, upper, lower, limit;
};

Ints sample(const uint8_t* upper, const uint8_t* lower, const Weights& weights) {
  const auto across = [&](const uint8_t* row) {
    return hn::Add(hn::Mul(load(row), weights.left), hn::Mul(load(row + 1), weights.right));
  };
  return hn::ShiftRight<kFineBits>(
      hn::Add(hn::Mul(across(upper), weights.upper), hn::Mul(across(lower), weights.lower)));
}

struct Pixels {
  Ints gx, gy, residual;
  Ints counted;  ///< −1 or 0.
};

void add(const Pixels& pixels, const Weights& weights, Sums& sums) {
  const Ints size = hn::Abs(pixels.residual);
  const Ints misfits = hn::VecFromMask(kInts, hn::Gt(size, weights.limit));
  const Ints fits = hn::AndNot(misfits, pixels.counted);
  const Ints gx = hn::And(fits, pixels.gx), gy = hn::And(fits, pixels.gy);
  const Ints residual = hn::And(fits, pixels.residual);
  const Ints coarse = hn::ShiftRight<4>(residual);
  sums.seen = hn::Sub(sums.seen, pixels.counted);
  sums.misfit = hn::Add(sums.misfit, hn::And(pixels.counted, hn::Min(size, weights.limit)));
  sums.pixels = hn::Sub(sums.pixels, fits);
  sums.x = hn::Add(sums.x, gx);
  sums.y = hn::Add(sums.y, gy);
  sums.r = hn::Add(sums.r, residual);
  sums.xx = hn::Add(sums.xx, hn::Mul(gx, gx));
  sums.xy = hn::Add(sums.xy, hn::Mul(gx, gy));
  sums.yy = hn::Add(sums.yy, hn::Mul(gy, gy));
  sums.xr = hn::Add(sums.xr, hn::Mul(gx, residual));
  sums.yr = hn::Add(sums.yr, hn::Mul(gy, residual));
  sums.rr = hn::Add(sums.rr, hn::Mul(coarse, coarse));
}

int32_t total(Ints sum) {
  return hn::GetLane(hn::SumOfLanes(kInts, sum));
}

/// −1 for the columns first … last − 1 of a cell, as far as the vector that begins at `begin` goes.
Ints columns(int begin, int first, int last) {
  const Ints at = hn::Iota(kInts, begin);
  return hn::VecFromMask(kInts,
                         hn::And(hn::Gt(at, everywhere(first - 1)), hn::Lt(at, everywhere(last))));
}

FitSums sumCell(const MatchedCell& cell, ImageView<const uint8_t> luma, const PaddedLuma& previous,
                Point d, int limit) {
  const int fractionX = -d.x & (kFine - 1), fractionY = -d.y & (kFine - 1);
  const Weights weights{everywhere(kFine - fractionX), everywhere(fractionX),
                        everywhere(kFine - fractionY), everywhere(fractionY), everywhere(limit)};
  const int wholeX = -d.x >> kFineBits, wholeY = -d.y >> kFineBits;
  const Ints none = hn::Zero(kInts);
  Sums sums{none, none, none, none, none, none, none, none, none, none, none, none};
  const auto lanes = static_cast<int>(hn::Lanes(kInts));
  const int right = luma.width() - 1 - cell.x;
  for (int row = 0; row < kCellSize && cell.blocks >> (2 * row) != 0; ++row) {
    const int halves = cell.blocks >> (2 * row) & 3, y = cell.y + row;
    if (halves == 0 || y == 0 || y == luma.height() - 1) continue;
    const int first = (halves & 1) != 0 ? (cell.x == 0 ? 1 : 0) : kBlockWidth;
    const int last = std::min((halves & 2) != 0 ? kCellSize : kBlockWidth, right);
    const uint8_t* before = previous.along(cell.x + wholeX, y + wholeY);
    for (int begin = 0; begin < kCellSize; begin += lanes) {
      const uint8_t* here = luma.row(y) + cell.x + begin;
      const uint8_t* above = luma.row(y - 1) + cell.x + begin;
      const uint8_t* below = luma.row(y + 1) + cell.x + begin;
      const Ints expected = sample(before + begin, before + begin + previous.stride(), weights);
      add({hn::Sub(load(here + 1), load(here - 1)), hn::Sub(load(below), load(above)),
           hn::Sub(hn::ShiftLeft<kFineBits>(load(here)), expected), columns(begin, first, last)},
          weights, sums);
    }
  }
  return {total(sums.seen), total(sums.misfit), total(sums.pixels), total(sums.x),
          total(sums.y),    total(sums.r),      total(sums.xx),     total(sums.xy),
          total(sums.yy),   total(sums.xr),     total(sums.yr),     total(sums.rr)};
}

}  // namespace
#endif

}  // namespace rg::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace rg {
namespace simd {
namespace {
HWY_EXPORT(sumCell);
}  // namespace
}  // namespace simd

FitSums sumFit(const MatchedCell& cell, ImageView<const uint8_t> luma, const PaddedLuma& previous,
               Point d, int limit) {
  return HWY_DYNAMIC_DISPATCH(simd::sumCell)(cell, luma, previous, d, limit);
}

}  // namespace rg
#endif
