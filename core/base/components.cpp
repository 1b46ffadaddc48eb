// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/components.hpp"

#include "core/base/forest.hpp"

#include <algorithm>

namespace rg {
namespace {

/// First column from x on whose bit differs from those of `other`, which is all ones or zero.
int findColumn(const uint64_t* row, int x, int width, uint64_t other) {
  if (x >= width) return width;
  int word = x / kWordColumns;
  const int end = (width + kWordColumns - 1) / kWordColumns;
  uint64_t bits = (row[word] ^ other) & (~uint64_t{0} << (x % kWordColumns));
  while (bits == 0) {
    // Most stretches are long: four words at a time while nothing is found.
    while (word + 4 < end && ((row[word + 1] ^ other) | (row[word + 2] ^ other) |
                              (row[word + 3] ^ other) | (row[word + 4] ^ other)) == 0)
      word += 4;
    if (++word >= end) return width;
    bits = row[word] ^ other;
  }
  return std::min(width, word * kWordColumns + std::countr_zero(bits));
}

/// Joins the runs [current, end) of one row with those of the row above that touch them.
void joinRows(Components& found, size_t above, size_t current, size_t end, int reach) {
  const std::vector<ComponentRun>& runs = found.runs;
  const size_t aboveEnd = current;
  for (size_t i = current; i < end; ++i) {
    while (above < aboveEnd && runs[above].end + reach <= runs[i].begin) ++above;
    for (size_t j = above; j < aboveEnd && runs[j].begin < runs[i].end + reach; ++j)
      join(found.parents, static_cast<uint32_t>(i), static_cast<uint32_t>(j));
  }
}

void collectRuns(const BitMask& mask, bool value, Connectivity connectivity, Components& found) {
  const uint64_t unwanted = value ? 0 : ~uint64_t{0};
  const int reach = connectivity == Connectivity::Eight ? 1 : 0;
  size_t above = 0;
  for (int y = 0; y < mask.height(); ++y) {
    const uint64_t* row = mask.row(y);
    const size_t current = found.runs.size();
    for (int x = findColumn(row, 0, mask.width(), unwanted); x < mask.width();) {
      const int end = findColumn(row, x, mask.width(), ~unwanted);
      found.parents.push_back(static_cast<uint32_t>(found.runs.size()));
      found.runs.push_back({runOf(y, x, end), 0});
      x = findColumn(row, end, mask.width(), unwanted);
    }
    joinRows(found, above, current, found.runs.size(), reach);
    above = current;
  }
}

}  // namespace

void findComponents(const BitMask& mask, bool value, Connectivity connectivity, Components& found) {
  found.runs.clear();
  found.parents.clear();
  found.list.clear();
  collectRuns(mask, value, connectivity, found);
  for (uint32_t i = 0; i < found.runs.size(); ++i) {
    ComponentRun& run = found.runs[i];
    // A parent lies before its run, so it has its number already.
    const uint32_t parent = found.parents[i];
    const Box box{run.begin, run.y, run.end - run.begin, 1};
    if (parent == i) {
      run.component = static_cast<uint32_t>(found.list.size());
      found.list.push_back(
          {box, 0, static_cast<uint32_t>(int64_t{run.y} * mask.width() + run.begin)});
    } else {
      run.component = found.runs[parent].component;
    }
    Component& component = found.list[run.component];
    component.box = unite(component.box, box);
    component.areaPx += static_cast<uint32_t>(run.end - run.begin);
  }
}

void findComponents(ImageView<const uint8_t> mask, uint8_t value, Connectivity connectivity,
                    Components& found) {
  packEqual(mask, value, found.bits);
  findComponents(found.bits, true, connectivity, found);
}

void paintComponents(const Components& found, std::span<const uint8_t> isChosen, bool value,
                     BitMask& mask) {
  for (const ComponentRun& run : found.runs)
    if (isChosen[run.component] != 0) setColumns(mask.row(run.y), run.begin, run.end, value);
}

void paintComponents(const Components& found, std::span<const uint8_t> isChosen, uint8_t value,
                     ImageView<uint8_t> mask) {
  for (const ComponentRun& run : found.runs)
    if (isChosen[run.component] != 0)
      std::fill(mask.row(run.y) + run.begin, mask.row(run.y) + run.end, value);
}

}  // namespace rg
