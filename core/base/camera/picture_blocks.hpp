// SPDX-License-Identifier: LGPL-2.1-or-later
// What the search for the camera's motion does with pixels: it looks at small pictures, block by
// block.
//
// Determinism: integers, each pixel and each block for itself.
#pragma once

#include "core/base/camera/camera_motion.hpp"
#include "core/base/memory/executor.hpp"
#include "core/base/memory/image.hpp"

#include <cstdint>
#include <span>

namespace rg {

/// Means of boxes of `side` x `side` pixels; what is left over at the right and below is not seen.
void shrink(ImageView<const uint8_t> from, int side, const Executor& executor, Image<uint8_t>& to);

inline constexpr int kCameraBlock = 8;  ///< Pixels of a small picture.

/// The blocks that lie wholly in a picture, row by row.
struct BlockGrid {
  int columns = 0, rows = 0;
  [[nodiscard]] static constexpr BlockGrid of(Size size) {
    return {size.width / kCameraBlock, size.height / kCameraBlock};
  }
  [[nodiscard]] constexpr int count() const { return columns * rows; }
  [[nodiscard]] constexpr Point cornerOf(int block) const {
    return {block % columns * kCameraBlock, block / columns * kCameraBlock};
  }
};

/// Where a block may have come from.
struct BlockMatch {
  static constexpr uint32_t kNone = UINT32_MAX;
  uint32_t sad = kNone;  ///< kNone where no place lies wholly in the picture before.
  Point shift;           ///< By how much it has moved.
};

/// The best shift of each block within `reach` of shifts[block]. Tie-break: smallest (SAD, distance
/// from shifts[block], dy, dx). Replaces what `matches` has where that isn't better.
void matchBlocks(ImageView<const uint8_t> now, ImageView<const uint8_t> before,
                 std::span<const Point> shifts, int reach, const Executor& executor,
                 std::span<BlockMatch> matches);

/// Sums over a block's pixels that have a place in the picture before: of products of the luma's
/// central differences (grey levels per 2 pixels) with each other and with `now` less what the
/// camera's motion makes expect (in 1/16 grey level).
struct BlockSums {
  int64_t xx = 0, xy = 0, yy = 0;
  int64_t xe = 0, ye = 0;
  uint64_t ee = 0;
  uint32_t pixels = 0;
  friend constexpr bool operator==(const BlockSums&, const BlockSums&) = default;
};
void sumBlocks(ImageView<const uint8_t> now, ImageView<const uint8_t> before,
               const CameraMotion& camera, const Executor& executor, std::span<BlockSums> sums);

}  // namespace rg
