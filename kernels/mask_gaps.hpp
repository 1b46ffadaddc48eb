// SPDX-License-Identifier: LGPL-2.1-or-later
// Counterpart of core/base/mask_gaps.hpp.
#pragma once

#include "core/base/mask_gaps.hpp"
#include "kernels/components.hpp"
#include "kernels/launch.hpp"
#include "kernels/views.hpp"

namespace rg::gpu {

/// rg::GapScratch in device memory; contours: mostRuns().
struct GapView {
  BitTarget thick, chosen;
  ComponentsView parts;
  GapContour* contours;
};

/// rg::fillUnedged; whether there is a gap, nobody is told.
void fillUnedged(ImageView<const uint8_t> picture, int mostStep, uint32_t mostPx,
                 const GapView& scratch, const BitTarget& mask, Stream stream);

}  // namespace rg::gpu
