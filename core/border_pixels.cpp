// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/border_pixels.hpp"

#include "core/pixel.hpp"

#include <algorithm>

namespace rg {
namespace {

constexpr int kLaneBits = 16;

/// ⌈2^16 / n⌉: exact divisors of sums of up to nine bytes.
constexpr uint32_t kReciprocals[] = {0, 65536, 32768, 21846, 16384, 13108, 10923, 9363, 8192, 7282};

uint8_t meanOf(uint64_t packed, int channel) {
  const auto count = static_cast<uint32_t>(packed >> (3 * kLaneBits));
  const auto sum = static_cast<uint32_t>(packed >> (channel * kLaneBits) & 0xFFFF);
  return static_cast<uint8_t>((sum + count / 2) * kReciprocals[count] >> 16);
}

constexpr int kOneColour = 12;    // Largest difference of a channel within a pure cell.
constexpr int kAlikeColours = 8;  // Largest difference of a channel.
constexpr uint8_t kMargin = 5;    // Noise shall not decide: what is nearly as near stays.

int farthestOf(const uint8_t* a, const uint8_t* b) {
  return std::max({absDiff(a[0], b[0]), absDiff(a[1], b[1]), absDiff(a[2], b[2])});
}

/// Whether a colour is what pixels of two others mix to.
bool lies(const uint8_t* colour, const uint8_t* one, const uint8_t* other) {
  if (farthestOf(one, other) <= kAlikeColours) return false;
  for (int c = 0; c < 3; ++c)
    if (absDiff(colour[c], one[c]) + absDiff(colour[c], other[c]) >
        absDiff(one[c], other[c]) + kAlikeColours)
      return false;
  return true;
}

}  // namespace

void BorderPixels::refine(const ColourCells& cells, ImageView<const uint16_t> cellIds,
                          const Executor& executor, ImageView<uint16_t> ids) {
  pixels_ = cells.pixels();
  cells_ = cells.cells();
  cellIds_ = cellIds;
  ids_ = ids;
  packed_.resize(cells_.size);
  executor.forRows(cells_.size.height, [&](int first, int last) {
    for (int row = first; row < last; ++row) pack(row);
  });
  scratch_.resize(static_cast<size_t>(executor.threads()));
  executor.forEach(cells_.size.height, [&](int cellRow, int thread) {
    spread(cellRow);
    refineRow(cellRow, scratch_[static_cast<size_t>(thread)]);
  });
}

void BorderPixels::pack(int cellRow) {
  const uint8_t *red = cells_.colours[0].row(cellRow), *green = cells_.colours[1].row(cellRow);
  const uint8_t *blue = cells_.colours[2].row(cellRow), *ranges = cells_.ranges.row(cellRow);
  PackedCell* to = packed_.row(cellRow);
  for (int x = 0; x < cells_.size.width; ++x) {
    const uint64_t colour = uint64_t{1} << (3 * kLaneBits) | uint64_t{blue[x]} << (2 * kLaneBits) |
                            uint64_t{green[x]} << kLaneBits | red[x];
    to[x] = {colour, ranges[x] <= kOneColour ? colour : 0};
  }
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
      refineCell(x, cellRow);
  if (pixels_.scope.data == nullptr) return;
  const int top = cellRow * cells_.sidePx;
  for (int y = top; y < std::min(top + cells_.sidePx, pixels_.size.height); ++y) clearOutOfScope(y);
}

void BorderPixels::collect(int cellX, int cellY, Candidates& candidates) const {
  Found found;
  const uint16_t own = cellIds_.at(cellX, cellY);
  const PackedCell& centre = packed_.at(cellX, cellY);
  const bool hasScope = cells_.scope.data != nullptr;
  const uint8_t ownScope = hasScope ? cells_.scope.at(cellX, cellY) : kInScope;
  // A cell of several colours says nothing of its own region.
  found.ids[0] = own;
  found.all[0] = found.pure[0] = centre.pure;
  const int left = std::max(cellX - 1, 0), right = std::min(cellX + 1, cells_.size.width - 1);
  for (int y = std::max(cellY - 1, 0); y <= std::min(cellY + 1, cells_.size.height - 1); ++y) {
    const uint16_t* ids = cellIds_.row(y);
    const PackedCell* packed = packed_.row(y);
    const uint8_t* scope = hasScope ? cells_.scope.row(y) : nullptr;
    for (int x = left; x <= right; ++x) {
      if (x == cellX && y == cellY) continue;
      const uint16_t id = ids[x];
      if (id == 0 || (scope != nullptr && scope[x] != ownScope)) continue;
      int k = 0;
      while (k < found.count && found.ids[k] != id) ++k;
      if (k == found.count) {
        found.ids[k] = id;
        found.all[k] = found.pure[k] = 0;
        ++found.count;
      }
      found.all[k] += packed[x].colour;
      found.pure[k] += packed[x].pure;
    }
  }
  if (found.all[0] == 0) found.all[0] = centre.colour;
  choose(found, candidates);
}

void BorderPixels::choose(const Found& found, Candidates& candidates) {
  uint8_t colours[simd::kMostColours][3];
  for (int k = 0; k < found.count; ++k)
    for (int c = 0; c < 3; ++c)
      colours[k][c] = meanOf(found.pure[k] != 0 ? found.pure[k] : found.all[k], c);
  const auto isBetween = [&](int k) {
    for (int i = 0; i < found.count; ++i)
      for (int j = 0; j < found.count && found.pure[i] != 0; ++j)
        if (j != k && lies(colours[k], colours[i], colours[j])) return true;
    return false;
  };
  simd::CellColours& cell = candidates.cell;
  cell.count = 0;
  for (int k = 0; k < found.count; ++k) {
    if (found.pure[k] == 0 && found.count > 2 && isBetween(k)) continue;
    if (cell.count > 0 && farthestOf(colours[k], cell.candidates[0]) <= kAlikeColours) continue;
    std::copy_n(colours[k], 3, cell.candidates[cell.count]);
    candidates.ids[cell.count++] = found.ids[k];
  }
}

void BorderPixels::refineCell(int cellX, int cellY) const {
  Candidates candidates;
  collect(cellX, cellY, candidates);
  simd::CellColours& cell = candidates.cell;
  const bool isMoved = candidates.ids[0] != cellIds_.at(cellX, cellY);
  if (cell.count < 2 && !isMoved) return;
  const int side = cells_.sidePx;
  const Box box = intersect({cellX * side, cellY * side, side, side}, boundsOf(pixels_.size));
  for (size_t c = 0; c < 3; ++c) {
    cell.pixels[c] = pixels_.colours[c].row(box.y) + box.x;
    cell.strides[c] = pixels_.colours[c].strideBytes;
  }
  cell.side = side;
  cell.rows = box.height;
  cell.margin = kMargin;
  uint8_t choices[64];
  if (!simd::chooseColours(cell, choices) && !isMoved) return;
  for (int y = 0; y < box.height; ++y)
    for (int x = 0; x < box.width; ++x)
      ids_.row(box.y + y)[box.x + x] = candidates.ids[choices[y * side + x]];
}

void BorderPixels::clearOutOfScope(int y) const {
  const uint8_t* scope = pixels_.scope.row(y);
  uint16_t* ids = ids_.row(y);
  for (int x = 0; x < pixels_.size.width; ++x) ids[x] = isInScope(scope[x]) ? ids[x] : uint16_t{0};
}

}  // namespace rg
