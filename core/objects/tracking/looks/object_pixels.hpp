// SPDX-License-Identifier: LGPL-2.1-or-later
// From the cells that the tracker gave to its tracks to the pixels of the objects (part of stage
// 5).
//
// Cost: follows the runs of the regions that are not background, and the rows from the first to the
// last pixel of an object. Determinism: integer sums over pixels.
#pragma once

#include "core/base/memory/image.hpp"
#include "core/objects/tracking/group_grid.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace rg::objects {

/// Over the pixels of one object.
struct ObjectSums {
  uint64_t count = 0, x = 0, y = 0, red = 0, green = 0, blue = 0;
  Point first;  ///< In raster order.
  friend bool operator==(const ObjectSums&, const ObjectSums&) = default;
};

struct ObjectPixels {
  Image<uint16_t>& slots;         ///< Of each pixel: 1 + track, 0 = none.
  std::vector<ObjectSums>& sums;  ///< Of each track; as many as there are.
};

struct OwnedCells {
  const GroupGrid& grid;
  std::span<const uint16_t> owner;  ///< Of each cell: 1 + track, 0 = none.
};

struct ObjectPixelScratch {
  struct Part {
    int begin, end;  ///< Columns of pixels.
    uint16_t owner;
  };
  std::vector<Part> parts;           ///< Of owned cells, row by row.
  std::vector<uint32_t> firstOfRow;  ///< As indices of `parts`, by row of cells.
  struct Extent {
    int first, last;  ///< Columns.
  };
  std::vector<Extent> extents;  ///< Of what is owned in each row of pixels.
};

/// Gives each pixel of a region that is not background to the owner of its cell. isBackground: of
/// each region. Slots and sums are written anew.
void findObjectPixels(const graph::Graph& graph, std::span<const uint8_t> isBackground,
                      const OwnedCells& cells, ObjectPixelScratch& scratch,
                      const ObjectPixels& pixels);

}  // namespace rg::objects
