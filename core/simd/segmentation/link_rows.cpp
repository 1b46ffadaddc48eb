// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/simd/segmentation/link_rows.hpp"

#include <cstring>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/simd/segmentation/link_rows.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace rg::segmentation::simd::HWY_NAMESPACE {
namespace {

void smoothRow(const uint8_t* HWY_RESTRICT a, const uint8_t* HWY_RESTRICT b,
               const uint8_t* HWY_RESTRICT from, int count, uint8_t* HWY_RESTRICT to) {
  for (int i = 0; i < count; ++i) {
    const auto sides = static_cast<uint8_t>((a[i] + b[i] + 1) >> 1);
    to[i] = static_cast<uint8_t>((sides + from[i] + 1) >> 1);
  }
}

uint8_t difference(uint8_t a, uint8_t b) {
  const uint8_t high = a > b ? a : b, low = a > b ? b : a;
  return static_cast<uint8_t>(high - low);
}

uint8_t smaller(uint8_t a, uint8_t b) {
  return a < b ? a : b;
}

uint8_t larger(uint8_t a, uint8_t b) {
  return a > b ? a : b;
}

void measureGrey(const uint8_t* HWY_RESTRICT a, const uint8_t* HWY_RESTRICT b, int count,
                 uint8_t most, uint8_t* HWY_RESTRICT to) {
  for (int i = 0; i < count; ++i) to[i] = smaller(difference(a[i], b[i]), most);
}

void measureRow(const PixelPairs& pairs, int count, uint8_t most, uint8_t* HWY_RESTRICT to) {
  if (pairs.channels == 1) return measureGrey(pairs.a[0], pairs.b[0], count, most, to);
  const uint8_t *HWY_RESTRICT a0 = pairs.a[0], *HWY_RESTRICT b0 = pairs.b[0];
  const uint8_t *HWY_RESTRICT a1 = pairs.a[1], *HWY_RESTRICT b1 = pairs.b[1];
  const uint8_t *HWY_RESTRICT a2 = pairs.a[2], *HWY_RESTRICT b2 = pairs.b[2];
  for (int i = 0; i < count; ++i) {
    const uint8_t two = larger(difference(a0[i], b0[i]), difference(a1[i], b1[i]));
    to[i] = smaller(larger(two, difference(a2[i], b2[i])), most);
  }
}

/// 256 / chroma in Q16 as core/segmentation/hue.hpp's table has it: a division in floating point is
/// at most one off, which its remainder tells.
int reciprocalOf(int chroma) {
  constexpr int kOne = kHueSextant << 16;
  const auto guess = static_cast<int>(static_cast<float>(kOne) / static_cast<float>(chroma));
  const int rest = kOne - guess * chroma;
  return guess + (2 * rest >= chroma ? 1 : 0);
}

void findHueRow(const uint8_t* HWY_RESTRICT red, const uint8_t* HWY_RESTRICT green,
                const uint8_t* HWY_RESTRICT blue, int count, const HueBand& band,
                int16_t* HWY_RESTRICT hues) {
  const int first = band.first, length = band.count;
  for (int i = 0; i < count; ++i) {
    const int r = red[i], g = green[i], b = blue[i];
    const int rg = r > g ? r : g, low = r > g ? g : r;
    const int largest = rg > b ? rg : b;
    const int chroma = largest - (low < b ? low : b);
    const bool isRed = largest == r, isGreen = largest == g;
    const int turned = isRed ? g - b : isGreen ? b - r : r - g;
    const int start = isRed ? 0 : isGreen ? 2 * kHueSextant : 4 * kHueSextant;
    const int turn = (turned * reciprocalOf(chroma > 1 ? chroma : 1) + (1 << 15)) >> 16;
    const int hue = start + turn + (start + turn < 0 ? kHueCount : 0);
    const int beyond = hue - first + (hue < first ? kHueCount : 0);
    const int marked = hue | (beyond < length ? int{kInBand} : 0);
    hues[i] = static_cast<int16_t>(chroma < kLeastChroma ? kAchromatic : marked);
  }
}

void guardRow(const int16_t* HWY_RESTRICT a, const int16_t* HWY_RESTRICT b, int count,
              const HueGuard& guard, uint8_t* HWY_RESTRICT distances) {
  constexpr int16_t kHueBits = kInBand - 1;
  const auto least = static_cast<int16_t>(guard.least);
  const auto most = static_cast<int16_t>(kHueCount - guard.least);
  for (int i = 0; i < count; ++i) {
    const auto p = static_cast<int16_t>(a[i] & kHueBits);
    const auto q = static_cast<int16_t>(b[i] & kHueBits);
    const auto apart = static_cast<int16_t>(p > q ? p - q : q - p);
    // Only kAchromatic is negative.
    const bool parts =
        ((a[i] | b[i]) >= 0) & (((a[i] ^ b[i]) & kInBand) != 0) & (apart > least) & (apart < most);
    const uint8_t raised = larger(distances[i], guard.to);
    distances[i] = parts ? raised : distances[i];
  }
}

void chooseRow(const Distances& distances, int count, uint8_t none, uint8_t* HWY_RESTRICT nearest) {
  const uint8_t* HWY_RESTRICT left = distances.left;
  const uint8_t *HWY_RESTRICT up = distances.up, *HWY_RESTRICT down = distances.down;
  for (int i = 0; i < count; ++i) {
    const uint8_t u = up[i], l = left[i], r = left[i + 1];
    const uint8_t least = smaller(smaller(u, l), smaller(r, down[i]));
    uint8_t choice = kNearestDown;
    choice = r == least ? uint8_t{kNearestRight} : choice;
    choice = l == least ? uint8_t{kNearestLeft} : choice;
    choice = u == least ? uint8_t{kNearestUp} : choice;
    nearest[i] = least == none ? uint8_t{kNearestNone} : choice;
  }
}

void linkAlike(const LinkRow& row, int count, const LinkBits& bits, uint8_t* HWY_RESTRICT links) {
  const uint8_t *HWY_RESTRICT left = row.left, *HWY_RESTRICT up = row.up;
  const uint8_t similarity = row.similarity;
  const uint8_t leftBit = bits.leftBit, upBit = bits.upBit, always = bits.always;
  for (int i = 0; i < count; ++i) {
    const uint8_t leftLink = left[i] <= similarity ? leftBit : uint8_t{0};
    const uint8_t upLink = up[i] <= similarity ? upBit : uint8_t{0};
    links[i] = static_cast<uint8_t>(leftLink | upLink | always);
  }
}

void linkNearest(const LinkRow& row, int count, const LinkBits& bits, uint8_t* HWY_RESTRICT links) {
  const uint8_t* HWY_RESTRICT up = row.up;
  const uint8_t *HWY_RESTRICT nearest = row.nearest, *HWY_RESTRICT above = row.above;
  const uint8_t none = row.none, leftBit = bits.leftBit, upBit = bits.upBit;
  for (int i = 0; i < count; ++i) {
    const uint8_t mine = nearest[i] == kNearestUp ? upBit : uint8_t{0};
    const uint8_t its = above[i] == kNearestDown ? upBit : uint8_t{0};
    const uint8_t left = nearest[i] == kNearestLeft ? leftBit : uint8_t{0};
    links[i] = static_cast<uint8_t>(links[i] | mine | (up[i] == none ? uint8_t{0} : its) | left);
  }
  for (int i = 1; i < count; ++i) {
    const uint8_t its = nearest[i - 1] == kNearestRight ? leftBit : uint8_t{0};
    links[i] = static_cast<uint8_t>(links[i] | its);
  }
}

void linkRow(const LinkRow& row, int count, const LinkBits& bits, uint8_t* links) {
  linkAlike(row, count, bits, links);
  if (row.nearest != nullptr) linkNearest(row, count, bits, links);
}

void packSlowly(const uint8_t* bytes, int count, uint8_t mask, uint64_t* words) {
  for (int x = 0; x < count; x += 64) {
    uint64_t word = 0;
    const int bits = count - x < 64 ? count - x : 64;
    for (int i = 0; i < bits; ++i) word |= uint64_t{(bytes[x + i] & mask) != 0} << i;
    *words++ = word;
  }
}

void packRow(const uint8_t* bytes, int count, uint8_t mask, uint64_t* words) {
  int x = 0;
#if HWY_TARGET != HWY_SCALAR
  namespace hn = hwy::HWY_NAMESPACE;
  const hn::CappedTag<uint8_t, 64> d;
  const auto lanes = static_cast<int>(hn::Lanes(d));
  const auto wanted = hn::Set(d, mask), zero = hn::Zero(d);
  for (; x + 64 <= count; x += 64) {
    uint8_t bits[16];  // StoreMaskBits may write eight bytes at a time.
    for (int i = 0; i < 64; i += lanes)
      hn::StoreMaskBits(d, hn::Ne(hn::And(hn::LoadU(d, bytes + x + i), wanted), zero),
                        bits + i / 8);
    std::memcpy(words++, bits, sizeof *words);
  }
#endif
  packSlowly(bytes + x, count - x, mask, words);
}

}  // namespace
}  // namespace rg::segmentation::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace rg::segmentation::simd {
namespace {
HWY_EXPORT(smoothRow);
HWY_EXPORT(measureRow);
HWY_EXPORT(findHueRow);
HWY_EXPORT(guardRow);
HWY_EXPORT(chooseRow);
HWY_EXPORT(linkRow);
HWY_EXPORT(packRow);
}  // namespace

void smoothRow(const uint8_t* a, const uint8_t* b, const uint8_t* from, int count, uint8_t* to) {
  HWY_DYNAMIC_DISPATCH(smoothRow)(a, b, from, count, to);
}

void measureRow(const PixelPairs& pairs, int count, uint8_t most, uint8_t* to) {
  HWY_DYNAMIC_DISPATCH(measureRow)(pairs, count, most, to);
}

void findHueRow(const uint8_t* red, const uint8_t* green, const uint8_t* blue, int count,
                const HueBand& band, int16_t* hues) {
  HWY_DYNAMIC_DISPATCH(findHueRow)(red, green, blue, count, band, hues);
}

void guardRow(const int16_t* a, const int16_t* b, int count, const HueGuard& guard,
              uint8_t* distances) {
  HWY_DYNAMIC_DISPATCH(guardRow)(a, b, count, guard, distances);
}

void chooseRow(const Distances& distances, int count, uint8_t none, uint8_t* nearest) {
  HWY_DYNAMIC_DISPATCH(chooseRow)(distances, count, none, nearest);
}

void linkRow(const LinkRow& row, int count, const LinkBits& bits, uint8_t* links) {
  HWY_DYNAMIC_DISPATCH(linkRow)(row, count, bits, links);
}

void packRow(const uint8_t* bytes, int count, uint8_t mask, uint64_t* words) {
  HWY_DYNAMIC_DISPATCH(packRow)(bytes, count, mask, words);
}

}  // namespace rg::segmentation::simd
#endif
