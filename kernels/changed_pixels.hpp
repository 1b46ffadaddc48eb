// SPDX-License-Identifier: LGPL-2.1-or-later
// Counterpart of core/background/changed_pixels.hpp (paper, section 2.1) for whole frames: what
// core does along a piece of a row, these do everywhere.
#pragma once

#include "core/background/changed_pixels.hpp"
#include "kernels/launch.hpp"
#include "kernels/views.hpp"

namespace rg::gpu::background {

/// rg::background::differ and measureChange: out is the largest difference of a channel.
void differ(const Planes& a, const Planes& b, ImageView<uint8_t> out, Stream stream);
void measureChange(const Planes& a, const Planes& b, ImageView<uint8_t> out, Stream stream);
void markChange(const Planes& a, const Planes& b, int threshold, ImageView<uint8_t> out,
                Stream stream);
void addStrange(const Planes& a, const Planes& b, int threshold, ImageView<const uint8_t> isKnown,
                ImageView<uint8_t> out, Stream stream);
/// rg::background::keepDense. Outside of the frame nothing is set. In and out must differ.
void keepDense(ImageView<const uint8_t> marked, ImageView<uint8_t> out, Stream stream);

}  // namespace rg::gpu::background
