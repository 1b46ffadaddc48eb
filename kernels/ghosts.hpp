// SPDX-License-Identifier: LGPL-2.1-or-later
// Counterpart of core/background/ghosts/ghosts.hpp.
#pragma once

#include "core/background/ghosts/ghosts.hpp"
#include "kernels/components.hpp"
#include "kernels/consensus_background.hpp"
#include "kernels/launch.hpp"
#include "kernels/views.hpp"

namespace rg::gpu::background {

/// rg::background::StillPixels in device memory. All zeros: nothing is known. Rows' freshRows are a
/// short cut of core's: the most of each row of `fresh`.
struct StillView {
  PlaneTargets colours;
  ImageView<uint16_t> ages;
  BitTarget aged;
  ImageView<uint8_t> fresh;
};

void followStill(const Planes& picture, const ModelView& model,
                 const rg::background::Tolerance& tolerance, const BitView& foreground,
                 uint16_t mostAge, const StillView& still, Stream stream);
void addAged(const BitView& foreground, const StillView& still, int leastAge,
             const BitTarget& places, Stream stream);

/// rg::background::StillScratch; contours: mostRuns().
struct GhostView {
  BitTarget still;
  ComponentsView parts;
  rg::background::ContourSums* contours;
};
/// rg::background::findGhosts; how many pixels there are, nobody is told.
void findGhosts(const Planes& picture, const ModelView& model, const BitView& foreground,
                const StillView& still, int leastAge, const GhostView& scratch,
                const BitTarget& ghosts, Stream stream);

}  // namespace rg::gpu::background
