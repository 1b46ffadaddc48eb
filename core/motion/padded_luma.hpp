// SPDX-License-Identifier: LGPL-2.1-or-later
// A luma with its border repeated, and the sums of its boxes (part of stage 4).
#pragma once

#include "core/base/memory/executor.hpp"
#include "core/base/memory/image.hpp"

#include <cstdint>

namespace rg::motion {

inline constexpr int kMostReach = 65;

class PaddedLuma {
 public:
  /// Rows go on for so many bytes beyond the right pad: kernels load whole vectors.
  static constexpr int kSlack = 64;

  void build(ImageView<const uint8_t> luma, int reach, const Executor& executor);
  /// Of the binomial means of 3x3 pixels.
  void buildSmooth(ImageView<const uint8_t> luma, int reach, const Executor& executor);

  [[nodiscard]] int reach() const { return reach_; }
  /// Pixel (x, y) of the luma and those right of it; both may lie outside by `reach`.
  [[nodiscard]] const uint8_t* along(int x, int y) const {
    return rows_.row(y + reach_) + x + reach_;
  }
  [[nodiscard]] ptrdiff_t stride() const { return rows_.view().strideBytes; }
  [[nodiscard]] ImageView<const uint8_t> rows() const { return rows_; }
  /// Without the padding.
  [[nodiscard]] ImageView<const uint8_t> inside() const { return {along(0, 0), size_, stride()}; }

 private:
  template <class FillRow>
  void fill(Size size, int reach, const Executor& executor, const FillRow& fillRow);

  int reach_ = 0;
  Size size_;
  Image<uint8_t> rows_;
};

inline constexpr int kBoxSide = 4;

/// Of each pixel of a padded luma the sum of the box of kBoxSide x kBoxSide pixels to its right and
/// below; 0 where that does not lie inside.
class BoxSums {
 public:
  void build(const PaddedLuma& luma, const Executor& executor);

  [[nodiscard]] const uint16_t* along(int x, int y) const {
    return rows_.row(y + reach_) + x + reach_;
  }
  /// In numbers, not bytes.
  [[nodiscard]] ptrdiff_t stride() const {
    return rows_.view().strideBytes / static_cast<ptrdiff_t>(sizeof(uint16_t));
  }

 private:
  int reach_ = 0;
  Image<uint16_t> rows_;
};

/// What shifts are searched in: the picture before.
struct SearchedPicture {
  PaddedLuma luma;
  BoxSums boxes;

  void build(ImageView<const uint8_t> from, int reach, const Executor& executor) {
    luma.build(from, reach, executor);
    boxes.build(luma, executor);
  }
};

}  // namespace rg::motion
