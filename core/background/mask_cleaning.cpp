// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/mask_cleaning.hpp"

#include "core/background/background.hpp"
#include "core/simd/background/majority_rows.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdlib>
#include <cstring>

namespace rg::background {
namespace {

constexpr int kMostRadius = 7;
constexpr int kVectorWords = 8;  ///< Rows of words are handled by so many.

/// Rows of a mask whose ends are repeated beyond the frame's border: what stands at the border most
/// likely goes on behind it.
void repeatEnds(const BitMask& mask, int y, uint64_t* row) {
  const int words = mask.wordsPerRow();
  const uint64_t right = mask.at(mask.width() - 1, y) ? ~uint64_t{0} : 0;
  row[-1] = mask.at(0, y) ? ~uint64_t{0} : 0;
  std::copy_n(mask.row(y), words, row);
  row[words - 1] |= right & ~mask.columnsOf(words - 1);
  row[words] = right;
}

}  // namespace

void keepMajority(const BitMask& mask, int radius, int share, const Executor& executor,
                  CleaningScratch& scratch, BitMask& out) {
  assert(radius >= 1 && radius <= kMostRadius && mask.size() == out.size());
  const int words = (mask.wordsPerRow() + kVectorWords - 1) / kVectorWords * kVectorWords;
  const int height = mask.height(), side = 2 * radius + 1;
  const int limit = side * side * share / 256;
  scratch.repeated.resize({words + 2 * kVectorWords, height});
  scratch.counts.resize({words * static_cast<int>(kCountDigits), height});
  executor.forRows(height, [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      uint64_t* row = scratch.repeated.row(y) + kVectorWords;
      repeatEnds(mask, y, row);
      simd::countAlongRow(row, static_cast<size_t>(words), radius, scratch.counts.row(y));
    }
  });
  executor.forRows(height, [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      std::array<const uint64_t*, 2 * kMostRadius + 1> rows;
      for (int i = 0; i < side; ++i)
        rows[static_cast<size_t>(i)] =
            scratch.counts.row(std::clamp(y + i - radius, 0, height - 1));
      simd::compareSums({rows.data(), static_cast<size_t>(side)}, static_cast<size_t>(words), limit,
                        out.row(y));
      out.row(y)[mask.wordsPerRow() - 1] &= out.columnsOf(mask.wordsPerRow() - 1);
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
  for (const ComponentRun& run : found.runs) {
    const int count = countColumns(strong.row(run.y), run.begin, run.end);
    found.list[run.component].areaPx += static_cast<uint32_t>(count);
  }
  scratch.isChosen.resize(found.list.size());
  for (size_t i = 0; i < found.list.size(); ++i)
    scratch.isChosen[i] = found.list[i].areaPx < leastPx;
  paintComponents(found, scratch.isChosen, false, mask);
}

void paintForeground(const BitMask& mask, const BitMask& shadow, Point shift,
                     const Executor& executor, ImageView<uint8_t> out) {
  const int width = out.width(), height = out.height();
  const int from = std::max(0, shift.x), to = std::max(0, -shift.x);
  const int count = std::max(0, width - std::abs(shift.x));
  executor.forRows(height, [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      std::fill_n(out.row(y), width, kBackgroundPixel);
      const int row = y + shift.y;
      if (row < 0 || row >= height) continue;
      paintRow(mask, row, kForegroundPixel, out.row(y));
      paintRow(shadow, row, kShadowPixel, out.row(y));
      if (from != to) {
        std::memmove(out.row(y) + to, out.row(y) + from, static_cast<size_t>(count));
        std::fill(out.row(y), out.row(y) + to, kBackgroundPixel);
        std::fill(out.row(y) + to + count, out.row(y) + width, kBackgroundPixel);
      }
    }
  });
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

}  // namespace rg::background
