// SPDX-License-Identifier: LGPL-2.1-or-later
// The fraction of a pixel by which a region moved, from the gradients of all its pixels (part of
// stage 4).
//
// Starting at the best whole-pixel shift v, the step that takes I_t−1(x − v) to I_t(x) to first
// order solves a 2x2 system of gradient products (least squares); a few steps with bilinear samples
// converge. Pixels that fit much worse than the region's mean are left out of a step: they are
// covered, uncovered or another region's.
// Determinism: integer sums over pixels, integer division.
#pragma once

#include "core/block_matching.hpp"
#include "core/region_motion.hpp"

#include <cstdint>
#include <span>

namespace rg {

/// parts: all of one region. Returns the vector in 1/16 px, less than a pixel from `start`, which
/// is whole and not on the border of the search.
[[nodiscard]] Point refineMotion(std::span<const MatchedPart> parts, ImageView<const uint8_t> luma,
                                 const PaddedLuma& previous, const RegionMotion& start);

}  // namespace rg
