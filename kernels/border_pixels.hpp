// SPDX-License-Identifier: LGPL-2.1-or-later
// Counterpart of core/segmentation/border_pixels.hpp.
#pragma once

#include "core/segmentation/border_pixels.hpp"
#include "kernels/launch.hpp"
#include "kernels/views.hpp"

#include <cstdint>

namespace rg::gpu::segmentation {

/// What the pixels of a cell choose from; the first is what they have unless another is nearer.
struct SideChoice {
  uint16_t ids[rg::segmentation::simd::kMostColours];
  uint8_t colours[rg::segmentation::simd::kMostColours][3];
  uint8_t count;
};

/// Cells, their regions, and the smoothed pixels; scopes without data: all.
struct RefinedCells {
  Planes colours;  ///< Of the cells: red, green, blue.
  ImageView<const uint8_t> scope, ranges;
  ImageView<const uint16_t> ids;
  Planes pixels;
  ImageView<const uint8_t> pixelScope;
  int sidePx;
};
/// choices: one a cell.
void refineBorders(const RefinedCells& cells, SideChoice* choices, ImageView<uint16_t> ids,
                   Stream stream);

}  // namespace rg::gpu::segmentation
