// SPDX-License-Identifier: LGPL-2.1-or-later
// Counterpart of core/background/models/gaussian_background.hpp (paper, section 2.2.1).
#pragma once

#include "core/background/models/gaussian_background.hpp"
#include "kernels/launch.hpp"
#include "kernels/views.hpp"

namespace rg::gpu::background {

/// rg::background::GaussianBackground in device memory.
struct GaussianView {
  PlanesOf<uint16_t> means, variances;
  PlanesOf<uint32_t> sums, squares;
};

void train(const Planes& picture, const GaussianView& model, Stream stream);
void finishTraining(int trainedFrames, const GaussianView& model, Stream stream);

/// Fs and Fg: 0 or 255.
struct GaussianTests {
  ImageView<uint8_t> simple, gaussian;
};
void testGaussian(const Planes& picture, const GaussianView& model, int threshold,
                  const GaussianTests& out, Stream stream);
void updateGaussian(const Planes& picture, ImageView<const uint8_t> foreground,
                    const rg::background::UpdateRates& rates, const GaussianView& model,
                    Stream stream);
void paintMean(const GaussianView& model, const PlaneTargets& out, Stream stream);

}  // namespace rg::gpu::background
