// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/bit_mask.hpp"

#include "core/simd/base/bit_rows.hpp"

namespace rg {
namespace {

void thickenRow(const uint64_t* from, int words, int margin, uint64_t* to) {
  for (int word = 0; word < words; ++word) {
    const uint64_t before = word > 0 ? from[word - 1] : 0, here = from[word];
    const uint64_t after = word + 1 < words ? from[word + 1] : 0;
    uint64_t thick = here;
    if ((before | here | after) != 0)
      for (int i = 1; i <= margin; ++i) {
        thick |= here << i | before >> (kWordColumns - i);
        thick |= here >> i | after << (kWordColumns - i);
      }
    to[word] = thick;
  }
}

}  // namespace

uint32_t countSet(const BitMask& mask) {
  uint32_t count = 0;
  for (int y = 0; y < mask.height(); ++y) count += simd::countBits(mask.row(y), mask.wordsPerRow());
  return count;
}

void packEqual(ImageView<const uint8_t> bytes, uint8_t value, BitMask& mask) {
  mask.resize(bytes.size);
  for (int y = 0; y < bytes.height(); ++y)
    simd::packEqualRow(bytes.row(y), bytes.width(), value, mask.row(y));
}

void paint(const BitMask& mask, uint8_t value, ImageView<uint8_t> bytes) {
  assert(mask.size() == bytes.size);
  for (int y = 0; y < bytes.height(); ++y) paintRow(mask, y, value, bytes.row(y));
}

void paintRow(const BitMask& mask, int y, uint8_t value, uint8_t* bytes) {
  for (int word = 0; word < mask.wordsPerRow(); ++word, bytes += kWordColumns) {
    const uint64_t bits = mask.row(y)[word];
    if (bits == ~uint64_t{0})
      std::fill_n(bytes, kWordColumns, value);
    else
      forSetBits(bits, 0, [&](int x) { bytes[x] = value; });
  }
}

void remove(const BitMask& b, BitMask& a) {
  assert(a.size() == b.size());
  for (int y = 0; y < a.height(); ++y)
    for (int word = 0; word < a.wordsPerRow(); ++word) a.row(y)[word] &= ~b.row(y)[word];
}

void keepOnly(const BitMask& b, BitMask& a) {
  assert(a.size() == b.size());
  for (int y = 0; y < a.height(); ++y)
    for (int word = 0; word < a.wordsPerRow(); ++word) a.row(y)[word] &= b.row(y)[word];
}

void thicken(const BitMask& mask, int margin, const Executor& executor, BitMask& across,
             BitMask& out) {
  assert(margin >= 1 && margin < kWordColumns);
  const int words = mask.wordsPerRow(), height = mask.height();
  across.resize(mask.size());
  out.resize(mask.size());
  executor.forRows(height, [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      thickenRow(mask.row(y), words, margin, across.row(y));
      across.row(y)[words - 1] &= mask.columnsOf(words - 1);
    }
  });
  executor.forRows(height, [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      uint64_t* to = out.row(y);
      std::fill_n(to, words, uint64_t{0});
      const int bottom = std::min(height - 1, y + margin);
      for (int row = std::max(0, y - margin); row <= bottom; ++row) {
        const uint64_t* from = across.row(row);
        for (int word = 0; word < words; ++word) to[word] |= from[word];
      }
    }
  });
}

}  // namespace rg
