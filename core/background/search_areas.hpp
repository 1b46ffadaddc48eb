// SPDX-License-Identifier: LGPL-2.1-or-later
// The areas of interest: where the things found in one frame are looked for in the next (paper,
// section 2.1).
//
// Equation (1) gives W, H >= V / DT, whose units don't match; it is read as W, H >= size + 2 V DT,
// so that the area holds the thing after its largest move: V DT is how far its centroid went in the
// last frame, or three quarters of the step before that where that is more. One cell is added all
// round, since areas are whole cells.
// Determinism: integers; of areas that hold equally much of a part the first one counts.
#pragma once

#include "core/background/cell_search.hpp"
#include "core/base/geometry.hpp"

#include <cstdint>
#include <vector>

namespace rg::background {

struct SearchArea {
  Box box;         ///< Of the part that was found, in pixels, whole cells.
  Point centroid;  ///< Of its found pixels, by cells, in 1/16 px.
  Point step;      ///< V DT: how far the part may go until the next frame, in px.
  uint32_t foundPx = 0;
  uint32_t movedPx = 0;       ///< Of those, the ones that differ from the frame before.
  int64_t stillFrames = 0;    ///< For so many frames nothing of it moved.
  Point origin;               ///< Where its centroid was when it was first found, in 1/16 px.
  bool hasTravelled = false;  ///< It has been two cells away from there.
};

/// Sums over the cells of a part; kept from frame to frame, so that nothing is allocated.
struct PartSums {
  uint64_t found = 0, moved = 0, x = 0, y = 0;
};

/// Where to look for it in the next frame; may reach over the frame's border.
[[nodiscard]] Box searchBox(const SearchArea& area);

/// What the parts of a search say of the things in them: one area a part, in the parts' order,
/// including those without a seed. `before`: the areas of the previous frame.
void followAreas(const CellSearch& search, const std::vector<SearchArea>& before, Size frame,
                 std::vector<PartSums>& sums, std::vector<SearchArea>& areas);

}  // namespace rg::background
