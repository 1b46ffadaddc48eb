// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/mask_cleaning.hpp"

#include "core/pixel.hpp"

#include <algorithm>
#include <cassert>
#include <cstring>

namespace rg {
namespace {

/// out[x] = number of set pixels among x − radius … x + radius of a row.
void countAlongRow(const uint8_t* row, int width, int radius, uint8_t* out) {
  int count = 0;
  for (int x = 0; x < std::min(radius, width); ++x) count += row[x] != 0;
  for (int x = 0; x < width; ++x) {
    if (x + radius < width) count += row[x + radius] != 0;
    if (x > radius) count -= row[x - radius - 1] != 0;
    out[x] = static_cast<uint8_t>(count);
  }
}

void majorityRow(ImageView<const uint8_t> counts, int y, int radius, int limit, uint8_t* out) {
  const int width = counts.width();
  std::memset(out, 0, static_cast<size_t>(width));
  // At most 15 * 15 = 225 pixels: the sum of a column fits a byte.
  for (int i = std::max(0, y - radius); i <= std::min(counts.height() - 1, y + radius); ++i) {
    const uint8_t* row = counts.row(i);
    for (int x = 0; x < width; ++x) out[x] = static_cast<uint8_t>(out[x] + row[x]);
  }
  for (int x = 0; x < width; ++x) out[x] = out[x] > limit ? 255 : 0;
}

}  // namespace

void keepMajority(ImageView<const uint8_t> mask, int radius, int share, const Executor& executor,
                  CleaningScratch& scratch, ImageView<uint8_t> out) {
  assert(radius >= 1 && radius <= 7 && mask.size == out.size);
  scratch.counts.resize(mask.size);
  const int side = 2 * radius + 1;
  const int limit = side * side * share / 256;
  executor.forRows(mask.height(), [&](int first, int last) {
    for (int y = first; y < last; ++y)
      countAlongRow(mask.row(y), mask.width(), radius, scratch.counts.row(y));
  });
  executor.forRows(mask.height(), [&](int first, int last) {
    for (int y = first; y < last; ++y) majorityRow(scratch.counts, y, radius, limit, out.row(y));
  });
}

void dropSmallParts(ImageView<uint8_t> mask, uint32_t leastPx, CleaningScratch& scratch) {
  findComponents(mask, 255, Connectivity::Four, scratch.components);
  const std::vector<Component>& list = scratch.components.list;
  scratch.isChosen.resize(list.size());
  for (size_t i = 0; i < list.size(); ++i) scratch.isChosen[i] = list[i].areaPx < leastPx;
  paintComponents(scratch.components, scratch.isChosen, 0, mask);
}

void fillHoles(ImageView<uint8_t> mask, uint32_t mostPx, CleaningScratch& scratch) {
  findComponents(mask, 0, Connectivity::Four, scratch.components);
  const std::vector<Component>& list = scratch.components.list;
  scratch.isChosen.resize(list.size());
  for (size_t i = 0; i < list.size(); ++i) {
    const Box& box = list[i].box;
    const bool touchesBorder =
        box.x == 0 || box.y == 0 || box.right() == mask.width() || box.bottom() == mask.height();
    scratch.isChosen[i] = !touchesBorder && list[i].areaPx <= mostPx;
  }
  paintComponents(scratch.components, scratch.isChosen, 255, mask);
}

void keepSupported(ImageView<uint8_t> mask, ImageView<const uint8_t> strong, uint32_t leastPx,
                   CleaningScratch& scratch) {
  assert(mask.size == strong.size);
  Components& found = scratch.components;
  findComponents(mask, 255, Connectivity::Eight, found);
  // The area is not needed any more: it takes the count.
  for (Component& component : found.list) component.areaPx = 0;
  for (const Run& run : found.runs) {
    const uint8_t* row = strong.row(run.y);
    const auto count = std::count(row + run.begin, row + run.end, uint8_t{255});
    found.list[run.component].areaPx += static_cast<uint32_t>(count);
  }
  scratch.isChosen.resize(found.list.size());
  for (size_t i = 0; i < found.list.size(); ++i)
    scratch.isChosen[i] = found.list[i].areaPx < leastPx;
  paintComponents(found, scratch.isChosen, 0, mask);
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
