// SPDX-License-Identifier: LGPL-2.1-or-later
// Matched blocks of a region, a tile at a time (part of stage 4).
#pragma once

#include "core/segmentation/segmentation.hpp"

#include <bit>
#include <cstdint>

namespace rg::motion {

inline constexpr int kBlockWidth = 4;  ///< Blocks start at its multiples, one row high.
inline constexpr int kPartWidth = 2 * kBlockWidth;
inline constexpr int kPartHeight = 32;

/// The matched blocks of one region in one tile of kPartWidth x kPartHeight pixels.
struct MatchedPart {
  uint64_t blocks = 0;  ///< Bit 2 row + half: the left or right block of a row of the tile.
  uint16_t column = 0;  ///< In tiles.
  uint16_t strip = 0;   ///< In tiles.
  segmentation::RegionLabel label;

  [[nodiscard]] constexpr int x() const { return column * kPartWidth; }
  [[nodiscard]] constexpr int y() const { return strip * kPartHeight; }
  [[nodiscard]] uint32_t pixels() const {
    return static_cast<uint32_t>(std::popcount(blocks)) * kBlockWidth;
  }
};

/// Calls visit(x, y) for the first pixel of each block, by rows.
template <class Visit>
void forBlocks(const MatchedPart& part, Visit&& visit) {
  for (uint64_t left = part.blocks; left != 0; left &= left - 1) {
    const int bit = std::countr_zero(left);
    visit(part.x() + bit % 2 * kBlockWidth, part.y() + bit / 2);
  }
}

}  // namespace rg::motion
