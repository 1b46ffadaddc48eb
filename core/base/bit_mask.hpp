// SPDX-License-Identifier: LGPL-2.1-or-later
// A binary mask of one bit a pixel: 64 columns a word, so that empty stretches cost next to
// nothing.
//
// Column x of a row is bit x % 64 of word x / 64. Bits beyond the width are 0.
#pragma once

#include "core/base/memory/executor.hpp"
#include "core/base/memory/image.hpp"

#include <algorithm>
#include <bit>
#include <cstdint>

namespace rg {

inline constexpr int kWordColumns = 64;

class BitMask {
 public:
  BitMask() = default;
  explicit BitMask(Size size) { resize(size); }

  /// Keeps its memory when that is large enough. The contents are undefined.
  void resize(Size size) {
    size_ = size;
    words_.resize({(size.width + kWordColumns - 1) / kWordColumns, size.height});
  }
  void clear() { words_.fill(0); }

  [[nodiscard]] Size size() const { return size_; }
  [[nodiscard]] int width() const { return size_.width; }
  [[nodiscard]] int height() const { return size_.height; }
  [[nodiscard]] int wordsPerRow() const { return words_.width(); }
  [[nodiscard]] uint64_t* row(int y) { return words_.row(y); }
  [[nodiscard]] const uint64_t* row(int y) const { return words_.row(y); }
  [[nodiscard]] bool at(int x, int y) const {
    assert(x >= 0 && x < size_.width);
    return (row(y)[x / kWordColumns] >> (x % kWordColumns) & 1) != 0;
  }
  /// A row's words; bits beyond the width stay 0.
  [[nodiscard]] Image<uint64_t>& words() { return words_; }
  [[nodiscard]] const Image<uint64_t>& words() const { return words_; }
  void set(int x, int y) { row(y)[x / kWordColumns] |= uint64_t{1} << (x % kWordColumns); }

  /// The bits of a row's word that stand for columns of the mask.
  [[nodiscard]] uint64_t columnsOf(int word) const {
    const int columns = size_.width - word * kWordColumns;
    return columns >= kWordColumns ? ~uint64_t{0} : (uint64_t{1} << columns) - 1;
  }

 private:
  Image<uint64_t> words_;
  Size size_;
};

/// Calls visit(column) for each set bit of a word whose first column is `first`.
template <class Visit>
void forSetBits(uint64_t word, int first, Visit&& visit) {
  for (; word != 0; word &= word - 1) visit(first + std::countr_zero(word));
}

/// Calls visit(x, y) for each set pixel of the rows first … last − 1, in raster order.
template <class Visit>
void forSetPixels(const BitMask& mask, int firstRow, int lastRow, Visit&& visit) {
  for (int y = firstRow; y < lastRow; ++y)
    for (int word = 0; word < mask.wordsPerRow(); ++word)
      forSetBits(mask.row(y)[word], word * kWordColumns, [&](int x) { visit(x, y); });
}

/// Calls edit(word, bits) for the parts of the words that hold the columns begin … end − 1.
template <class Word, class Edit>
void forWordsOf(Word* row, int begin, int end, Edit&& edit) {
  for (int x = begin; x < end;) {
    const int first = x % kWordColumns;
    const int count = std::min(end - x, kWordColumns - first);
    const uint64_t bits = count == kWordColumns ? ~uint64_t{0} : (uint64_t{1} << count) - 1;
    edit(row[x / kWordColumns], bits << first);
    x += count;
  }
}

inline void setColumns(uint64_t* row, int begin, int end, bool value) {
  forWordsOf(row, begin, end,
             [&](uint64_t& word, uint64_t bits) { word = value ? word | bits : word & ~bits; });
}

/// How many of the columns begin … end − 1 are set.
[[nodiscard]] inline int countColumns(const uint64_t* row, int begin, int end) {
  int count = 0;
  forWordsOf(row, begin, end,
             [&](uint64_t word, uint64_t bits) { count += std::popcount(word & bits); });
  return count;
}

[[nodiscard]] uint32_t countSet(const BitMask& mask);

/// Sets the bits of the pixels that equal `value`.
void packEqual(ImageView<const uint8_t> bytes, uint8_t value, BitMask& mask);
/// Writes `value` into the pixels whose bits are set.
void paint(const BitMask& mask, uint8_t value, ImageView<uint8_t> bytes);
void paintRow(const BitMask& mask, int y, uint8_t value, uint8_t* bytes);

/// Clears in `a` what is set in `b`.
void remove(const BitMask& b, BitMask& a);
/// Clears in `a` what is not set in `b`.
void keepOnly(const BitMask& b, BitMask& a);

/// Sets what is at most `margin` columns and rows from a set pixel. margin 1 … 63. `across` is
/// scratch.
void thicken(const BitMask& mask, int margin, const Executor& executor, BitMask& across,
             BitMask& out);

}  // namespace rg
