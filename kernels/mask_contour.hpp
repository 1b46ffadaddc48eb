// SPDX-License-Identifier: LGPL-2.1-or-later
// Counterpart of core/background/ghosts/mask_contour.hpp.
#pragma once

#include "core/background/ghosts/mask_contour.hpp"
#include "kernels/consensus_background.hpp"
#include "kernels/launch.hpp"
#include "kernels/views.hpp"

namespace rg::gpu::background {

struct ContourView {
  BitTarget near, candidates, across;
};
/// The model is read where it is needed, so nothing is painted.
void growFaint(const Planes& smoothed, const ModelView& model, const BitView& faint,
               const ContourView& scratch, const BitTarget& mask, Stream stream);

/// rg::background::BorderEvidence: of the smoothed picture, the brightness.
struct BorderView {
  Planes picture;
  ImageView<const uint8_t> brightness;
  ModelView model;
  Planes shown;
  rg::background::Tolerance tolerance;
};
/// In and out must differ.
void trimBorder(const BorderView& seen, rg::background::BorderLayer layer, const BitView& mask,
                const BitTarget& out, Stream stream);

}  // namespace rg::gpu::background
