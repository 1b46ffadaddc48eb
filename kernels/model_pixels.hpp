// SPDX-License-Identifier: LGPL-2.1-or-later
// What the consensus model says of a pixel; for .cu files only.
#pragma once

#include "core/base/pixel.hpp"
#include "kernels/consensus_background.hpp"
#include "kernels/device.hpp"

namespace rg::gpu::background {

/// rg::background::radiusAt of a pixel of this brightness.
__device__ inline int radiusAt(const ModelView& model, const rg::background::Tolerance& tolerance,
                               int brightness, Point p) {
  return rg::background::radiusOf(tolerance.least + (brightness * tolerance.brightness >> 8),
                                  model.noise.at(p.x, p.y), model.unrest.at(p.x, p.y));
}

/// rg::background::modelledLevel of a pixel.
__device__ inline int modelledLevel(const ModelView& model, Point p, int channel) {
  return rg::background::modelledLevel(
      [&](int sample) { return +*model.sample(p, sample, channel); });
}

}  // namespace rg::gpu::background
