// SPDX-License-Identifier: LGPL-2.1-or-later
// Counterpart of core/segmentation/pixel_runs.hpp: linked cells, or pixels of equal labels, as
// components with the same numbers, and the borders between these. By cells, not by runs.
#pragma once

#include "core/segmentation/pixel_runs.hpp"
#include "kernels/launch.hpp"
#include "kernels/pair_table.hpp"
#include "kernels/primitives.hpp"
#include "kernels/views.hpp"

#include <cstdint>

namespace rg::gpu::segmentation {

/// Borders, each pair once, a < b, in no promised order.
struct BorderListView {
  rg::segmentation::AbsorbedBorder* list;
  uint32_t* count;
};

inline constexpr uint32_t kNoGroup = ~uint32_t{0};

/// All in device memory, sized for as many cells as there are: y · width + x is a cell's number.
struct GroupsView {
  uint32_t* of;       ///< The component of each cell, or kNoGroup.
  uint32_t* first;    ///< Of each component its first cell.
  uint32_t* numbers;  ///< A number more than cells: how many components there are stands last.
  uint32_t* scratch;  ///< scanScratchOf(cells).
  uint32_t *parents, *areas;      ///< Of what is linked within a tile, by its first cell.
  uint32_t *wholes, *wholeAreas;  ///< The same of what is linked at all.
  PairTable pairs;                ///< slotsFor(mostBorders(cells)).
  BorderListView borders;         ///< mostBorders(cells).
};
[[nodiscard]] constexpr uint64_t mostBorders(int64_t cells) {
  return 2 * static_cast<uint64_t>(cells);
}
/// Components are connected, so the graph of their borders is planar.
[[nodiscard]] constexpr uint32_t slotsOf(int64_t cells, uint32_t components) {
  return slotsFor(std::min(mostBorders(cells), uint64_t{3} * components));
}

/// links: LinkBits (core/segmentation/colour_links.hpp); scope without data: all. sidePx: of the
/// cells, by which borders are measured.
void groupLinked(ImageView<const uint8_t> links, ImageView<const uint8_t> scope,
                 const rg::segmentation::RunLimits& limits, int sidePx, const GroupsView& groups,
                 Stream stream);
void groupLabelled(ImageView<const uint16_t> labels, ImageView<const uint8_t> scope,
                   const GroupsView& groups, Stream stream);

}  // namespace rg::gpu::segmentation
