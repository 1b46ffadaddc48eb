// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/motion/textured_cells.hpp"

#include <algorithm>
#include <bit>
#include <functional>

namespace rg::motion {
namespace {

constexpr uint32_t kCellsInPart = kPartHeight / kCellSize;
constexpr int kBlocksInCell = 2 * kCellSize;
constexpr uint64_t kCellBlocks = (uint64_t{1} << kBlocksInCell) - 1;

/// Cells with fewer matched pixels are not worth their time: the rest counts as flat.
constexpr uint32_t kLeastPx = kCellSize * kCellSize / 2;

constexpr uint32_t reverseBits(uint32_t bits) {
  uint32_t reversed = 0;
  for (int i = 0; i < 32; ++i) reversed |= (bits >> i & 1) << (31 - i);
  return reversed;
}
static_assert(reverseBits(6) == 3u << 29);

MatchedPart cellOf(std::span<const MatchedPart> parts, uint32_t number) {
  MatchedPart cell = parts[number / kCellsInPart];
  cell.blocks &= kCellBlocks << (number % kCellsInPart * kBlocksInCell);
  return cell;
}

/// How textured the cell is, then its turn, then its number.
constexpr int kTextureShift = 60, kTurnShift = 32, kTurnBits = kTextureShift - kTurnShift;

/// The cells of larger ranks are kept first. Turns whose bits are reversed are spread evenly.
uint64_t rankOf(const MatchedPart& cell, size_t turn, const GradientProducts& sums) {
  const auto mean = static_cast<uint64_t>(sums.xx + sums.yy) / std::max(cell.pixels(), kLeastPx);
  const auto texture = static_cast<uint64_t>(std::bit_width(mean)) / 2;
  const uint64_t later = reverseBits(static_cast<uint32_t>(turn)) >> (32 - kTurnBits);
  return texture << kTextureShift | ((uint64_t{1} << kTurnBits) - 1 - later) << kTurnShift;
}

}  // namespace

GradientProducts keepTextured(ImageView<const uint8_t> luma, std::span<MatchedPart> parts,
                              TextureScratch& scratch) {
  std::vector<uint64_t>& ranks = scratch.ranks;
  ranks.clear();
  scratch.gradients.resize(parts.size() * kCellsInPart);
  for (uint32_t i = 0; i < scratch.gradients.size(); ++i) {
    const MatchedPart cell = cellOf(parts, i);
    if (cell.blocks == 0) continue;
    scratch.gradients[i] = sumGradients({&cell, 1}, luma);
    ranks.push_back(rankOf(cell, ranks.size(), scratch.gradients[i]) | i);
  }
  std::sort(ranks.begin(), ranks.end(), std::greater<>());
  GradientProducts left;
  uint32_t pixels = 0;
  for (const uint64_t rank : ranks) {
    const auto number = static_cast<uint32_t>(rank);
    const MatchedPart cell = cellOf(parts, number);
    if (pixels >= kEnoughPx)
      parts[number / kCellsInPart].blocks &= ~cell.blocks;
    else
      left += scratch.gradients[number];
    pixels += cell.pixels();
  }
  return left;
}

}  // namespace rg::motion
