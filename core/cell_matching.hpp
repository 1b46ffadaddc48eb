// SPDX-License-Identifier: LGPL-2.1-or-later
// Sums of absolute differences of 8x8 cells against a shifted picture (part of stage 4).
//
// A part is what one region has in one cell. Sums are indexed by where the previous picture is
// looked at: shift (ex, ey) means previous(x + ex, y + ey), −reach … reach, at
// (ex + reach) · (2 reach + 1) + ey + reach.
// Cost: a part of up to kFewPixels is matched pixel by pixel, others as a masked cell, so that a
// cell costs at most about three times a cell of one region, whatever the labels in it.
#pragma once

#include "core/executor.hpp"
#include "core/image.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace rg {

inline constexpr int kCellSize = 8;
inline constexpr int kMostReach = 64;
inline constexpr int kCellPixels = kCellSize * kCellSize;

struct CellPart {
  uint16_t cellX = 0;  ///< In cells.
  uint16_t cellY = 0;
  uint16_t label = 0;
  uint8_t pixels = 0;  ///< 1 … kCellPixels.
};

/// The previous luma with its border repeated, by rows and by columns.
class PaddedLuma {
 public:
  void build(ImageView<const uint8_t> luma, int reach, const Executor& executor);

  [[nodiscard]] int reach() const { return reach_; }
  /// Pixel (x, y) of the luma and those right of it; both may lie outside by `reach`.
  [[nodiscard]] const uint8_t* along(int x, int y) const {
    return rows_.row(y + reach_) + x + reach_;
  }
  /// Pixel (x, y) and those below it.
  [[nodiscard]] const uint8_t* down(int x, int y) const {
    return columns_.row(x + reach_) + y + reach_;
  }

 private:
  int reach_ = 0;
  Image<uint8_t> rows_, columns_;
};

/// Number of shifts for a reach.
[[nodiscard]] constexpr int shiftCount(int reach) {
  return (2 * reach + 1) * (2 * reach + 1);
}

/// What a task needs to match cells; reused from frame to frame.
struct MatchScratch {
  std::vector<uint8_t> strip;
};

/// Adds the part's sums to `sums`, of shiftCount(reach) numbers: at most 64 · 255 each.
void addPart(const CellPart& part, ImageView<const uint16_t> ids, ImageView<const uint8_t> luma,
             const PaddedLuma& previous, MatchScratch& scratch, std::span<uint32_t> sums);

/// Appends the parts of one row of cells, sorted by cell.
void findParts(ImageView<const uint16_t> ids, int cellY, std::vector<CellPart>& parts);

}  // namespace rg
