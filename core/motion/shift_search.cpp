// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/motion/shift_search.hpp"

#include "core/base/pixel.hpp"

#include <algorithm>
#include <cstring>
#include <tuple>

namespace rg::motion {
namespace {

struct Shifted {
  ImageView<const uint8_t> luma;
  const SearchedPicture& previous;
  Point e;
};

uint32_t sumPlainly(std::span<const MatchedPart> parts, const Shifted& shifted) {
  uint32_t sum = 0;
  for (const MatchedPart& part : parts)
    forBlocks(part, [&](int x, int y) {
      const uint8_t* before = shifted.previous.luma.along(x + shifted.e.x, y + shifted.e.y);
      for (int i = 0; i < kBlockWidth; ++i)
        sum += static_cast<uint32_t>(absDiff(shifted.luma.at(x + i, y), before[i]));
    });
  return sum;
}

uint32_t boundPlainly(std::span<const MatchedPart> parts, const Shifted& shifted) {
  uint32_t bound = 0;
  for (const MatchedPart& part : parts)
    forBoxes(part, [&](int x, int y) {
      int now = 0, before = 0;
      for (int row = 0; row < kBoxSide; ++row)
        for (int i = 0; i < kBoxSide; ++i) {
          now += shifted.luma.at(x + i, y + row);
          before += shifted.previous.luma.along(x + shifted.e.x, y + row + shifted.e.y)[i];
        }
      bound += static_cast<uint32_t>(absDiff(now, before));
    });
  return bound;
}

}  // namespace

FoundShift searchShiftsPlainly(std::span<const MatchedPart> parts, ImageView<const uint8_t> luma,
                               const SearchedPicture& previous, const ShiftRange& range) {
  const int reach = range.reach, side = 2 * reach + 1;
  std::vector<uint32_t> sums;
  std::tuple<uint32_t, int, int, int> best{UINT32_MAX, 0, 0, 0};
  uint64_t bounds = 0;
  for (int dy = -reach; dy <= reach; ++dy)
    for (int dx = -reach; dx <= reach; ++dx) {
      const Shifted shifted{luma, previous, {-dx, -dy}};
      sums.push_back(sumPlainly(parts, shifted));
      bounds += boundPlainly(parts, shifted);
      if (range.allows({dx, dy})) best = std::min(best, {sums.back(), dx * dx + dy * dy, dy, dx});
    }
  FoundShift found;
  found.isWithin = std::get<0>(best) <= range.mostSum;
  if (!found.isWithin) return found;
  found.d = {std::get<3>(best), std::get<2>(best)};
  found.mean = static_cast<uint32_t>(bounds / sums.size());
  for (int dy = -reach; dy <= reach; ++dy)
    for (int dx = -reach; dx <= reach; ++dx) {
      const uint32_t sum = sums[static_cast<size_t>((dy + reach) * side + dx + reach)];
      const int x = dx - found.d.x + 1, y = dy - found.d.y + 1;
      found.isBeaten = found.isBeaten || sum < std::get<0>(best);
      if (x < 0 || x > 2 || y < 0 || y > 2)
        found.rival = std::min(found.rival, sum);
      else
        found.sums[static_cast<size_t>(3 * y + x)] = sum;
    }
  return found;
}

bool isUnchanged(std::span<const MatchedPart> parts, ImageView<const uint8_t> luma,
                 ImageView<const uint8_t> previous) {
  return std::all_of(parts.begin(), parts.end(), [&](const MatchedPart& part) {
    bool isSame = true;
    forBlocks(part, [&](int x, int y) {
      isSame = isSame && std::memcmp(luma.row(y) + x, previous.row(y) + x, kBlockWidth) == 0;
    });
    return isSame;
  });
}

}  // namespace rg::motion
