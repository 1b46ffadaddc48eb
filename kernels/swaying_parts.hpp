// SPDX-License-Identifier: LGPL-2.1-or-later
// Counterpart of core/background/ghosts/swaying_parts.hpp.
#pragma once

#include "core/background/ghosts/swaying_parts.hpp"
#include "kernels/components.hpp"
#include "kernels/consensus_background.hpp"
#include "kernels/launch.hpp"
#include "kernels/views.hpp"

namespace rg::gpu::background {

struct SwayView {
  BitTarget restless;
  ComponentsView parts;
  rg::background::PartCount* counts;  ///< Of as many parts as there may be.
};
void dropSwaying(const Planes& picture, const ModelView& model,
                 const rg::background::Tolerance& tolerance, const SwayView& scratch,
                 const BitTarget& mask, Stream stream);

}  // namespace rg::gpu::background
