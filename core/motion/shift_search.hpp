// SPDX-License-Identifier: LGPL-2.1-or-later
// The shift at which the sum of absolute differences of a region's blocks against the previous
// picture is smallest, of all shifts within a reach (part of stage 4).
//
// A sum is at least the sum over 4x4 boxes of the differences of the boxes' sums: successive
// elimination. These bounds cost little; sums are taken only of shifts that could still be the best
// one or its rival. So what is found is what a search of all shifts finds, whatever is in the
// picture.
//
// Shift (ex, ey), −reach … reach, means previous(x + ex, y + ey): d = −e.
// Determinism: integer sums. Tie-break: smallest (sum, |d|², d.y, d.x).
#pragma once

#include "core/base/geometry.hpp"
#include "core/motion/matched_part.hpp"
#include "core/motion/padded_luma.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace rg::motion {

struct FoundShift {
  Point d;
  /// At (d.x + i, d.y + j): [3 (j + 1) + i + 1].
  std::array<uint32_t, 9> sums{};
  uint32_t rival = UINT32_MAX;  ///< The least sum of all other shifts.
  /// Of all shifts: by how much the sums of the region's 4x4 boxes differ, added up. What a shift
  /// at random leaves, at that scale.
  uint32_t mean = 0;
  bool isBeaten = false;  ///< By a shift that may not be the best one.
  bool isWithin = true;   ///< The best sum is at most the range's mostSum. Else nothing is told.

  [[nodiscard]] constexpr int64_t sum(int dx = 0, int dy = 0) const {
    return sums[static_cast<size_t>(3 * (dy + 1) + dx + 1)];
  }
};

/// Shifts of up to maxShift may be the best one; those up to reach, which is greater, are seen.
struct ShiftRange {
  int maxShift = 0;
  int reach = 0;
  uint32_t mostSum = UINT32_MAX;  ///< A best sum above it is not told.

  /// Whether a shift may be the best one. (Not by maxima of magnitudes, of which nvcc 13.0 makes
  /// code that takes the leftmost shifts for such: tests/kernels/resources.py.)
  [[nodiscard]] constexpr bool allows(Point d) const {
    return d.x >= -maxShift && d.x <= maxShift && d.y >= -maxShift && d.y <= maxShift;
  }
};

/// Blocks of 4x1 pixels and boxes of a region, and where in the previous picture, without a shift.
struct SearchedBlock {
  ptrdiff_t offset = 0;
  uint32_t pixels = 0;
};
struct SearchedBox {
  ptrdiff_t offset = 0;
  uint16_t sum = 0;
};

/// What a thread needs; reused from region to region.
struct SearchScratch {
  std::vector<SearchedBlock> blocks;
  std::vector<SearchedBox> boxes;
  Image<uint16_t> bounds, someBounds;  ///< By shift: of all boxes, of some.
  Image<uint32_t> sums;
  std::vector<uint16_t> leasts;   ///< Of the bounds of each group of shifts.
  std::vector<uint8_t> isSummed;  ///< By group of shifts.
};

/// Bounds go no higher; one at it says nothing of how far the sum is above.
inline constexpr uint16_t kMostBound = UINT16_MAX;

/// Whether none of the parts' pixels has changed since the previous picture.
[[nodiscard]] bool isUnchanged(std::span<const MatchedPart> parts, ImageView<const uint8_t> luma,
                               ImageView<const uint8_t> previous);
/// Where nothing changed no shift is better than none, and of the others only the nearest count.
inline constexpr ShiftRange kStillRange{0, 1};

/// On the best instructions that the machine has; the same as searchShiftsPlainly on all. parts: at
/// least one, of fewer than 2^22 pixels. previous: padded by at least the range's reach.
[[nodiscard]] FoundShift searchShifts(std::span<const MatchedPart> parts,
                                      ImageView<const uint8_t> luma,
                                      const SearchedPicture& previous, const ShiftRange& range,
                                      SearchScratch& scratch);

/// The same from all sums, pixel by pixel: what it means.
[[nodiscard]] FoundShift searchShiftsPlainly(std::span<const MatchedPart> parts,
                                             ImageView<const uint8_t> luma,
                                             const SearchedPicture& previous,
                                             const ShiftRange& range);

/// Calls visit(x, y) for the first pixel of each box of the part: as many as fit below each other
/// into each run of blocks, from its upper end on.
template <class Visit>
void forBoxes(const MatchedPart& part, Visit&& visit) {
  constexpr uint64_t kOneHalf = 0x5555555555555555;
  constexpr uint64_t kBox = (uint64_t{1} << 2 * kBoxSide) - 1;
  for (int half = 0; half < 2; ++half) {
    const uint64_t rows = part.blocks >> half & kOneHalf;
    // Of each row whether a box's worth of rows from it on has blocks.
    uint64_t firsts = rows & rows >> 2 & rows >> 4 & rows >> 6;
    while (firsts != 0) {
      const int bit = std::countr_zero(firsts);
      visit(part.x() + half * kBlockWidth, part.y() + bit / 2);
      firsts &= ~(kBox << bit);
    }
  }
}

}  // namespace rg::motion
