// SPDX-License-Identifier: LGPL-2.1-or-later
// Counterparts of what core/motion says of a region from its matched pixels: whether it has
// changed, its gradients, its vector and how far that can be relied on.
#pragma once

#include "core/motion/fit_sums.hpp"
#include "core/motion/motion_estimate.hpp"
#include "core/motion/textured_cells.hpp"
#include "kernels/shift_search.hpp"

#include <cstdint>

namespace rg::gpu::motion {

/// rg::motion::isUnchanged of each region: 1 or 0; regions without parts have 0.
void findStill(const MatchedRegions& regions, ImageView<const uint8_t> luma,
               ImageView<const uint8_t> previous, uint8_t* still, Stream stream);
/// rg::motion::sumGradients of each region.
void sumGradients(const MatchedRegions& regions, ImageView<const uint8_t> luma,
                  rg::motion::GradientProducts* sums, Stream stream);
/// rg::motion::estimateMotion of each region; those without parts have no motion.
void estimateMotion(const MatchedRegions& regions, const rg::motion::FoundShift* found,
                    const rg::motion::GradientProducts* gradients, rg::motion::RegionMotion* motion,
                    Stream stream);

}  // namespace rg::gpu::motion
