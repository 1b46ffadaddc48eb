// SPDX-License-Identifier: LGPL-2.1-or-later
// Boxes to look in, brought into a form that can be searched.
#pragma once

#include "core/base/geometry.hpp"

#include <span>
#include <vector>

namespace rg::detection {

/// Where to look for what an object is: its box with `margin` of its height more at the top and
/// bottom and as much at the sides, since cascades are trained with some of what is round a thing.
[[nodiscard]] Box areaAround(const Box& object, double margin);

/// More areas than these are searched as one, the box round all.
inline constexpr size_t kMostAreas = 256;

/// Cuts boxes to the frame, leaves out those without pixels, and unites those that overlap or
/// touch, so that no pixel is in two areas, nor the column or row behind one in another. By rows,
/// then by columns of their upper left corners; the same for any order of the boxes.
void uniteAreas(std::span<const Box> boxes, Size frame, std::vector<Box>& areas);

}  // namespace rg::detection
