// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/mask_cleaning.hpp"

#include "core/pixel.hpp"

#include <algorithm>
#include <array>
#include <cassert>

namespace rg {
namespace {

/// Numbers of 64 columns, one binary digit a word: digit i of column x is bit x of word i.
template <size_t digits>
using Numbers = std::array<uint64_t, digits>;
constexpr size_t kRowDigits = 4;     ///< At most 15 pixels along a row,
constexpr size_t kSquareDigits = 8;  ///< 225 in a square.

template <size_t digits>
void addBit(Numbers<digits>& sum, uint64_t carry) {
  for (size_t i = 0; i < digits && carry != 0; ++i) {
    const uint64_t both = sum[i] & carry;
    sum[i] ^= carry;
    carry = both;
  }
}

void addRow(Numbers<kSquareDigits>& sum, const uint64_t* row) {
  uint64_t carry = 0;
  for (size_t i = 0; i < kRowDigits; ++i) {
    const uint64_t half = sum[i] ^ row[i];
    const uint64_t next = (sum[i] & row[i]) | (half & carry);
    sum[i] = half ^ carry;
    carry = next;
  }
  for (size_t i = kRowDigits; i < kSquareDigits && carry != 0; ++i) {
    const uint64_t next = sum[i] & carry;
    sum[i] ^= carry;
    carry = next;
  }
}

uint64_t isAbove(const Numbers<kSquareDigits>& sum, int limit) {
  uint64_t above = 0, equal = ~uint64_t{0};
  for (size_t i = kSquareDigits; i-- > 0;) {
    const uint64_t digit = (limit >> i & 1) != 0 ? ~uint64_t{0} : 0;
    above |= equal & sum[i] & ~digit;
    equal &= ~(sum[i] ^ digit);
  }
  return above;
}

/// A row of a mask whose ends are repeated beyond the frame's border: what stands at the border
/// most likely goes on behind it.
class RepeatedRow {
 public:
  RepeatedRow(const BitMask& mask, int y)
      : row_(mask.row(y)),
        last_(mask.wordsPerRow() - 1),
        left_(mask.at(0, y) ? ~uint64_t{0} : 0),
        right_(mask.at(mask.width() - 1, y) ? ~uint64_t{0} : 0),
        beyond_(right_ & ~mask.columnsOf(last_)) {}

  [[nodiscard]] uint64_t word(int i) const {
    if (i < 0) return left_;
    if (i > last_) return right_;
    return i == last_ ? row_[i] | beyond_ : row_[i];
  }

 private:
  const uint64_t* row_;
  int last_;
  uint64_t left_, right_, beyond_;
};

/// Number of set pixels among x − radius … x + radius of a row.
void countAlongRow(const BitMask& mask, int y, int radius, uint64_t* out) {
  const RepeatedRow row(mask, y);
  for (int word = 0; word < mask.wordsPerRow(); ++word, out += kRowDigits) {
    const uint64_t before = row.word(word - 1), here = row.word(word), after = row.word(word + 1);
    Numbers<kRowDigits> sum{here};
    if ((before | here | after) != 0)
      for (int i = 1; i <= radius; ++i) {
        addBit(sum, here << i | before >> (kWordColumns - i));
        addBit(sum, here >> i | after << (kWordColumns - i));
      }
    for (size_t i = 0; i < kRowDigits; ++i) out[i] = sum[i];
  }
}

void majorityRow(const Image<uint64_t>& counts, int y, int radius, int limit, uint64_t* out) {
  const int words = counts.width() / static_cast<int>(kRowDigits);
  for (int word = 0; word < words; ++word) {
    Numbers<kSquareDigits> sum{};
    uint64_t any = 0;
    for (int i = y - radius; i <= y + radius; ++i) {
      const int from = std::clamp(i, 0, counts.height() - 1);
      const uint64_t* row = counts.row(from) + static_cast<size_t>(word) * kRowDigits;
      const uint64_t isCounted = row[0] | row[1] | row[2] | row[3];
      any |= isCounted;
      if (isCounted != 0) addRow(sum, row);
    }
    out[word] = any == 0 ? 0 : isAbove(sum, limit);
  }
}

}  // namespace

void keepMajority(const BitMask& mask, int radius, int share, const Executor& executor,
                  CleaningScratch& scratch, BitMask& out) {
  assert(radius >= 1 && radius <= 7 && mask.size() == out.size());
  const int words = mask.wordsPerRow();
  scratch.counts.resize({words * static_cast<int>(kRowDigits), mask.height()});
  const int side = 2 * radius + 1;
  const int limit = side * side * share / 256;
  executor.forRows(mask.height(), [&](int first, int last) {
    for (int y = first; y < last; ++y) countAlongRow(mask, y, radius, scratch.counts.row(y));
  });
  executor.forRows(mask.height(), [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      majorityRow(scratch.counts, y, radius, limit, out.row(y));
      out.row(y)[words - 1] &= out.columnsOf(words - 1);
    }
  });
}

void dropSmallParts(BitMask& mask, uint32_t leastPx, CleaningScratch& scratch) {
  findComponents(mask, true, Connectivity::Four, scratch.components);
  const std::vector<Component>& list = scratch.components.list;
  scratch.isChosen.resize(list.size());
  for (size_t i = 0; i < list.size(); ++i) scratch.isChosen[i] = list[i].areaPx < leastPx;
  paintComponents(scratch.components, scratch.isChosen, false, mask);
}

void fillHoles(BitMask& mask, uint32_t mostPx, CleaningScratch& scratch) {
  findComponents(mask, false, Connectivity::Four, scratch.components);
  const std::vector<Component>& list = scratch.components.list;
  scratch.isChosen.resize(list.size());
  for (size_t i = 0; i < list.size(); ++i) {
    const Box& box = list[i].box;
    const bool touchesBorder =
        box.x == 0 || box.y == 0 || box.right() == mask.width() || box.bottom() == mask.height();
    scratch.isChosen[i] = !touchesBorder && list[i].areaPx <= mostPx;
  }
  paintComponents(scratch.components, scratch.isChosen, true, mask);
}

void keepSupported(BitMask& mask, const BitMask& strong, uint32_t leastPx,
                   CleaningScratch& scratch) {
  assert(mask.size() == strong.size());
  Components& found = scratch.components;
  findComponents(mask, true, Connectivity::Eight, found);
  // The area is not needed any more: it takes the count.
  for (Component& component : found.list) component.areaPx = 0;
  for (const Run& run : found.runs) {
    const int count = countColumns(strong.row(run.y), run.begin, run.end);
    found.list[run.component].areaPx += static_cast<uint32_t>(count);
  }
  scratch.isChosen.resize(found.list.size());
  for (size_t i = 0; i < found.list.size(); ++i)
    scratch.isChosen[i] = found.list[i].areaPx < leastPx;
  paintComponents(found, scratch.isChosen, false, mask);
}

void fillLines(ImageView<const uint8_t> edges, const Box& box, CleaningScratch& scratch,
               ImageView<uint8_t> out) {
  assert(edges.size == out.size);
  const auto width = static_cast<size_t>(box.width);
  scratch.firstRow.assign(width, box.bottom());
  scratch.lastRow.assign(width, box.y - 1);
  for (int y = box.y; y < box.bottom(); ++y) {
    const uint8_t* row = edges.row(y) + box.x;
    for (size_t x = 0; x < width; ++x) {
      if (row[x] == 0) continue;
      scratch.firstRow[x] = std::min(scratch.firstRow[x], y);
      scratch.lastRow[x] = y;
    }
  }
  for (int y = box.y; y < box.bottom(); ++y) {
    const uint8_t* row = edges.row(y) + box.x;
    size_t begin = 0, end = width;
    while (begin < end && row[begin] == 0) ++begin;
    while (end > begin && row[end - 1] == 0) --end;
    uint8_t* to = out.row(y) + box.x;
    for (size_t x = begin; x < end; ++x)
      if (scratch.firstRow[x] <= y && y <= scratch.lastRow[x]) to[x] = 255;
  }
}

}  // namespace rg
