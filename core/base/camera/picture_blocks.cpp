// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/camera/picture_blocks.hpp"

#include "core/base/camera/camera_pixels.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <numeric>

namespace rg {
namespace {

constexpr int kAlong = 32;  // Places at a time.

/// Sums of absolute differences of the block at `at` with the `count` ones from `from` on along a
/// row.
void sumAlong(ImageView<const uint8_t> now, ImageView<const uint8_t> before, Point at, Point from,
              int count, uint16_t* sums) {
  std::fill_n(sums, count, uint16_t{0});
  for (int y = 0; y < kCameraBlock; ++y) {
    const uint8_t* block = now.row(at.y + y) + at.x;
    const uint8_t* row = before.row(from.y + y) + from.x;
    for (int x = 0; x < kCameraBlock; ++x) {
      const uint8_t level = block[x];
      const uint8_t* places = row + x;
      for (int i = 0; i < count; ++i) {
        const uint8_t place = places[i];
        const auto differ = static_cast<uint8_t>(level > place ? level - place : place - level);
        sums[i] = static_cast<uint16_t>(sums[i] + differ);
      }
    }
  }
}

/// A row of means of boxes, of which the first rows are those from y on.
void shrinkRows(ImageView<const uint8_t> from, int y, int side, int count, uint8_t* to) {
  constexpr int kSpan = 512;
  assert(side <= kSpan);
  const int boxes = kSpan / side;  // At a time.
  std::array<uint32_t, kSpan> columns;
  for (int first = 0; first < count; first += boxes) {
    const int last = std::min(first + boxes, count), width = (last - first) * side;
    std::fill_n(columns.begin(), width, 0u);
    for (int row = 0; row < side; ++row) {
      const uint8_t* pixel = from.row(y + row) + first * side;
      for (int i = 0; i < width; ++i) columns[static_cast<size_t>(i)] += pixel[i];
    }
    const uint32_t* column = columns.data();
    for (int box = first; box < last; ++box, column += side)
      to[box] =
          meanOfSum(std::accumulate(column, column + side, 0u), static_cast<uint32_t>(side * side));
  }
}

BlockSums sumBlock(ImageView<const uint8_t> now, ImageView<const uint8_t> before,
                   const CameraMotion& camera, Point at) {
  BlockSums sums;
  for (int y = at.y; y < at.y + kCameraBlock; ++y) {
    // Within a block places lie on a line, but for what doesn't show.
    const Point first = camera.before(at.x, y), last = camera.before(at.x + kCameraBlock, y);
    for (int i = 0; i < kCameraBlock; ++i) {
      const Point place = placeBetween(first, last, i, kCameraBlock);
      if (showsPlace(before.size, place)) addPixel(now, {at.x + i, y}, before, place, sums);
    }
  }
  return sums;
}

}  // namespace

void shrink(ImageView<const uint8_t> from, int side, const Executor& executor, Image<uint8_t>& to) {
  to.resize({from.width() / side, from.height() / side});
  if (side == 1) return to.copyFrom(from);
  executor.forRows(to.height(), [&](int begin, int end) {
    for (int y = begin; y < end; ++y) shrinkRows(from, y * side, side, to.width(), to.row(y));
  });
}

void matchBlocks(ImageView<const uint8_t> now, ImageView<const uint8_t> before,
                 std::span<const Point> shifts, int reach, const Executor& executor,
                 std::span<BlockMatch> matches) {
  assert(reach < kMostCameraReach);
  const BlockGrid grid = BlockGrid::of(now.size);
  executor.forEach(grid.rows, [&](int row) {
    std::array<uint16_t, kAlong> sums;
    for (int block = row * grid.columns; block < (row + 1) * grid.columns; ++block) {
      const Point at = grid.cornerOf(block), middle = shifts[static_cast<size_t>(block)];
      const ShiftSpan xs = ShiftSpan::of(at.x, before.width(), middle.x, reach);
      const ShiftSpan ys = ShiftSpan::of(at.y, before.height(), middle.y, reach);
      if (xs.count() == 0 || ys.count() == 0) continue;
      uint64_t least = UINT64_MAX;
      for (int dy = ys.first; dy <= ys.last; ++dy)
        for (int last = xs.last; last >= xs.first; last -= kAlong) {
          const int count = std::min(kAlong, last - xs.first + 1);
          sumAlong(now, before, at, {at.x - last, at.y - dy}, count, sums.data());
          for (int i = 0; i < count; ++i)
            least = std::min(least, rankOfMatch(sums[static_cast<size_t>(i)],
                                                {last - i - middle.x, dy - middle.y}));
        }
      const BlockMatch found = matchOfRank(least, middle);
      BlockMatch& best = matches[static_cast<size_t>(block)];
      if (found.sad <= best.sad) best = found;
    }
  });
}

void sumBlocks(ImageView<const uint8_t> now, ImageView<const uint8_t> before,
               const CameraMotion& camera, const Executor& executor, std::span<BlockSums> sums) {
  const BlockGrid grid = BlockGrid::of(now.size);
  executor.forEach(grid.count(), [&](int block) {
    sums[static_cast<size_t>(block)] = sumBlock(now, before, camera, grid.cornerOf(block));
  });
}

}  // namespace rg
