// SPDX-License-Identifier: LGPL-2.1-or-later
// Counterpart of core/background/changed_pixels.hpp and cell_search.hpp (paper, section 2.1) for
// whole frames: what core does along a piece of a row or in a few cells, these do everywhere.
#pragma once

#include "core/background/cell_search.hpp"
#include "core/background/changed_pixels.hpp"
#include "core/background/methods/difference_operations.hpp"
#include "kernels/launch.hpp"
#include "kernels/views.hpp"

namespace rg::gpu::background {

/// rg::background::differ and measureChange: out is the largest difference of a channel.
void differ(const Planes& a, const Planes& b, ImageView<uint8_t> out, Stream stream);
void measureChange(const Planes& a, const Planes& b, ImageView<uint8_t> out, Stream stream);

/// What rg::background::CellSearch compares a frame with, everywhere.
struct SearchedFrame {
  Planes now;
  Planes before;  ///< No channels: there is no frame before.
  Planes scene;
  ImageView<const uint8_t> known;
  ImageView<const uint8_t> seeds;  ///< Of each cell: whether areas hold it.
  int threshold = 0, sceneThreshold = 0;
  rg::background::ScannedRows scanned;
};
/// rg::background::CellSearch with SearchScope::Frame: pixels(), but not its border, and the counts
/// of all cells, row by row.
void searchCells(const SearchedFrame& frame, ImageView<uint8_t> pixels,
                 rg::background::CellCounts* cells, Stream stream);
/// rg::background::keepDense in the cells of things (rg::background::kThingCell), of the pixels
/// with their border; elsewhere nothing is set.
void keepDenseInCells(ImageView<const uint8_t> pixels, ImageView<const uint8_t> cells,
                      const BitTarget& out, Stream stream);

}  // namespace rg::gpu::background
