// SPDX-License-Identifier: LGPL-2.1-or-later
// Counterpart of core/background/shadows/shadow.hpp (paper, section 2.2.1).
#pragma once

#include "core/background/shadows/shadow.hpp"
#include "kernels/launch.hpp"
#include "kernels/views.hpp"

namespace rg::gpu::background {

/// Of a grey picture's, its one channel thrice.
[[nodiscard]] inline rg::background::ColourPlanes coloursOf(const Planes& from) {
  const bool isGrey = from.channels == 1;
  return {from.planes[isGrey ? 0 : 1], from.planes[0], from.planes[isGrey ? 0 : 2]};
}

/// rg::background::findShadows for planes in device memory.
void findShadows(const rg::background::ColourPlanes& picture,
                 const rg::background::ColourPlanes& background, const BitView& mask,
                 const BitTarget& shadow, Stream stream);

}  // namespace rg::gpu::background
