// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/simd/segmentation/border_rows.hpp"

#include "core/simd/base/targets.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/simd/segmentation/border_rows.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace rg::segmentation::simd::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

void packCells(const CellPlanes& cells, int count, uint8_t pureRange, uint64_t* HWY_RESTRICT keys,
               uint64_t* HWY_RESTRICT colours, uint64_t* HWY_RESTRICT pures) {
  const uint8_t *HWY_RESTRICT red = cells.red, *HWY_RESTRICT green = cells.green;
  const uint8_t *HWY_RESTRICT blue = cells.blue, *HWY_RESTRICT ranges = cells.ranges;
  const uint16_t* HWY_RESTRICT ids = cells.ids;
  for (int i = 0; i < count; ++i) {
    const uint64_t colour = uint64_t{1} << (3 * kLaneBits) | uint64_t{blue[i]} << (2 * kLaneBits) |
                            uint64_t{green[i]} << kLaneBits | uint64_t{red[i]};
    const uint64_t isPure = ranges[i] <= pureRange ? ~uint64_t{0} : uint64_t{0};
    keys[i] = ids[i];
    colours[i] = colour;
    pures[i] = colour & isPure;
  }
}

using Words = hn::CappedTag<uint64_t, kSideLanes>;
using V = hn::Vec<Words>;
constexpr Words kWords;

/// What is found round the cells of a vector.
struct Sums {
  V ownAll, ownPure, otherAll, otherPure;
  V anyKey, allKeys;
};

void take(const PackedCells& cells, int at, V own, Sums& sums) {
  const V key = hn::LoadU(kWords, cells.keys + at), colour = hn::LoadU(kWords, cells.colours + at);
  const V pure = hn::LoadU(kWords, cells.pures + at), zero = hn::Zero(kWords);
  const auto isOwn = hn::Eq(key, own);
  const auto isAlike = hn::Eq(hn::ShiftRight<16>(hn::Xor(key, own)), zero);
  const auto isOther = hn::AndNot(hn::Or(isOwn, hn::Eq(key, zero)), isAlike);
  sums.ownAll = hn::Add(sums.ownAll, hn::IfThenElseZero(isOwn, colour));
  sums.ownPure = hn::Add(sums.ownPure, hn::IfThenElseZero(isOwn, pure));
  sums.otherAll = hn::Add(sums.otherAll, hn::IfThenElseZero(isOther, colour));
  sums.otherPure = hn::Add(sums.otherPure, hn::IfThenElseZero(isOther, pure));
  const V other = hn::IfThenElseZero(isOther, key);
  sums.anyKey = hn::Or(sums.anyKey, other);
  sums.allKeys = hn::And(sums.allKeys, hn::IfThenElse(isOther, key, hn::Set(kWords, kManySides)));
}

void findSides(const CellRows& cells, int count, const CellSides& sides) {
  const V zero = hn::Zero(kWords), many = hn::Set(kWords, kManySides);
  const auto firstOf = [&](V first, V second) {
    return hn::IfThenElse(hn::Eq(first, zero), second, first);
  };
  for (int i = 0; i < count; i += static_cast<int>(hn::Lanes(kWords))) {
    const V own = hn::LoadU(kWords, cells.middle.keys + i);
    const V pure = hn::LoadU(kWords, cells.middle.pures + i);
    Sums sums{pure, pure, zero, zero, zero, many};
    for (int step = -1; step <= 1; ++step) {
      take(cells.above, i + step, own, sums);
      if (step != 0) take(cells.middle, i + step, own, sums);
      take(cells.below, i + step, own, sums);
    }
    const V alone = firstOf(sums.ownAll, hn::LoadU(kWords, cells.middle.colours + i));
    hn::StoreU(firstOf(sums.ownPure, alone), kWords, sides.own + i);
    hn::StoreU(firstOf(sums.otherPure, sums.otherAll), kWords, sides.other + i);
    const V key = hn::IfThenElse(hn::Eq(sums.anyKey, sums.allKeys), sums.anyKey, many);
    const auto isNone = hn::Or(hn::Eq(own, zero), hn::Eq(sums.anyKey, zero));
    hn::StoreU(hn::IfThenElse(isNone, zero, key), kWords, sides.others + i);
  }
}

template <int kSide, class T>
void repeat(const T* HWY_RESTRICT from, int count, T* HWY_RESTRICT to) {
  for (int i = 0; i < count; ++i)
    for (int k = 0; k < kSide; ++k) to[kSide * i + k] = from[i];
}

template <class T>
void repeatAny(const T* from, int count, int side, T* to) {
  if (side == 2) return repeat<2>(from, count, to);
  if (side == 4) return repeat<4>(from, count, to);
  return repeat<8>(from, count, to);
}

void repeatBytes(const uint8_t* from, int count, int side, uint8_t* to) {
  repeatAny(from, count, side, to);
}

void repeatWords(const uint16_t* from, int count, int side, uint16_t* to) {
  repeatAny(from, count, side, to);
}

uint16_t difference(uint8_t a, uint8_t b) {
  const uint8_t high = a > b ? a : b, low = a > b ? b : a;
  return static_cast<uint8_t>(high - low);
}

uint16_t distance(uint16_t a, uint16_t b, uint16_t c, uint16_t margin) {
  const auto sum = static_cast<uint16_t>(a + b + c + margin);
  return sum < 255 ? sum : uint16_t{255};
}

void chooseSides(const PixelSides& row, int count, uint16_t* HWY_RESTRICT ids) {
  const uint8_t *HWY_RESTRICT red = row.pixels[0], *HWY_RESTRICT green = row.pixels[1];
  const uint8_t *HWY_RESTRICT blue = row.pixels[2], *HWY_RESTRICT ownRed = row.own[0];
  const uint8_t *HWY_RESTRICT ownGreen = row.own[1], *HWY_RESTRICT ownBlue = row.own[2];
  const uint8_t *HWY_RESTRICT otherRed = row.other[0], *HWY_RESTRICT otherGreen = row.other[1];
  const uint8_t* HWY_RESTRICT otherBlue = row.other[2];
  const uint16_t *HWY_RESTRICT owns = row.owns, *HWY_RESTRICT others = row.others;
  const uint16_t margin = row.margin;
  for (int i = 0; i < count; ++i) {
    const uint16_t own = distance(difference(red[i], ownRed[i]), difference(green[i], ownGreen[i]),
                                  difference(blue[i], ownBlue[i]), 0);
    const uint16_t other =
        distance(difference(red[i], otherRed[i]), difference(green[i], otherGreen[i]),
                 difference(blue[i], otherBlue[i]), margin);
    ids[i] = other < own ? others[i] : owns[i];
  }
}

}  // namespace
}  // namespace rg::segmentation::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace rg::segmentation::simd {
namespace {
HWY_EXPORT(packCells);
HWY_EXPORT(findSides);
HWY_EXPORT(repeatBytes);
HWY_EXPORT(repeatWords);
HWY_EXPORT(chooseSides);
}  // namespace

void packCells(const CellPlanes& cells, int count, uint8_t pureRange, uint64_t* keys,
               uint64_t* colours, uint64_t* pures) {
  HWY_DYNAMIC_DISPATCH(packCells)(cells, count, pureRange, keys, colours, pures);
}

void findSides(const CellRows& cells, int count, const CellSides& sides) {
  HWY_DYNAMIC_DISPATCH(findSides)(cells, count, sides);
}

void repeatRow(const uint8_t* from, int count, int side, uint8_t* to) {
  HWY_DYNAMIC_DISPATCH(repeatBytes)(from, count, side, to);
}

void repeatRow(const uint16_t* from, int count, int side, uint16_t* to) {
  HWY_DYNAMIC_DISPATCH(repeatWords)(from, count, side, to);
}

void chooseSides(const PixelSides& row, int count, uint16_t* ids) {
  HWY_DYNAMIC_DISPATCH(chooseSides)(row, count, ids);
}

}  // namespace rg::segmentation::simd
#endif
