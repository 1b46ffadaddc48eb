// SPDX-License-Identifier: LGPL-2.1-or-later
// Counterpart of core/segmentation/region_division.hpp.
#pragma once

#include "core/segmentation/region_division.hpp"
#include "kernels/absorption.hpp"
#include "kernels/cell_groups.hpp"
#include "kernels/launch.hpp"
#include "kernels/views.hpp"

namespace rg::gpu::segmentation {

/// rg::segmentation::RegionDivision; `groups` are its runs.
struct DivisionView {
  AbsorptionView absorption;
  uint32_t* firstOf;                           ///< By representative.
  uint32_t* labels;                            ///< By component.
  rg::segmentation::AbsorbedRegion* labelled;  ///< maxRegions + 1: what is left, by label.
  uint32_t* count;                             ///< Of the labels.
};
struct DividedCells {
  Planes colours;  ///< Red, green, blue.
  ImageView<const uint8_t> weights;
  int sidePx = 1;
};
void divideRegions(const DividedCells& cells, const GroupsView& groups,
                   const rg::segmentation::RegionDivision::Limits& limits, const DivisionView& view,
                   ImageView<uint16_t> ids, Stream stream);
/// labelled: of the first division, which must not be that of `view`.
void divideAgain(const rg::segmentation::AbsorbedRegion* labelled, const GroupsView& groups,
                 const rg::segmentation::RegionDivision::Limits& limits, const DivisionView& view,
                 ImageView<uint16_t> ids, Stream stream);

}  // namespace rg::gpu::segmentation
