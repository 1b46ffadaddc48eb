// SPDX-License-Identifier: LGPL-2.1-or-later
// Counterpart of core/background/shadows/cast_shadows.hpp.
#pragma once

#include "core/background/shadows/cast_shadows.hpp"
#include "kernels/components.hpp"
#include "kernels/launch.hpp"
#include "kernels/views.hpp"

namespace rg::gpu::background {

/// rg::background::CastShadowScratch in device memory; of darkParts and objects each mostRuns().
struct CastShadowView {
  ComponentsView found;
  rg::background::DarkPart* darkParts;
  uint32_t* darkOf;
};

void keepCastShadows(const BitView& mask, const BitTarget& dark, const CastShadowView& scratch,
                     Stream stream);

}  // namespace rg::gpu::background
