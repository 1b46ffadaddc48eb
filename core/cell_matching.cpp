// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/cell_matching.hpp"

#include "core/pixel.hpp"
#include "core/segmentation.hpp"

#include <algorithm>
#include <array>
#include <cstring>

namespace rg {
namespace {

constexpr int kFewPixels = 24;
constexpr int kMostSide = 2 * kMostReach + 1;
constexpr int kBlock = 16;  // Shifts matched at a time; columns are readable so far beyond.

using Cell = std::array<uint8_t, kCellPixels>;

/// The pixels of a part, row by row; the others and their mask are 0.
struct MaskedCell {
  alignas(16) Cell pixels{};
  alignas(16) Cell mask{};
};

MaskedCell cut(const CellPart& part, ImageView<const uint16_t> ids, ImageView<const uint8_t> luma) {
  MaskedCell cell;
  const int x0 = part.cellX * kCellSize, y0 = part.cellY * kCellSize;
  const int width = std::min(kCellSize, ids.width() - x0);
  const int height = std::min(kCellSize, ids.height() - y0);
  for (int y = 0; y < height; ++y) {
    const uint16_t* labels = ids.row(y0 + y) + x0;
    const uint8_t* pixels = luma.row(y0 + y) + x0;
    uint8_t* mask = cell.mask.data() + y * kCellSize;
    for (int x = 0; x < width; ++x) {
      mask[x] = labels[x] == part.label ? 0xFF : 0;
      cell.pixels[static_cast<size_t>(y * kCellSize + x)] = pixels[x] & mask[x];
    }
  }
  return cell;
}

// Two plain loops over 64 bytes in a row: compilers turn them into four SAD instructions.
void addWhole(const Cell& cell, const uint8_t* strip, int count, uint32_t* sums) {
  const Cell own = cell;
  for (int k = 0; k < count; ++k, strip += kCellSize) {
    int sum = 0;
    for (size_t i = 0; i < kCellPixels; ++i) sum += std::abs(own[i] - strip[i]);
    sums[k] += static_cast<uint32_t>(sum);
  }
}

void addMasked(const MaskedCell& cell, const uint8_t* strip, int count, uint32_t* sums) {
  const Cell own = cell.pixels, mask = cell.mask;
  for (int k = 0; k < count; ++k, strip += kCellSize) {
    int sum = 0;
    for (size_t i = 0; i < kCellPixels; ++i)
      sum += std::abs(own[i] - static_cast<uint8_t>(strip[i] & mask[i]));
    sums[k] += static_cast<uint32_t>(sum);
  }
}

/// Whole blocks, so that the loop over them has no remainder.
void addPixel(uint8_t pixel, const uint8_t* column, int blocks, uint16_t* sums) {
  for (; blocks > 0; --blocks, column += kBlock, sums += kBlock)
    for (int k = 0; k < kBlock; ++k) {
      const uint8_t before = column[k];
      const auto d = static_cast<uint8_t>(pixel > before ? pixel - before : before - pixel);
      sums[k] = static_cast<uint16_t>(sums[k] + d);
    }
}

/// Sums of up to kFewPixels fit 16 bits.
void addFew(const CellPart& part, const MaskedCell& cell, const PaddedLuma& previous,
            uint32_t* sums) {
  const int reach = previous.reach(), side = 2 * reach + 1;
  const int blocks = (side + kBlock - 1) / kBlock;
  std::array<uint16_t, kMostSide + kBlock> columnSums;
  for (int ex = -reach; ex <= reach; ++ex, sums += side) {
    std::fill_n(columnSums.begin(), blocks * kBlock, uint16_t{0});
    for (int i = 0; i < kCellPixels; ++i) {
      if (cell.mask[static_cast<size_t>(i)] == 0) continue;
      const int x = part.cellX * kCellSize + i % kCellSize;
      const int y = part.cellY * kCellSize + i / kCellSize;
      addPixel(cell.pixels[static_cast<size_t>(i)], previous.down(x + ex, y - reach), blocks,
               columnSums.data());
    }
    for (int k = 0; k < side; ++k) sums[k] += columnSums[static_cast<size_t>(k)];
  }
}

int roundUpToCell(int length) {
  return (length + kCellSize - 1) / kCellSize * kCellSize;
}

void padRow(const uint8_t* from, int width, int before, std::span<uint8_t> to) {
  std::memset(to.data(), from[0], static_cast<size_t>(before));
  std::memcpy(to.data() + before, from, static_cast<size_t>(width));
  const auto end = static_cast<size_t>(before + width);
  std::memset(to.data() + end, from[width - 1], to.size() - end);
}

}  // namespace

void PaddedLuma::build(ImageView<const uint8_t> luma, int reach, const Executor& executor) {
  reach_ = reach;
  const Size padded{roundUpToCell(luma.width()) + 2 * reach,
                    roundUpToCell(luma.height()) + 2 * reach};
  rows_.resize(padded);
  columns_.resize({padded.height + kBlock, padded.width});
  columns_.fill(0);
  executor.forRows(padded.height, [&](int first, int last) {
    for (int y = first; y < last; ++y)
      padRow(luma.row(std::clamp(y - reach, 0, luma.height() - 1)), luma.width(), reach,
             {rows_.row(y), static_cast<size_t>(padded.width)});
  });
  // Square tiles: both sides stay in the cache.
  constexpr int kTile = 32;
  executor.forRows((padded.height + kTile - 1) / kTile, [&](int first, int last) {
    for (int y0 = first * kTile; y0 < std::min(last * kTile, padded.height); y0 += kTile)
      for (int x0 = 0; x0 < padded.width; x0 += kTile)
        for (int x = x0; x < std::min(x0 + kTile, padded.width); ++x)
          for (int y = y0; y < std::min(y0 + kTile, padded.height); ++y)
            columns_.row(x)[y] = rows_.row(y)[x];
  });
}

void addPart(const CellPart& part, ImageView<const uint16_t> ids, ImageView<const uint8_t> luma,
             const PaddedLuma& previous, MatchScratch& scratch, std::span<uint32_t> sums) {
  const MaskedCell cell = cut(part, ids, luma);
  if (part.pixels <= kFewPixels) return addFew(part, cell, previous, sums.data());
  const int reach = previous.reach(), side = 2 * reach + 1;
  const int rows = kCellSize + 2 * reach;
  scratch.strip.resize(static_cast<size_t>(rows) * kCellSize);
  uint8_t* strip = scratch.strip.data();
  const int x0 = part.cellX * kCellSize, y0 = part.cellY * kCellSize;
  for (int ex = -reach; ex <= reach; ++ex) {
    for (int y = 0; y < rows; ++y)
      std::memcpy(strip + y * kCellSize, previous.along(x0 + ex, y0 + y - reach), kCellSize);
    uint32_t* column = sums.data() + (ex + reach) * side;
    if (part.pixels == kCellPixels)
      addWhole(cell.pixels, strip, side, column);
    else
      addMasked(cell, strip, side, column);
  }
}

void findParts(ImageView<const uint16_t> ids, int cellY, std::vector<CellPart>& parts) {
  const int y0 = cellY * kCellSize, height = std::min(kCellSize, ids.height() - y0);
  for (int x0 = 0; x0 < ids.width(); x0 += kCellSize) {
    const int width = std::min(kCellSize, ids.width() - x0);
    const size_t firstPart = parts.size();
    size_t at = firstPart;
    for (int y = y0; y < y0 + height; ++y) {
      const uint16_t* row = ids.row(y) + x0;
      for (int x = 0; x < width; ++x) {
        if (row[x] == kNoRegion) continue;
        if (at == parts.size() || parts[at].label != row[x]) {
          at = firstPart;
          while (at < parts.size() && parts[at].label != row[x]) ++at;
          if (at == parts.size())
            parts.push_back(
                {static_cast<uint16_t>(x0 / kCellSize), static_cast<uint16_t>(cellY), row[x], 0});
        }
        ++parts[at].pixels;
      }
    }
  }
}

}  // namespace rg
