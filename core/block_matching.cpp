// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/block_matching.hpp"

#include "core/pixel.hpp"

#include <algorithm>
#include <cstring>

namespace rg {
namespace {

void padRow(const uint8_t* from, int width, int before, std::span<uint8_t> to) {
  std::memset(to.data(), from[0], static_cast<size_t>(before));
  std::memcpy(to.data() + before, from, static_cast<size_t>(width));
  const auto end = static_cast<size_t>(before + width);
  std::memset(to.data() + end, from[width - 1], to.size() - end);
}

void addBlockPlainly(const uint8_t* block, const Search& search, Point at, uint32_t* sums) {
  const int reach = search.reach;
  for (int ey = -reach; ey <= reach; ++ey)
    for (int ex = -reach; ex <= reach; ++ex, ++sums) {
      const uint8_t* before = search.previous.along(at.x + ex, at.y + ey);
      for (int i = 0; i < kBlockWidth; ++i)
        *sums += static_cast<uint32_t>(absDiff(block[i], before[i]));
    }
}

}  // namespace

void PaddedLuma::build(ImageView<const uint8_t> luma, int reach, const Executor& executor) {
  reach_ = reach;
  rows_.resize({luma.width() + 2 * reach + kSlack, luma.height() + 2 * reach});
  executor.forRows(rows_.height(), [&](int first, int last) {
    for (int y = first; y < last; ++y)
      padRow(luma.row(std::clamp(y - reach, 0, luma.height() - 1)), luma.width(), reach,
             {rows_.row(y), static_cast<size_t>(rows_.width())});
  });
}

void addPartsPlainly(std::span<const MatchedPart> parts, ImageView<const uint8_t> luma,
                     const Search& search, std::span<uint32_t> sums) {
  for (const MatchedPart& part : parts)
    forBlocks(part, [&](int x, int y) {
      addBlockPlainly(luma.row(y) + x, search, {x, y}, sums.data());
    });
}

}  // namespace rg
