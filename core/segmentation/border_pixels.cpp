// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/segmentation/border_pixels.hpp"

#include "core/segmentation/side_colours.hpp"

#include <algorithm>

namespace rg::segmentation {
namespace {

constexpr uint32_t kReciprocals[] = {0,
                                     reciprocal(1),
                                     reciprocal(2),
                                     reciprocal(3),
                                     reciprocal(4),
                                     reciprocal(5),
                                     reciprocal(6),
                                     reciprocal(7),
                                     reciprocal(8),
                                     reciprocal(9)};

uint8_t meanOf(uint64_t packed, int channel) {
  return packedMean(packed, channel, kReciprocals[packedCount(packed)]);
}

constexpr uint64_t kApart = uint64_t{1} << 16;  // Of the keys of cells in scope apart.

uint16_t idOf(uint64_t key) {
  return static_cast<uint16_t>(key & 0xFFFF);
}

}  // namespace

void BorderPixels::refine(const ColourCells& cells, ImageView<const uint16_t> cellIds,
                          const Executor& executor, ImageView<uint16_t> ids) {
  constexpr int kBandRows = 16;
  pixels_ = cells.pixels();
  cells_ = cells.cells();
  cellIds_ = cellIds;
  ids_ = ids;
  scratch_.resize(static_cast<size_t>(executor.threads()));
  const int height = cells_.size.height;
  executor.forEach((height + kBandRows - 1) / kBandRows, [&](int band, int thread) {
    Scratch& scratch = scratch_[static_cast<size_t>(thread)];
    prepare(scratch);
    const int first = band * kBandRows, last = std::min(first + kBandRows, height);
    const auto line = [&](int row) -> CellLine& {
      return scratch.lines[static_cast<size_t>((row + 3) % 3)];
    };
    pack(first - 1, line(first - 1));
    pack(first, line(first));
    for (int row = first; row < last; ++row) {
      pack(row + 1, line(row + 1));
      refineRow(row, scratch);
    }
  });
}

void BorderPixels::prepare(Scratch& scratch) const {
  const auto count = static_cast<size_t>(cells_.size.width);
  const size_t padded = count * static_cast<size_t>(cells_.sidePx);
  for (CellLine& line : scratch.lines)
    for (auto* words : {&line.keys, &line.colours, &line.pures})
      words->assign(count + simd::kSideLanes + 1, 0);
  for (auto* sums : {&scratch.own, &scratch.other, &scratch.others})
    sums->resize(count + simd::kSideLanes - 1);
  scratch.ids.resize(count);
  for (auto& colours : scratch.colours) colours.resize(count);
  for (auto& colours : scratch.wide) colours.resize(padded);
  for (auto* ids : {&scratch.wideOwn, &scratch.wideOther}) ids->resize(padded);
}

void BorderPixels::pack(int cellRow, CellLine& line) const {
  const auto width = static_cast<size_t>(cells_.size.width);
  if (cellRow < 0 || cellRow >= cells_.size.height) {
    std::fill(line.keys.begin(), line.keys.end(), 0u);
    return;
  }
  const uint16_t* ids = cellIds_.row(cellRow);
  simd::packCells({cells_.colours[0].row(cellRow), cells_.colours[1].row(cellRow),
                   cells_.colours[2].row(cellRow), cells_.ranges.row(cellRow), ids},
                  cells_.size.width, uint8_t{kOneColour}, line.keys.data() + 1,
                  line.colours.data() + 1, line.pures.data() + 1);
  if (cells_.scope.data == nullptr) return;
  const uint8_t* scope = cells_.scope.row(cellRow);
  for (size_t x = 0; x < width; ++x)
    if (ids[x] != 0 && scope[x] != kInScope) line.keys[x + 1] |= kApart;
}

void BorderPixels::refineRow(int cellRow, Scratch& scratch) const {
  const auto line = [&](int row) { return scratch.lines[static_cast<size_t>(row % 3)].cells(); };
  const simd::CellRows lines{line(cellRow + 2), line(cellRow), line(cellRow + 1)};
  simd::findSides(lines, cells_.size.width,
                  {scratch.own.data(), scratch.other.data(), scratch.others.data()});
  comparePairs(cellRow, scratch);
  for (int x = 0; x < cells_.size.width; ++x)
    if (scratch.others[static_cast<size_t>(x)] == simd::kManySides) refineCell(x, cellRow, lines);
  if (pixels_.scope.data == nullptr) return;
  const int top = cellRow * cells_.sidePx;
  for (int y = top; y < std::min(top + cells_.sidePx, pixels_.size.height); ++y) clearOutOfScope(y);
}

// Most cells at a border have one neighbour region, so a row of these goes through vectors. Where
// there is no choice both regions are the own one.
void BorderPixels::comparePairs(int cellRow, Scratch& scratch) const {
  const uint16_t* own = cellIds_.row(cellRow);
  const auto width = static_cast<size_t>(cells_.size.width);
  std::copy_n(own, width, scratch.ids.begin());
  for (auto& colours : scratch.colours) std::fill(colours.begin(), colours.end(), uint8_t{0});
  bool isDivided = false;
  for (size_t x = 0; x < width; ++x) {
    if (scratch.others[x] == 0 || scratch.others[x] == simd::kManySides) continue;
    uint8_t colours[2][3];
    for (int c = 0; c < 3; ++c) {
      colours[0][c] = meanOf(scratch.own[x], c);
      colours[1][c] = meanOf(scratch.other[x], c);
    }
    if (farthestOf(colours[0], colours[1]) <= kAlikeColours) continue;
    scratch.ids[x] = idOf(scratch.others[x]);
    for (size_t k = 0; k < 6; ++k) scratch.colours[k][x] = colours[k / 3][k % 3];
    isDivided = true;
  }
  chooseRows(cellRow, isDivided, scratch);
}

void BorderPixels::chooseRows(int cellRow, bool isDivided, Scratch& scratch) const {
  const int side = cells_.sidePx, count = cells_.size.width, width = pixels_.size.width;
  const int top = cellRow * side, bottom = std::min(top + side, pixels_.size.height);
  simd::repeatRow(cellIds_.row(cellRow), count, side, scratch.wideOwn.data());
  if (!isDivided) {
    for (int y = top; y < bottom; ++y) std::copy_n(scratch.wideOwn.data(), width, ids_.row(y));
    return;
  }
  simd::repeatRow(scratch.ids.data(), count, side, scratch.wideOther.data());
  simd::PixelSides sides{
      {}, {}, {}, scratch.wideOwn.data(), scratch.wideOther.data(), uint8_t{kSideMargin}};
  for (size_t c = 0; c < 3; ++c) {
    sides.own[c] = scratch.wide[c].data();
    sides.other[c] = scratch.wide[c + 3].data();
  }
  for (size_t k = 0; k < scratch.wide.size(); ++k)
    simd::repeatRow(scratch.colours[k].data(), count, side, scratch.wide[k].data());
  for (int y = top; y < bottom; ++y) {
    for (size_t c = 0; c < 3; ++c) sides.pixels[c] = pixels_.colours[c].row(y);
    simd::chooseSides(sides, width, ids_.row(y));
  }
}

void BorderPixels::collect(int cellX, const simd::CellRows& lines, Found& found) {
  const uint64_t own = lines.middle.keys[cellX];
  // A cell of several colours says nothing of its own region.
  found.ids[0] = idOf(own);
  found.all[0] = found.pure[0] = lines.middle.pures[cellX];
  for (const simd::PackedCells& line : {lines.above, lines.middle, lines.below}) {
    for (int x = cellX - 1; x <= cellX + 1; ++x) {
      const uint64_t key = line.keys[x];
      if (key == 0 || ((key ^ own) & kApart) != 0) continue;
      if (x == cellX && line.keys == lines.middle.keys) continue;
      int k = 0;
      while (k < found.count && found.ids[k] != idOf(key)) ++k;
      if (k == found.count) {
        found.ids[k] = idOf(key);
        found.all[k] = found.pure[k] = 0;
        ++found.count;
      }
      found.all[k] += line.colours[x];
      found.pure[k] += line.pures[x];
    }
  }
  if (found.all[0] == 0) found.all[0] = lines.middle.colours[cellX];
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

void BorderPixels::refineCell(int cellX, int cellY, const simd::CellRows& lines) const {
  Found found;
  Candidates candidates;
  collect(cellX, lines, found);
  choose(found, candidates);
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
  cell.margin = kSideMargin;
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

}  // namespace rg::segmentation
