// SPDX-License-Identifier: LGPL-2.1-or-later
// Sums of absolute differences of blocks of 4x1 pixels against a shifted picture (part of stage 4).
//
// Sums are indexed by where the previous picture is looked at: shift (ex, ey), −reach … reach,
// means previous(x + ex, y + ey), at (ey + reach) · (2 reach + 1) + ex + reach.
// Cost: follows the number of blocks, and of parts; not what is in them.
#pragma once

#include "core/executor.hpp"
#include "core/image.hpp"
#include "core/matched_blocks.hpp"

#include <cstdint>
#include <span>

namespace rg {

inline constexpr int kMostReach = 65;

/// The previous luma with its border repeated.
class PaddedLuma {
 public:
  /// Rows go on for so many bytes beyond the right pad: kernels load whole vectors.
  static constexpr int kSlack = 64;

  void build(ImageView<const uint8_t> luma, int reach, const Executor& executor);

  [[nodiscard]] int reach() const { return reach_; }
  /// Pixel (x, y) of the luma and those right of it; both may lie outside by `reach`.
  [[nodiscard]] const uint8_t* along(int x, int y) const {
    return rows_.row(y + reach_) + x + reach_;
  }
  [[nodiscard]] ptrdiff_t stride() const { return rows_.view().strideBytes; }

 private:
  int reach_ = 0;
  Image<uint8_t> rows_;
};

/// Number of shifts for a reach.
[[nodiscard]] constexpr int shiftCount(int reach) {
  return (2 * reach + 1) * (2 * reach + 1);
}

/// What a thread needs to match parts; reused from frame to frame.
struct MatchScratch {
  Image<uint8_t> spread;  ///< Of each row of the previous picture, what vectors of shifts need.
  Image<uint16_t> sums;   ///< By shift, of at most 64 blocks.
};

/// Where parts are looked for: shifts of up to reach, at most the padding's.
struct Search {
  const PaddedLuma& previous;
  int reach;
};

/// Adds the parts' sums to `sums`, of shiftCount(reach) numbers. On the best instructions that the
/// machine has; the same bits as addPartsPlainly on all.
void addParts(std::span<const MatchedPart> parts, ImageView<const uint8_t> luma,
              const Search& search, MatchScratch& scratch, std::span<uint32_t> sums);

/// The same pixel by pixel: what it means.
void addPartsPlainly(std::span<const MatchedPart> parts, ImageView<const uint8_t> luma,
                     const Search& search, std::span<uint32_t> sums);

}  // namespace rg
