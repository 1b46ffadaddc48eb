// SPDX-License-Identifier: LGPL-2.1-or-later
// Counterpart of core/motion/fit_moments.hpp: what the pixels of regions say of fractions of a
// pixel.
#pragma once

#include "core/motion/fit_moments.hpp"
#include "kernels/launch.hpp"
#include "kernels/shift_search.hpp"
#include "kernels/views.hpp"

namespace rg::gpu::motion {

/// How a region is seen.
struct FittedRegion {
  rg::motion::FitField field;
  int limit = 0;
};
/// moments: one for each region. previous: padded by more than any displacement, and a pixel.
void sumMoments(const MatchedRegions& regions, const FittedRegion* fitted,
                ImageView<const uint8_t> luma, const PaddedView& previous,
                rg::motion::FitMoments* moments, Stream stream);

}  // namespace rg::gpu::motion
