// SPDX-License-Identifier: LGPL-2.1-or-later
// The sums of least squares for every instruction set: one or two rows of a cell at a time in 16
// bits, of which pairs of products are added in 32.
#include "core/motion/fit_moments.hpp"
#include "core/simd/base/targets.hpp"

#include <algorithm>
#include <bit>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/simd/motion/fit_sums.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#ifndef REGIONGRAPH_SIMD_FIT_SUMS_ONCE
#define REGIONGRAPH_SIMD_FIT_SUMS_ONCE
namespace rg::motion::simd {

/// Rows of pixels; row −1 is a stride before.
struct Rows {
  const uint8_t* at = nullptr;
  ptrdiff_t stride = 0;
  [[nodiscard]] const uint8_t* row(int y) const { return at + y * stride; }
};

/// A cell's pixels with one more on each side, and one more row and column of the previous
/// picture. Where they don't lie inside the picture, its border is repeated in a copy.
struct CellWindow {
  static constexpr int kSide = kCellSize + 2;
  static constexpr int kStride = 16;
  uint8_t current[kSide * kStride];
  uint8_t previous[kSide * kStride];
};

inline bool isInner(const MatchedCell& cell, Size size) {
  return cell.x > 0 && cell.y > 0 && cell.x + kCellSize < size.width &&
         cell.y + kCellSize < size.height;
}

inline Rows copyCurrent(const MatchedCell& cell, ImageView<const uint8_t> luma,
                        CellWindow& window) {
  for (int y = 0; y < CellWindow::kSide; ++y)
    for (int x = 0; x < CellWindow::kSide; ++x)
      window.current[y * CellWindow::kStride + x] =
          luma.at(std::clamp(cell.x + x - 1, 0, luma.width() - 1),
                  std::clamp(cell.y + y - 1, 0, luma.height() - 1));
  return {window.current + CellWindow::kStride + 1, CellWindow::kStride};
}

inline Rows copyPrevious(const MatchedCell& cell, int height, const PaddedLuma& previous,
                         Point whole, CellWindow& window) {
  for (int y = 0; y <= kCellSize; ++y)
    std::memcpy(window.previous + y * CellWindow::kStride,
                previous.along(cell.x + whole.x, std::min(cell.y + y, height) + whole.y),
                CellWindow::kStride);
  return {window.previous, CellWindow::kStride};
}

/// Bit 8 row + column: the pixels of the cell's blocks that are not at the frame's edge.
inline uint64_t countedPixels(const MatchedCell& cell, Size size) {
  uint64_t bits = cell.blocks;
  bits = (bits | bits << 24) & 0x000000FF000000FF;
  bits = (bits | bits << 12) & 0x000F000F000F000F;
  bits = (bits | bits << 6) & 0x0303030303030303;
  bits = (bits | bits << 3) & 0x1111111111111111;
  bits *= 15;
  if (isInner(cell, size)) return bits;
  constexpr uint64_t kColumn = 0x0101010101010101;
  const int right = size.width - 1 - cell.x, bottom = size.height - 1 - cell.y;
  if (cell.x == 0) bits &= ~kColumn;
  for (int x = std::max(right, 0); x < kCellSize; ++x) bits &= ~(kColumn << x);
  if (cell.y == 0) bits &= ~uint64_t{0xFF};
  for (int y = std::max(bottom, 0); y < kCellSize; ++y) bits &= ~(uint64_t{0xFF} << (8 * y));
  return bits;
}

}  // namespace rg::motion::simd
#endif

HWY_BEFORE_NAMESPACE();
namespace rg::motion::simd::HWY_NAMESPACE {

#if HWY_TARGET == HWY_SCALAR

FitSums sumCell(const MatchedCell& cell, ImageView<const uint8_t> luma, const PaddedLuma& previous,
                Point d, int limit) {
  return sumFitPlainly(cell, luma, previous, d, limit);
}

GradientProducts sumAllGradients(std::span<const MatchedPart> parts,
                                 ImageView<const uint8_t> luma) {
  return sumGradientsPlainly(parts, luma);
}

#else
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr hn::CappedTag<int16_t, 2 * kCellSize> kShorts;
constexpr hn::RebindToUnsigned<decltype(kShorts)> kWords;
constexpr hn::RepartitionToWide<decltype(kShorts)> kInts;
constexpr hn::Rebind<uint8_t, decltype(kShorts)> kBytes;
using Shorts = hn::Vec<decltype(kShorts)>;
using Words = hn::Vec<decltype(kWords)>;
using Ints = hn::Vec<decltype(kInts)>;
/// Of a cell in a vector.
constexpr int kRows = static_cast<int>(hn::MaxLanes(kShorts)) / kCellSize;
static_assert(kRows == 1 || kRows == 2);

Words load(const Rows& rows, int y, int x) {
  const uint8_t* from = rows.row(y) + x;
  if constexpr (kRows == 1) {
    return hn::PromoteTo(kWords, hn::LoadU(kBytes, from));
  } else {
    constexpr hn::Half<decltype(kBytes)> half;
    return hn::PromoteTo(
        kWords, hn::Combine(kBytes, hn::LoadU(half, from + rows.stride), hn::LoadU(half, from)));
  }
}

/// The rows that begin one below those of `upper`, of which `lower` are the next ones.
Words nextRows(Words upper, Words lower) {
  if constexpr (kRows == 1)
    return lower;
  else
    return hn::ConcatLowerUpper(kWords, lower, upper);
}

Shorts asShorts(Words v) {
  return hn::BitCast(kShorts, v);
}

/// Rows y − 1, y and y + 1, and the gradients of row y.
struct Gradients {
  Words here;
  Shorts x, y;
};

/// Walks the rows of a picture from above to below.
struct Picture {
  explicit Picture(const Rows& from) : rows(from), above(load(from, -1, 0)) {}

  Gradients next(int y) {
    const Words below = load(rows, y + 1, 0);
    const Words here = kRows == 1 ? load(rows, y, 0) : nextRows(above, below);
    const Gradients gradients{here, asShorts(hn::Sub(load(rows, y, 1), load(rows, y, -1))),
                              asShorts(hn::Sub(below, above))};
    above = kRows == 1 ? here : below;
    return gradients;
  }

  const Rows rows;
  Words above;
};

/// The previous picture between its pixels, in 1/256 grey levels. What is below a row's 256ths
/// counts only when the four pixels are added.
struct Samples {
  Samples(const Rows& from, int fractionX, int fractionY)
      : rows(from),
        left(hn::Set(kWords, static_cast<uint16_t>(kFine - fractionX))),
        right(hn::Set(kWords, static_cast<uint16_t>(fractionX))),
        high(hn::Set(kWords, static_cast<uint16_t>(kFine - fractionY))),
        low(hn::Set(kWords, static_cast<uint16_t>(fractionY))),
        upper(across(0)) {}

  Words next(int y) {
    const Words later = across(y + kRows), lower = nextRows(upper, later);
    const Words byte = hn::Set(kWords, 0xFF);
    const Words whole =
        hn::Add(hn::Mul(hn::ShiftRight<8>(upper), high), hn::Mul(hn::ShiftRight<8>(lower), low));
    const Words rest =
        hn::Add(hn::Mul(hn::And(upper, byte), high), hn::Mul(hn::And(lower, byte), low));
    upper = later;
    return hn::Add(whole, hn::ShiftRight<8>(rest));
  }

  [[nodiscard]] Words across(int y) const {
    return hn::Add(hn::Mul(load(rows, y, 0), left), hn::Mul(load(rows, y, 1), right));
  }

  const Rows rows;
  const Words left, right, high, low;
  Words upper;
};

/// The previous picture at its pixels.
struct WholeSamples {
  [[nodiscard]] Words next(int y) const { return hn::ShiftLeft<8>(load(rows, y, 0)); }
  const Rows rows;
};

/// Sums of products of 16 bits.
struct Sum {
  Sum() : first(hn::Zero(kInts)), second(first) {}
  void add(Shorts a, Shorts b) {
    first = hn::ReorderWidenMulAccumulate(kInts, a, b, first, second);
  }
  [[nodiscard]] Ints total() const { return hn::Add(first, second); }

  Ints first, second;
};

/// The sums over the lanes of each of four vectors.
void storeTotals(Ints a, Ints b, Ints c, Ints d, int32_t* to) {
  constexpr hn::RepartitionToWide<decltype(kInts)> longs;
  const auto fold = [](Ints p, Ints q) {
    return hn::Add(hn::InterleaveLower(kInts, p, q), hn::InterleaveUpper(kInts, p, q));
  };
  const auto ab = hn::BitCast(longs, fold(a, b)), cd = hn::BitCast(longs, fold(c, d));
  const Ints all = hn::Add(hn::BitCast(kInts, hn::InterleaveLower(longs, ab, cd)),
                           hn::BitCast(kInts, hn::InterleaveUpper(longs, ab, cd)));
  if constexpr (kRows == 1) {
    hn::StoreU(all, kInts, to);
  } else {
    constexpr hn::Half<decltype(kInts)> half;
    hn::StoreU(hn::Add(hn::LowerHalf(half, all), hn::UpperHalf(half, all)), half, to);
  }
}

/// Which of the pixels of the rows from y on are counted.
auto countedRows(const uint64_t (&counted)[2], int y) {
  return hn::LoadMaskBits(kShorts, reinterpret_cast<const uint8_t*>(counted) + y);
}

template <class Sampler>
FitSums sumPixels(const Rows& current, Sampler samples, uint64_t pixels, int limit) {
  const uint64_t counted[2] = {pixels, 0};
  const Words most = hn::Set(kWords, static_cast<uint16_t>(limit));
  const Shorts one = hn::Set(kShorts, 1);
  Picture picture(current);
  Shorts x = hn::Zero(kShorts), y = x, fitting = x;
  Sum misfit, r, rr, xx, xy, yy, xr, yr;
  for (int row = 0; row < kCellSize; row += kRows) {
    const Gradients g = picture.next(row);
    const Words here = hn::ShiftLeft<8>(g.here), expected = samples.next(row);
    const Words size = hn::Or(hn::SaturatedSub(here, expected), hn::SaturatedSub(expected, here));
    const Words limited = hn::Min(size, most);
    const auto isCounted = countedRows(counted, row);
    const auto fits = hn::And(isCounted, hn::RebindMask(kShorts, hn::Eq(limited, size)));
    const Shorts gx = hn::IfThenElseZero(fits, g.x), gy = hn::IfThenElseZero(fits, g.y);
    const Shorts residual = hn::IfThenElseZero(fits, asShorts(hn::Sub(here, expected)));
    const Shorts coarse = hn::ShiftRight<4>(residual);
    fitting = hn::Sub(fitting, hn::VecFromMask(kShorts, fits));
    x = hn::Add(x, gx);
    y = hn::Add(y, gy);
    misfit.add(hn::IfThenElseZero(isCounted, asShorts(limited)), one);
    r.add(residual, one);
    rr.add(coarse, coarse);
    xx.add(gx, gx);
    xy.add(gx, gy);
    yy.add(gy, gy);
    xr.add(gx, residual);
    yr.add(gy, residual);
  }
  Sum sumX, sumY, sumFitting;
  sumX.add(x, one);
  sumY.add(y, one);
  sumFitting.add(fitting, one);
  int32_t t[12];
  storeTotals(misfit.total(), r.total(), rr.total(), sumFitting.total(), t);
  storeTotals(xx.total(), xy.total(), yy.total(), xr.total(), t + 4);
  storeTotals(yr.total(), sumX.total(), sumY.total(), hn::Zero(kInts), t + 8);
  return {std::popcount(pixels), t[0], t[3], t[9], t[10], t[1], t[4], t[5], t[6], t[7], t[8], t[2]};
}

FitSums sumCell(const MatchedCell& cell, ImageView<const uint8_t> luma, const PaddedLuma& previous,
                Point d, int limit) {
  const uint64_t pixels = countedPixels(cell, luma.size);
  const Point whole{-d.x >> kFineBits, -d.y >> kFineBits};
  const int fractionX = -d.x & (kFine - 1), fractionY = -d.y & (kFine - 1);
  CellWindow window;
  Rows current{luma.data + cell.y * luma.strideBytes + cell.x, luma.strideBytes};
  Rows before{previous.along(cell.x + whole.x, cell.y + whole.y), previous.stride()};
  if (!isInner(cell, luma.size)) {
    current = copyCurrent(cell, luma, window);
    before = copyPrevious(cell, luma.height(), previous, whole, window);
  }
  if (fractionX == 0 && fractionY == 0)
    return sumPixels(current, WholeSamples{before}, pixels, limit);
  return sumPixels(current, Samples(before, fractionX, fractionY), pixels, limit);
}

GradientProducts sumAllGradients(std::span<const MatchedPart> parts,
                                 ImageView<const uint8_t> luma) {
  GradientProducts sums;
  for (const MatchedPart& part : parts)
    forCells(part, [&](const MatchedCell& cell) {
      const uint64_t counted[2] = {countedPixels(cell, luma.size), 0};
      CellWindow window;
      Rows rows{luma.data + cell.y * luma.strideBytes + cell.x, luma.strideBytes};
      if (!isInner(cell, luma.size)) rows = copyCurrent(cell, luma, window);
      Picture picture(rows);
      Sum xx, xy, yy;
      for (int row = 0; row < kCellSize; row += kRows) {
        const Gradients g = picture.next(row);
        const auto isCounted = countedRows(counted, row);
        const Shorts gx = hn::IfThenElseZero(isCounted, g.x);
        const Shorts gy = hn::IfThenElseZero(isCounted, g.y);
        xx.add(gx, gx);
        xy.add(gx, gy);
        yy.add(gy, gy);
      }
      int32_t totals[4];
      storeTotals(xx.total(), xy.total(), yy.total(), hn::Zero(kInts), totals);
      sums.xx += totals[0];
      sums.xy += totals[1];
      sums.yy += totals[2];
    });
  return sums;
}

}  // namespace
#endif

FitMoments sumAllMoments(std::span<const MatchedPart> parts, const FitPlane& plane,
                         const FitField& field, int limit) {
  FitMoments moments;
  const int reach = plane.previous->reach();
  for (const MatchedPart& part : parts)
    forCells(part, [&](const MatchedCell& cell) {
      const Point offset = offsetOf(cell, field.centroid);
      const Point d = displacementAt(field, offset, reach);
      if (!isVisible(cell, d, plane.current.size)) return;
      addCell(sumCell(cell, plane.current, *plane.previous, d, limit), offset, moments);
    });
  return moments;
}

}  // namespace rg::motion::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace rg::motion {
namespace simd {
namespace {
HWY_EXPORT(sumCell);
HWY_EXPORT(sumAllMoments);
HWY_EXPORT(sumAllGradients);
}  // namespace
}  // namespace simd

FitSums sumFit(const MatchedCell& cell, ImageView<const uint8_t> luma, const PaddedLuma& previous,
               Point d, int limit) {
  return HWY_DYNAMIC_DISPATCH(simd::sumCell)(cell, luma, previous, d, limit);
}

FitMoments sumMoments(std::span<const MatchedPart> parts, const FitPlane& plane,
                      const FitField& field, int limit) {
  return HWY_DYNAMIC_DISPATCH(simd::sumAllMoments)(parts, plane, field, limit);
}

GradientProducts sumGradients(std::span<const MatchedPart> parts, ImageView<const uint8_t> luma) {
  return HWY_DYNAMIC_DISPATCH(simd::sumAllGradients)(parts, luma);
}

}  // namespace rg::motion
#endif
