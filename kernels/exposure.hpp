// SPDX-License-Identifier: LGPL-2.1-or-later
// Counterpart of core/background/light/exposure.hpp. The gain follows from the sums on the host:
// rg::background::medianGain.
#pragma once

#include "core/background/light/exposure.hpp"
#include "kernels/consensus_background.hpp"
#include "kernels/launch.hpp"
#include "kernels/views.hpp"

namespace rg::gpu::background {

void sumGains(const Planes& picture, const ModelView& model, rg::background::GainSums* sums,
              Stream stream);
void mapLevels(const rg::background::LevelMap& map, const PlaneTargets& picture, Stream stream);

}  // namespace rg::gpu::background
