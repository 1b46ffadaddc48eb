// SPDX-License-Identifier: LGPL-2.1-or-later
// Counterpart of core/segmentation/absorption.hpp.
//
// The rounds end when nothing changes any more, which nobody knows before: so one block goes
// through them all, and no host waits.
#pragma once

#include "core/segmentation/absorption.hpp"
#include "kernels/cell_groups.hpp"
#include "kernels/launch.hpp"
#include "kernels/views.hpp"

namespace rg::gpu::segmentation {

/// rg::segmentation::Absorption in device memory, sized for as many regions as there may be.
/// Before: one entry an initial region; borders in any order, more than one a pair if need be.
struct AbsorptionView {
  rg::segmentation::AbsorbedRegion* regions;
  uint32_t* count;         ///< Of the initial regions.
  uint32_t* left;          ///< Of those that are left, which stand first in `regions`.
  BorderListView borders;  ///< Are used up.
  PairTable pairs;         ///< slotsFor(the most borders).
  uint32_t* forest;        ///< Initial region → one nearer to its representative.
  uint32_t *roots, *numbers, *perimeters;
  unsigned long long* best;
  rg::segmentation::MeanColour* means;
  uint8_t* chooses;
};
void absorb(const rg::segmentation::AbsorptionLimits& limits, const AbsorptionView& view,
            Stream stream);

}  // namespace rg::gpu::segmentation
