// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/inner_pixels.hpp"

#include <algorithm>

namespace rg {
namespace {

constexpr int kMostTasks = 8;

/// Clears what differs from its neighbour `distance` columns away, on either side.
void clearAcross(const uint16_t* labels, int width, int distance, uint16_t* inner) {
  for (int x = 0; x + distance < width; ++x)
    inner[x] = labels[x] == labels[x + distance] ? inner[x] : kNoRegion;
  for (int x = distance; x < width; ++x)
    inner[x] = labels[x] == labels[x - distance] ? inner[x] : kNoRegion;
}

void clearDown(const uint16_t* labels, const uint16_t* other, int width, uint16_t* inner) {
  for (int x = 0; x < width; ++x) inner[x] = labels[x] == other[x] ? inner[x] : kNoRegion;
}

void findInnerRow(ImageView<const uint16_t> labels, int y, uint16_t* inner) {
  const uint16_t* row = labels.row(y);
  std::copy_n(row, labels.width(), inner);
  for (int distance = 1; distance <= kBorderReach; ++distance) {
    clearAcross(row, labels.width(), distance, inner);
    if (y >= distance) clearDown(row, labels.row(y - distance), labels.width(), inner);
    if (y + distance < labels.height())
      clearDown(row, labels.row(y + distance), labels.width(), inner);
  }
}

}  // namespace

void InnerPixels::find(ImageView<const uint16_t> labels, std::span<const Region> regions,
                       const Executor& executor) {
  ids_.resize(labels.size);
  const int tasks = std::min(executor.threads(), kMostTasks);
  counts_.resize(static_cast<size_t>(tasks));
  executor.forEach(tasks, [&](int task) {
    std::vector<uint32_t>& counts = counts_[static_cast<size_t>(task)];
    counts.assign(regions.size() + 1, 0);
    const int last = labels.height() * (task + 1) / tasks;
    for (int y = labels.height() * task / tasks; y < last; ++y) {
      uint16_t* row = ids_.row(y);
      findInnerRow(labels, y, row);
      for (int x = 0; x < labels.width(); ++x) ++counts[row[x]];
    }
  });
  takesAll_.assign(regions.size() + 1, 0);
  for (size_t i = 0; i < regions.size(); ++i) {
    uint32_t inner = 0;
    for (const auto& counts : counts_) inner += counts[i + 1];
    takesAll_[i + 1] = inner < kLeastInnerPx || inner < regions[i].areaPx / kInnerShare;
  }
  executor.forRows(labels.height(), [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      const uint16_t* all = labels.row(y);
      uint16_t* row = ids_.row(y);
      for (int x = 0; x < labels.width(); ++x)
        if (takesAll_[all[x]] != 0) row[x] = all[x];
    }
  });
}

}  // namespace rg
