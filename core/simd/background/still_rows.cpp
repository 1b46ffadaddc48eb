// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/simd/background/still_rows.hpp"

#include "core/base/pixel.hpp"
#include "core/simd/base/targets.hpp"

#include <algorithm>
#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/simd/background/still_rows.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace rg::background::HWY_NAMESPACE {
#if HWY_TARGET == HWY_SCALAR
using plain::agedColumns;
using plain::followStillWord;
#else
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using Words = hn::CappedTag<uint16_t, 32>;
using Bytes = hn::Rebind<uint8_t, Words>;
using W = hn::Vec<Words>;
using V = hn::Vec<Bytes>;
constexpr Words kWords;
constexpr Bytes kBytes;

W widened(const uint8_t* from) {
  return hn::PromoteTo(kWords, hn::LoadU(kBytes, from));
}

W radiusOf(const StillWord& word, const RadiusRow& radius, size_t i) {
  const W share = hn::Set(kWords, radius.brightness);
  W sum = hn::ShiftRight<8>(hn::Mul(widened(word.pixels[0] + i), share));
  sum = hn::Add(sum, hn::Set(kWords, radius.least));
  sum = hn::Add(sum, hn::ShiftRight<2>(widened(radius.noise + i)));
  sum = hn::Add(sum, hn::ShiftRight<4>(widened(radius.unrest + i)));
  return hn::Min(sum, hn::Set(kWords, 255));
}

W differenceOf(const StillWord& word, size_t i) {
  V most = hn::Zero(kBytes);
  for (size_t c = 0; c < static_cast<size_t>(word.channels); ++c) {
    const V now = hn::LoadU(kBytes, word.pixels[c] + i), kept = hn::LoadU(kBytes, word.kept[c] + i);
    most = hn::Max(most, hn::Or(hn::SaturatedSub(now, kept), hn::SaturatedSub(kept, now)));
  }
  return hn::PromoteTo(kWords, most);
}

void followStillWord(const StillWord& word, const RadiusRow& radius) {
  const W zero = hn::Zero(kWords), one = hn::Set(kWords, 1), most = hn::Set(kWords, word.mostAge);
  uint8_t bits[8];
  std::memcpy(bits, &word.foreground, sizeof bits);
  for (size_t i = 0; i < 64; i += hn::Lanes(kWords)) {
    const auto isForeground = hn::LoadMaskBits(kWords, bits + i / 8);
    const W off = differenceOf(word, i), reach = radiusOf(word, radius, i);
    const W age = hn::LoadU(kWords, word.ages + i);
    const W younger = hn::SaturatedSub(age, hn::Add(hn::ShiftRight<2>(age), one));
    const auto isOlder = hn::And(hn::Eq(hn::Max(off, reach), reach), hn::Ne(age, zero));
    const W older = hn::Max(age, hn::Min(hn::SaturatedAdd(age, one), most));
    const W next = hn::IfThenElse(isOlder, older, younger);
    const auto isNew = hn::And(hn::Eq(next, zero), isForeground);
    hn::StoreU(hn::IfThenElseZero(isForeground, hn::Max(next, one)), kWords, word.ages + i);
    const W chosen = hn::IfThenElseZero(isNew, hn::Set(kWords, 255));
    const V isChosen = hn::DemoteTo(kBytes, hn::BitCast(hn::RebindToSigned<Words>(), chosen));
    for (size_t c = 0; c < static_cast<size_t>(word.channels); ++c) {
      const V now = hn::LoadU(kBytes, word.pixels[c] + i);
      const V kept = hn::LoadU(kBytes, word.kept[c] + i);
      hn::StoreU(hn::Or(hn::And(isChosen, now), hn::AndNot(isChosen, kept)), kBytes,
                 word.kept[c] + i);
    }
  }
}

uint64_t agedColumns(const uint16_t* ages, uint16_t least) {
  const W limit = hn::Set(kWords, least);
  uint8_t bits[16] = {};  // StoreMaskBits may write eight bytes.
  for (size_t i = 0; i < 64; i += hn::Lanes(kWords)) {
    const W age = hn::LoadU(kWords, ages + i);
    hn::StoreMaskBits(kWords, hn::Eq(hn::Max(age, limit), age), bits + i / 8);
  }
  uint64_t columns;
  std::memcpy(&columns, bits, sizeof columns);
  return columns;
}

}  // namespace
#endif
}  // namespace rg::background::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace rg::background {

void plain::followStillWord(const StillWord& word, const RadiusRow& radius) {
  for (int x = 0; x < 64; ++x) {
    uint16_t& age = word.ages[x];
    const bool isForeground = (word.foreground >> x & 1) != 0;
    int off = 0;
    for (size_t c = 0; c < static_cast<size_t>(word.channels); ++c)
      off = std::max(off, absDiff(word.pixels[c][x], word.kept[c][x]));
    const bool isSame = off <= radiusAt(radius, word.pixels[0][x], x);
    const int next = nextAge(age, isSame, word.mostAge);
    age = static_cast<uint16_t>(isForeground ? std::max(next, 1) : 0);
    if (!isForeground || next != 0) continue;
    for (size_t c = 0; c < static_cast<size_t>(word.channels); ++c)
      word.kept[c][x] = word.pixels[c][x];
  }
}

uint64_t plain::agedColumns(const uint16_t* ages, uint16_t least) {
  uint64_t columns = 0;
  for (int x = 0; x < 64; ++x) columns |= static_cast<uint64_t>(ages[x] >= least) << x;
  return columns;
}

namespace {
HWY_EXPORT(followStillWord);
HWY_EXPORT(agedColumns);
}  // namespace

void simd::followStillWord(const StillWord& word, const RadiusRow& radius) {
  HWY_DYNAMIC_DISPATCH(followStillWord)(word, radius);
}

uint64_t simd::agedColumns(const uint16_t* ages, uint16_t least) {
  return HWY_DYNAMIC_DISPATCH(agedColumns)(ages, least);
}

}  // namespace rg::background
#endif
