// SPDX-License-Identifier: LGPL-2.1-or-later
// Counterpart of core/background/ghosts/displaced_things.hpp.
#pragma once

#include "core/background/ghosts/displaced_things.hpp"
#include "kernels/ghosts.hpp"

namespace rg::gpu::background {

/// rg::background::DisplacedScratch in device memory.
struct DisplacedView {
  ComponentsView parts;
  uint32_t* stillPx;  ///< mostRuns(): then the place of a part among those that are looked at.
  uint32_t* colours;  ///< 2 · kMostDisplaced · kColours: before and after, of each of those.
  uint32_t* shared;   ///< kMostDisplaced.
};
void addDisplaced(const Planes& picture, const ModelView& model, const BitView& foreground,
                  const StillView& still, int leastAge, const DisplacedView& scratch,
                  const BitTarget& moved, Stream stream);

}  // namespace rg::gpu::background
