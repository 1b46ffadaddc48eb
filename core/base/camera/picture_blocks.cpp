// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/camera/picture_blocks.hpp"

#include "core/base/pixel.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <numeric>

namespace rg {
namespace {

constexpr int kPlace = 1 << CameraMotion::kPlaceBits;
constexpr int kErrorUnit = 16;

/// Sums of absolute differences of a block with `count` places along a row, of which the block at
/// from[i] is the i-th.
void sumAlong(ImageView<const uint8_t> now, ImageView<const uint8_t> before, Point at, Point from,
              int count, std::span<uint16_t> sums) {
  std::fill_n(sums.begin(), count, uint16_t{0});
  uint16_t* to = sums.data();
  for (int y = 0; y < kCameraBlock; ++y) {
    const uint8_t* block = now.row(at.y + y) + at.x;
    const uint8_t* row = before.row(from.y + y) + from.x;
    for (int x = 0; x < kCameraBlock; ++x) {
      const uint8_t level = block[x];
      const uint8_t* places = row + x;
      for (int i = 0; i < count; ++i) {
        const uint8_t place = places[i];
        const auto differ = static_cast<uint8_t>(level > place ? level - place : place - level);
        to[i] = static_cast<uint16_t>(to[i] + differ);
      }
    }
  }
}

/// The luma at a place in 1/256 px that lies within the picture, in 1/16 grey level.
int levelAt(ImageView<const uint8_t> picture, Point place) {
  const int x = place.x >> CameraMotion::kPlaceBits, y = place.y >> CameraMotion::kPlaceBits;
  const int right = place.x & (kPlace - 1), low = place.y & (kPlace - 1);
  const uint8_t* upper = picture.row(y) + x;
  const uint8_t* lower = picture.row(std::min(y + 1, picture.height() - 1)) + x;
  const int next = x + 1 < picture.width() ? 1 : 0;
  const int above = upper[0] * (kPlace - right) + upper[next] * right;
  const int below = lower[0] * (kPlace - right) + lower[next] * right;
  constexpr int kRestBits = 2 * CameraMotion::kPlaceBits - 4;
  static_assert(kErrorUnit == 1 << 4);
  return roundShift(above * (kPlace - low) + below * low, kRestBits);
}

BlockSums sumBlock(ImageView<const uint8_t> now, ImageView<const uint8_t> before,
                   const CameraMotion& camera, Point at) {
  BlockSums sums;
  const int mostX = (before.width() - 1) * kPlace, mostY = (before.height() - 1) * kPlace;
  for (int y = at.y; y < at.y + kCameraBlock; ++y) {
    const uint8_t* row = now.row(y);
    const uint8_t* above = now.row(std::max(y - 1, 0));
    const uint8_t* below = now.row(std::min(y + 1, now.height() - 1));
    // Within a block places lie on a line, but for what doesn't show.
    const Point first = camera.before(at.x, y), last = camera.before(at.x + kCameraBlock, y);
    for (int i = 0; i < kCameraBlock; ++i) {
      const int x = at.x + i;
      const Point place{first.x + (last.x - first.x) * i / kCameraBlock,
                        first.y + (last.y - first.y) * i / kCameraBlock};
      if (place.x < 0 || place.x > mostX || place.y < 0 || place.y > mostY) continue;
      const int gx = row[std::min(x + 1, now.width() - 1)] - row[std::max(x - 1, 0)];
      const int gy = below[x] - above[x];
      const int e = kErrorUnit * row[x] - levelAt(before, place);
      sums.xx += gx * gx;
      sums.xy += gx * gy;
      sums.yy += gy * gy;
      sums.xe += gx * e;
      sums.ye += gy * e;
      sums.ee += static_cast<uint64_t>(int64_t{e} * e);
      ++sums.pixels;
    }
  }
  return sums;
}

/// A row of means of boxes, of which the first rows are those from y on.
void shrinkRows(ImageView<const uint8_t> from, int y, int side, int count, uint8_t* to) {
  constexpr int kSpan = 512;
  assert(side <= kSpan);
  const auto pixels = static_cast<uint32_t>(side * side);
  const int boxes = std::max(1, kSpan / side);  // At a time.
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
      to[box] = static_cast<uint8_t>(std::accumulate(column, column + side, pixels / 2) / pixels);
  }
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
  const BlockGrid grid = BlockGrid::of(now.size);
  executor.forEach(grid.rows, [&](int row) {
    std::array<uint16_t, 2 * kMostCameraReach + 1> sums;
    for (int block = row * grid.columns; block < (row + 1) * grid.columns; ++block) {
      const Point at = grid.cornerOf(block), middle = shifts[static_cast<size_t>(block)];
      BlockMatch& best = matches[static_cast<size_t>(block)];
      int leastDistance = INT32_MAX;
      // Shifts within reach whose place lies in the picture before.
      const int left = std::max(middle.x - reach, at.x + kCameraBlock - before.width());
      const int right = std::min(middle.x + reach, at.x);
      const int top = std::max(middle.y - reach, at.y + kCameraBlock - before.height());
      const int bottom = std::min(middle.y + reach, at.y);
      if (left > right) continue;
      for (int dy = top; dy <= bottom; ++dy) {
        const int count = right - left + 1;
        sumAlong(now, before, at, {at.x - right, at.y - dy}, count, sums);
        for (int i = count - 1; i >= 0; --i) {
          const uint32_t sad = sums[static_cast<size_t>(i)];
          if (sad > best.sad) continue;
          const int dx = right - i, u = dx - middle.x, v = dy - middle.y;
          const int distance = u * u + v * v;
          if (sad == best.sad && distance >= leastDistance) continue;
          best = {sad, {dx, dy}};
          leastDistance = distance;
        }
      }
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
