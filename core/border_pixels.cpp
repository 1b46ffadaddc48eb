// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/border_pixels.hpp"

#include "core/pixel.hpp"

#include <algorithm>
#include <cstring>

namespace rg {
namespace {

constexpr int kAlikeColours = 8;  // Largest difference of a channel.
constexpr uint16_t kMargin = 6;   // Noise shall not decide: what is nearly as near stays.

}  // namespace

void BorderPixels::refine(const ColourCells& cells, ImageView<const uint16_t> cellIds,
                          const Executor& executor, ImageView<uint16_t> ids) {
  pixels_ = cells.pixels();
  cells_ = cells.cells();
  cellIds_ = cellIds;
  ids_ = ids;
  scratch_.resize(static_cast<size_t>(executor.threads()));
  executor.forEach(cells_.size.height, [&](int cellRow, int thread) {
    spread(cellRow);
    refineRow(cellRow, scratch_[static_cast<size_t>(thread)]);
  });
}

/// Gives every pixel the region of its cell.
void BorderPixels::spread(int cellRow) const {
  const int side = cells_.sidePx, width = pixels_.size.width;
  const int top = cellRow * side, bottom = std::min(top + side, pixels_.size.height);
  const uint16_t* from = cellIds_.row(cellRow);
  uint16_t* to = ids_.row(top);
  const int whole = width / side;
  for (int x = 0; x < whole; ++x) std::fill_n(to + x * side, side, from[x]);
  for (int x = whole * side; x < width; ++x) to[x] = from[whole];
  for (int y = top + 1; y < bottom; ++y) std::copy_n(to, width, ids_.row(y));
}

void BorderPixels::refineRow(int cellRow, Scratch& scratch) const {
  const int width = cells_.size.width, last = cells_.size.height - 1;
  const uint16_t *above = cellIds_.row(std::max(cellRow - 1, 0)), *own = cellIds_.row(cellRow);
  const uint16_t* below = cellIds_.row(std::min(cellRow + 1, last));
  for (auto* extremes : {&scratch.least, &scratch.most})
    extremes->resize(static_cast<size_t>(width) + 2);
  uint16_t *least = scratch.least.data() + 1, *most = scratch.most.data() + 1;
  for (int x = 0; x < width; ++x) {
    least[x] = std::min({above[x], own[x], below[x]});
    most[x] = std::max({above[x], own[x], below[x]});
  }
  least[-1] = least[0], most[-1] = most[0];
  least[width] = least[width - 1], most[width] = most[width - 1];
  for (int x = 0; x < width; ++x)
    if (own[x] != 0 && std::min({least[x - 1], least[x], least[x + 1]}) !=
                           std::max({most[x - 1], most[x], most[x + 1]}))
      refineCell(x, cellRow, scratch);
  if (pixels_.scope.data == nullptr) return;
  const int top = cellRow * cells_.sidePx;
  for (int y = top; y < std::min(top + cells_.sidePx, pixels_.size.height); ++y) clearOutOfScope(y);
}

void BorderPixels::collectCandidates(int cellX, int cellY, simd::NearestColours& cell) const {
  uint32_t sums[3][simd::kMostColours] = {}, cells[simd::kMostColours] = {};
  cell.ids[0] = cellIds_.at(cellX, cellY);
  cell.count = 1;
  const Box around = intersect({cellX - 1, cellY - 1, 3, 3}, boundsOf(cells_.size));
  const bool hasScope = cells_.scope.data != nullptr;
  const uint8_t scope = hasScope ? cells_.scope.at(cellX, cellY) : kInScope;
  for (int y = around.y; y < around.bottom(); ++y)
    for (int x = around.x; x < around.right(); ++x) {
      const uint16_t id = cellIds_.at(x, y);
      if (id == 0 || (x == cellX && y == cellY) || (hasScope && cells_.scope.at(x, y) != scope))
        continue;
      int k = 0;
      while (k < cell.count && cell.ids[k] != id) ++k;
      if (k == cell.count) cell.ids[cell.count++] = id;
      for (size_t c = 0; c < 3; ++c) sums[c][k] += cells_.colours[c].at(x, y);
      ++cells[k];
    }
  if (cells[0] == 0) {
    cells[0] = 1;
    for (size_t c = 0; c < 3; ++c) sums[c][0] = cells_.colours[c].at(cellX, cellY);
  }
  int kept = 0;
  for (int k = 0; k < cell.count; ++k) {
    int farthest = 0;
    for (size_t c = 0; c < 3; ++c) {
      const auto mean = static_cast<uint8_t>((sums[c][k] + cells[k] / 2) / cells[k]);
      cell.candidates[c][kept] = mean;
      farthest = std::max(farthest, absDiff(mean, cell.candidates[c][0]));
    }
    cell.ids[kept] = cell.ids[k];
    if (k == 0 || farthest > kAlikeColours) ++kept;
  }
  cell.count = kept;
}

void BorderPixels::refineCell(int cellX, int cellY, Scratch& scratch) const {
  constexpr int kLanes = 16;
  simd::NearestColours& cell = scratch.cell;
  collectCandidates(cellX, cellY, cell);
  if (cell.count < 2) return;
  const int side = cells_.sidePx;
  const Box box = intersect({cellX * side, cellY * side, side, side}, boundsOf(pixels_.size));
  for (int y = 0; y < box.height; ++y)
    for (size_t c = 0; c < 3; ++c)
      std::memcpy(cell.colours[c] + y * side, pixels_.colours[c].row(box.y + y) + box.x,
                  static_cast<size_t>(box.width));
  cell.pixels = (side * side + kLanes - 1) / kLanes * kLanes;
  cell.margin = kMargin;
  simd::chooseColours(cell, scratch.ids);
  for (int y = 0; y < box.height; ++y)
    std::copy_n(scratch.ids + y * side, box.width, ids_.row(box.y + y) + box.x);
}

void BorderPixels::clearOutOfScope(int y) const {
  const uint8_t* scope = pixels_.scope.row(y);
  uint16_t* ids = ids_.row(y);
  for (int x = 0; x < pixels_.size.width; ++x) ids[x] = isInScope(scope[x]) ? ids[x] : uint16_t{0};
}

}  // namespace rg
