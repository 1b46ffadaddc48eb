// SPDX-License-Identifier: LGPL-2.1-or-later
// Counterpart of core/background/shadows/shadow.hpp (paper, section 2.2.1).
#pragma once

#include "core/background/shadows/shadow.hpp"
#include "kernels/launch.hpp"
#include "kernels/views.hpp"

namespace rg::gpu::background {

/// rg::background::findShadows for planes in device memory.
void findShadows(const rg::background::ColourPlanes& picture,
                 const rg::background::ColourPlanes& background, const BitView& mask,
                 const BitTarget& shadow, Stream stream);

}  // namespace rg::gpu::background
