// SPDX-License-Identifier: LGPL-2.1-or-later
// Counterpart of core/background/light/light_switch.hpp. Maps follow from two histograms of 256
// levels, one level after the other: rg::background::matchLevels, on the host.
#pragma once

#include "core/background/light/light_switch.hpp"
#include "kernels/consensus_background.hpp"
#include "kernels/launch.hpp"
#include "kernels/views.hpp"

namespace rg::gpu::background {

/// shown: the model as a picture.
struct LitPictures {
  Planes shown, picture;
};
void countApart(const LitPictures& pictures, const rg::background::LevelMaps& maps,
                const ModelView& model, const rg::background::Tolerance& tolerance,
                uint32_t* pixels, Stream stream);
void relight(const rg::background::LevelMaps& maps, const ModelView& model, Stream stream);

}  // namespace rg::gpu::background
