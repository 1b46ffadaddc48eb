// SPDX-License-Identifier: LGPL-2.1-or-later
// Copies of results for readers of a frame that is a part of the one that they were made for, or
// that one turned.
#pragma once

#include "core/base/geometry.hpp"
#include "core/objects/object.hpp"

#include <memory>
#include <utility>

namespace rg::objects {

/// Where the pixels of a frame went: first the part that is left, then, where it is transposed,
/// columns for rows, then left for right and top for bottom where it is mirrored.
struct Placement {
  Size whole;  ///< Of the frame that the pixels come from.
  Box part;    ///< What is left of it, not empty; where it leaves the frame there is nothing.
  bool isTransposed = false;
  bool isMirroredX = false, isMirroredY = false;

  /// Of the frame that they are in.
  [[nodiscard]] constexpr Size size() const {
    return isTransposed ? Size{part.height, part.width} : Size{part.width, part.height};
  }
  /// The pixel of the whole frame that is at `p`.
  [[nodiscard]] constexpr Point sourceOf(Point p) const {
    if (isMirroredX) p.x = size().width - 1 - p.x;
    if (isMirroredY) p.y = size().height - 1 - p.y;
    if (isTransposed) std::swap(p.x, p.y);
    return {part.x + p.x, part.y + p.y};
  }
};
static_assert(Placement{{9, 9}, {2, 3, 4, 5}, true, true, false}.sourceOf({0, 0}) == Point{2, 7});

/// What a stage said, as of the frame that its pixels are in now: planes are cut, areas counted
/// anew where a plane shows them. Areas, regions and contours end with the frame, boxes of objects
/// may leave it. Objects that lie outside are left out; events and the tables of regions stay,
/// since they name regions and objects by number. For readers, as what ResultPacker packs. Null for
/// null. Throws std::bad_alloc.
template <class Payload>
[[nodiscard]] std::shared_ptr<const Payload> place(const std::shared_ptr<const Payload>& result,
                                                   const Placement& placement);

}  // namespace rg::objects
