// SPDX-License-Identifier: LGPL-2.1-or-later
// From a region's sums of absolute differences to its vector and how far it can be relied on (part
// of stage 4).
#pragma once

#include "core/motion/motion.hpp"
#include "core/motion/shift_search.hpp"

#include <cstdint>

namespace rg::motion {

/// Sums over a region's pixels of products of the luma's central differences, in grey levels per 2
/// pixels.
struct GradientSums {
  int64_t xx = 0, xy = 0, yy = 0;
  uint64_t pixels = 0;
};

/// What is said of the best whole-pixel shift. The ring of shifts beyond those that could be found
/// tells a motion on the border of the search, which can be relied on, from one that goes further.
/// Where nothing changed the shifts farther than 1 px don't count: the result is the same for any
/// reach.
[[nodiscard]] RegionMotion estimateMotion(const FoundShift& found, const GradientSums& gradients);

}  // namespace rg::motion
