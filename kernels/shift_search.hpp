// SPDX-License-Identifier: LGPL-2.1-or-later
// Counterpart of core/motion/padded_luma.hpp and core/motion/shift_search.hpp (paper, section 2.3
// phase 2.1): partitioned region matching. All shifts are summed up; core leaves out those that
// can't matter, and finds the same.
#pragma once

#include "core/motion/shift_search.hpp"
#include "kernels/launch.hpp"
#include "kernels/views.hpp"

#include <cstdint>

namespace rg::gpu::motion {

/// rg::motion::PaddedLuma: rows of width + 2 · reach + PaddedLuma::kSlack columns or more, which
/// begin on a boundary of four bytes.
struct PaddedView {
  Size size;
  int reach = 0;
  ImageView<uint8_t> rows;
};
/// rg::motion::BoxSums of it, as many columns and rows, likewise.
struct BoxesView {
  ImageView<uint16_t> rows;
};

void padLuma(ImageView<const uint8_t> luma, const PaddedView& to, Stream stream);
/// Of the binomial means of 3x3 pixels.
void padSmooth(ImageView<const uint8_t> luma, const PaddedView& to, Stream stream);
void sumBoxes(const PaddedView& luma, const BoxesView& to, Stream stream);

/// The parts of region i: starts[i] … starts[i + 1] − 1, at least one.
struct MatchedRegions {
  const rg::motion::MatchedPart* parts;
  const uint32_t* starts;
  int count;
  /// Of each region, not 0: nothing changed, so that kStillRange is enough; no data: of none.
  const uint8_t* still = nullptr;
};
/// Sums and bounds of all shifts of as many regions as are looked at together.
struct ShiftSums {
  uint32_t *sums, *bounds;
  int regions;  ///< That there is room for: shiftsOf(range) of each.
};
[[nodiscard]] constexpr int shiftsOf(const rg::motion::ShiftRange& range) {
  return (2 * range.reach + 1) * (2 * range.reach + 1);
}
struct SearchedPlanes {
  ImageView<const uint8_t> luma;
  PaddedView previous;  ///< Padded by more than the range's reach.
  BoxesView boxes;
};
/// found: one for each region.
void searchShifts(const MatchedRegions& regions, const SearchedPlanes& planes,
                  const rg::motion::ShiftRange& range, const ShiftSums& scratch,
                  rg::motion::FoundShift* found, Stream stream);

}  // namespace rg::gpu::motion
