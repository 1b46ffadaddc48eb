// SPDX-License-Identifier: LGPL-2.1-or-later
// Counterpart of core/segmentation/colour_cells.hpp and core/segmentation/colour_links.hpp (paper,
// section 2.3 phase 1.1): what regions are grown from, up to which neighbours are alike.
#pragma once

#include "core/segmentation/colour_links.hpp"
#include "kernels/launch.hpp"
#include "kernels/views.hpp"

namespace rg::gpu::segmentation {

/// rg::segmentation::ColourGrid in device memory. Cells need weights and ranges; scope without
/// data: all.
struct CellTargets {
  PlaneTargets colours;
  ImageView<uint8_t> scope, weights, ranges;
};

/// The smoothed pixels of ColourCells, also out of scope. Channels: red, green, blue.
void smoothColours(const Planes& picture, const PlaneTargets& out, Stream stream);
/// Its cells of sidePx 2, 4 or 8; where nothing of a cell is in scope, colours and ranges are left
/// as they are.
void averageCells(const Planes& smooth, ImageView<const uint8_t> scope, int sidePx,
                  const CellTargets& out, Stream stream);

/// rg::segmentation::ColourLinks: links as its LinkBits. The others are scratch: hues is needed
/// with three channels only, hsv, of two planes, for ColourSpace::Hsv only. band: in device memory,
/// instead of that of `params`, for the host need not know it.
struct LinkTargets {
  ImageView<uint8_t> links, nearest;
  ImageView<int16_t> hues;
  PlaneTargets hsv{};
};
void linkColours(const Planes& colours, ImageView<const uint8_t> scope,
                 const rg::segmentation::LinkParams& params, const rg::segmentation::HueBand* band,
                 const LinkTargets& out, Stream stream);

}  // namespace rg::gpu::segmentation
