// SPDX-License-Identifier: LGPL-2.1-or-later
// The picture as regions are grown from it: smoothed, and averaged over square cells (part of stage
// 2).
//
// Smoothing is binomial, 3x3, weights 1 2 1 down and then across, each half rounded up; the
// picture's sides repeat. A cell's colour is the mean of its smoothed pixels in scope, halves
// rounded up. Cells of one pixel are the smoothed pixels themselves.
// Determinism: each pixel and each cell depends on its own neighbourhood only.
#pragma once

#include "core/base/memory/executor.hpp"
#include "core/base/memory/image.hpp"
#include "core/base/picture.hpp"
#include "core/base/row_spans.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace rg::segmentation {

/// What is to be divided: the colours of pixels or cells, and which of them are in scope.
struct ColourGrid {
  Size size;
  int channels = 1;                                 ///< 1 or 3.
  std::array<ImageView<const uint8_t>, 3> colours;  ///< Of one channel: three times the same.
  ImageView<const uint8_t> scope;                   ///< Without data: all.
  ImageView<const uint8_t> weights;                 ///< Pixels of each; without data: 1 each.
  /// Of cells: the largest difference of a channel between two pixels in scope.
  ImageView<const uint8_t> ranges;
  int sidePx = 1;  ///< Of the pixels or cells.
};

class ColourCells {
 public:
  static constexpr int kLargestSide = 8;

  /// sidePx: 1, 2, 4 or 8. Where the scope plane tells two kinds of pixels apart, no cell may hold
  /// both.
  void build(const Picture& picture, ImageView<const uint8_t> scope, int sidePx,
             const Executor& executor);

  /// Undefined where nothing is in scope.
  [[nodiscard]] const ColourGrid& pixels() const { return pixels_; }
  [[nodiscard]] const ColourGrid& cells() const { return cells_; }

 private:
  /// Of one thread, for a row.
  struct Scratch {
    std::vector<uint8_t> down;
    std::vector<uint16_t> sums, half;
    std::vector<uint8_t> least, most;
  };

  void smoothRow(int y, int channel, Scratch& scratch);
  void averageRow(int cellRow, Scratch& scratch);
  void findRanges(int cellRow, Span columns, Scratch& scratch);
  void countRow(int cellRow, Span columns, Scratch& scratch);
  const uint16_t* reduce(int cells, Scratch& scratch) const;

  int side_ = 1;
  RowSpans spans_;
  std::array<ImageView<const uint8_t>, 3> source_;
  std::array<Image<uint8_t>, 3> smooth_, means_;
  Image<uint8_t> cellScope_, weights_, ranges_;
  std::vector<Scratch> scratch_;
  ColourGrid pixels_, cells_;
};

}  // namespace rg::segmentation
