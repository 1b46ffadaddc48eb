// SPDX-License-Identifier: LGPL-2.1-or-later
// Counterpart of core/segmentation/hue_decision.hpp (paper, section 2.2.2).
#pragma once

#include "core/segmentation/hue_decision.hpp"
#include "kernels/launch.hpp"
#include "kernels/views.hpp"

namespace rg::gpu::segmentation {

/// rg::segmentation::classifyHues. Channels: red, green, blue. raw is scratch.
void classifyHues(const Planes& picture, const rg::segmentation::HueBands& bands,
                  ImageView<const uint8_t> scope, ImageView<uint8_t> raw,
                  ImageView<uint8_t> classes, Stream stream);

/// rg::segmentation::findFrameBand, to device memory. Channels: red, green, blue; of a grey picture
/// no band. levels: kHueCount counts, scratch.
void findFrameBand(const Planes& picture, uint32_t* levels, rg::segmentation::HueBand* band,
                   Stream stream);

}  // namespace rg::gpu::segmentation
