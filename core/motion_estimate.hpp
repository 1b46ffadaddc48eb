// SPDX-License-Identifier: LGPL-2.1-or-later
// From a region's sums of absolute differences to its vector and how far it can be relied on (part
// of stage 4).
#pragma once

#include "core/region_motion.hpp"

#include <cstdint>
#include <span>

namespace rg {

/// Sums over a region's pixels of products of the luma's central differences, in grey levels per 2
/// pixels.
struct GradientSums {
  int64_t xx = 0, xy = 0, yy = 0;
  uint64_t pixels = 0;
};

inline void add(GradientSums& to, const GradientSums& from) {
  to.xx += from.xx;
  to.xy += from.xy;
  to.yy += from.yy;
  to.pixels += from.pixels;
}

/// The best whole-pixel shift of those within maxShift, which is less than `reach`: the ring of
/// shifts beyond tells a motion on the border of the search, which can be relied on, from one that
/// goes further. sums: of all shifts within `reach`, as core/block_matching.hpp orders them. Where
/// nothing changed the shifts farther than 1 px don't count: the result is the same for any reach.
[[nodiscard]] RegionMotion estimateMotion(std::span<const uint32_t> sums, int reach, int maxShift,
                                          const GradientSums& gradients);
[[nodiscard]] RegionMotion estimateMotion(std::span<const uint64_t> sums, int reach, int maxShift,
                                          const GradientSums& gradients);

}  // namespace rg
