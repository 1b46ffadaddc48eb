// SPDX-License-Identifier: LGPL-2.1-or-later
// The outer border of a thing in a picture of numbers.
#pragma once

#include "core/base/geometry.hpp"
#include "core/base/memory/image.hpp"

#include <cstdint>
#include <vector>

namespace rg::objects {

/// Follows the outer border of the 8-connected part that holds `start`, clockwise (y downwards),
/// starting there. `start` must be the part's first pixel in raster order. Only corners are kept:
/// pixels where the direction changes. At most `limit` steps are made; a longer border ends there.
void traceContour(ImageView<const uint16_t> picture, Point start, int limit,
                  std::vector<Point>& contour);

}  // namespace rg::objects
