// SPDX-License-Identifier: LGPL-2.1-or-later
// Region matching as the paper says it (section 2.3 phase 2.1): the classical sum of absolute
// differences over all of a region's pixels, at every shift (part of stage 4).
//
// Shift (ex, ey), −reach … reach, means previous(x + ex, y + ey): d = −e.
// Determinism: integer sums. Tie-break: smallest (sum, |d|², d.y, d.x).
#pragma once

#include "core/base/run.hpp"
#include "core/motion/motion.hpp"
#include "core/motion/motion_estimate.hpp"
#include "core/motion/padded_luma.hpp"
#include "core/motion/shift_search.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace rg::motion {

/// What a thread needs; reused from region to region.
struct LiteralScratch {
  std::vector<uint64_t> sums;  ///< By shift.
};

/// Sums of the largest regions are told in units of 2^scale: those of 2^24 pixels fit in 32 bits.
[[nodiscard]] constexpr int literalScale(uint64_t pixels) {
  int scale = 0;
  while (pixels >> scale >= uint64_t{1} << 24) ++scale;
  return scale;
}
static_assert(literalScale((1 << 24) - 1) == 0 && literalScale(1 << 24) == 1);
[[nodiscard]] constexpr GradientSums scaled(const GradientSums& sums, int scale) {
  return {sums.xx >> scale, sums.xy >> scale, sums.yy >> scale, sums.pixels >> scale};
}

/// The sum over the runs' pixels x of |luma(x) − previous(x + e)| for every shift e, by rows of
/// shifts. Of a frame's pixels: 2^26 · 255 < 2^64.
void sumAllShifts(std::span<const Run> runs, ImageView<const uint8_t> luma,
                  const PaddedLuma& previous, int reach, std::vector<uint64_t>& sums);

/// The shift of the least sum of all of up to range.maxShift pixels, and its reliability as
/// core/motion/motion_estimate.hpp has it, where a shift at random leaves the mean of all sums. The
/// cost: the region's pixels times (2 reach + 1)². `previous`: padded by at least the range's
/// reach.
[[nodiscard]] RegionMotion matchAllPixels(std::span<const Run> runs, ImageView<const uint8_t> luma,
                                          const PaddedLuma& previous, const ShiftRange& range,
                                          LiteralScratch& scratch);

}  // namespace rg::motion
