// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/camera/picture_blocks.hpp"

#include "core/base/pixel.hpp"

#include <algorithm>
#include <tuple>

namespace rg {
namespace {

constexpr int kPlace = 1 << CameraMotion::kPlaceBits;
constexpr int kErrorUnit = 16;

uint32_t blockSad(ImageView<const uint8_t> now, ImageView<const uint8_t> before, Point at,
                  Point from) {
  uint32_t sad = 0;
  for (int y = 0; y < kCameraBlock; ++y) {
    const uint8_t *a = now.row(at.y + y) + at.x, *b = before.row(from.y + y) + from.x;
    uint32_t row = 0;
    for (int x = 0; x < kCameraBlock; ++x) row += static_cast<uint32_t>(absDiff(a[x], b[x]));
    sad += row;
  }
  return sad;
}

/// The luma at a place in 1/256 px that lies within the picture, in 1/16 grey level.
int levelAt(ImageView<const uint8_t> picture, Point place) {
  const int x = place.x / kPlace, y = place.y / kPlace;
  const int right = place.x % kPlace, low = place.y % kPlace;
  const uint8_t* upper = picture.row(y) + x;
  const uint8_t* lower = picture.row(std::min(y + 1, picture.height() - 1)) + x;
  const int next = x + 1 < picture.width() ? 1 : 0;
  const int above = upper[0] * (kPlace - right) + upper[next] * right;
  const int below = lower[0] * (kPlace - right) + lower[next] * right;
  constexpr int kRest = kPlace * kPlace / kErrorUnit;
  return (above * (kPlace - low) + below * low + kRest / 2) / kRest;
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

}  // namespace

void shrink(ImageView<const uint8_t> from, int side, const Executor& executor, Image<uint8_t>& to) {
  to.resize({from.width() / side, from.height() / side});
  if (side == 1) return to.copyFrom(from);
  const auto pixels = static_cast<uint32_t>(side * side);
  executor.forRows(to.height(), [&](int begin, int end) {
    for (int y = begin; y < end; ++y)
      for (int x = 0; x < to.width(); ++x) {
        uint32_t sum = pixels / 2;
        for (int row = 0; row < side; ++row) {
          const uint8_t* pixel = from.row(y * side + row) + x * side;
          for (int i = 0; i < side; ++i) sum += pixel[i];
        }
        to.row(y)[x] = static_cast<uint8_t>(sum / pixels);
      }
  });
}

void matchBlocks(ImageView<const uint8_t> now, ImageView<const uint8_t> before,
                 std::span<const Point> shifts, int reach, const Executor& executor,
                 std::span<BlockMatch> matches) {
  const BlockGrid grid = BlockGrid::of(now.size);
  executor.forEach(grid.rows, [&](int row) {
    for (int block = row * grid.columns; block < (row + 1) * grid.columns; ++block) {
      const Point at = grid.cornerOf(block), middle = shifts[static_cast<size_t>(block)];
      BlockMatch& best = matches[static_cast<size_t>(block)];
      int leastDistance = INT32_MAX;
      const auto clampX = [&](int shift) {
        return std::clamp(shift, at.x + kCameraBlock - before.width(), at.x);
      };
      const auto clampY = [&](int shift) {
        return std::clamp(shift, at.y + kCameraBlock - before.height(), at.y);
      };
      if (clampX(middle.x - reach) > middle.x + reach ||
          clampX(middle.x + reach) < middle.x - reach ||
          clampY(middle.y - reach) > middle.y + reach ||
          clampY(middle.y + reach) < middle.y - reach)
        continue;
      for (int dy = clampY(middle.y - reach); dy <= clampY(middle.y + reach); ++dy)
        for (int dx = clampX(middle.x - reach); dx <= clampX(middle.x + reach); ++dx) {
          const uint32_t sad = blockSad(now, before, at, {at.x - dx, at.y - dy});
          const int u = dx - middle.x, v = dy - middle.y;
          const int distance = u * u + v * v;
          if (std::tie(sad, distance) >= std::tie(best.sad, leastDistance)) continue;
          best = {sad, {dx, dy}};
          leastDistance = distance;
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
