// SPDX-License-Identifier: LGPL-2.1-or-later
// Counterpart of core/base/camera/picture_blocks.hpp.
#pragma once

#include "core/base/camera/picture_blocks.hpp"
#include "kernels/launch.hpp"
#include "kernels/views.hpp"

#include <cstdint>

namespace rg::gpu {

/// to: of as many columns and rows as there are whole boxes.
void shrink(ImageView<const uint8_t> from, int side, ImageView<uint8_t> to, Stream stream);

/// shifts, matches: one for each block of BlockGrid::of(now.size).
void matchBlocks(ImageView<const uint8_t> now, ImageView<const uint8_t> before, const Point* shifts,
                 int reach, BlockMatch* matches, Stream stream);

/// sums: the same.
void sumBlocks(ImageView<const uint8_t> now, ImageView<const uint8_t> before,
               const CameraMotion& camera, BlockSums* sums, Stream stream);

}  // namespace rg::gpu
