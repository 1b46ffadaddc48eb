// SPDX-License-Identifier: LGPL-2.1-or-later
// Counterpart of core/segmentation/scopes.hpp.
#pragma once

#include "core/segmentation/scopes.hpp"
#include "kernels/components.hpp"
#include "kernels/launch.hpp"
#include "kernels/views.hpp"

namespace rg::gpu::segmentation {

/// Areas as components of a mask; how many there are is in device memory.
struct AreasView {
  const Component* list;
  const uint32_t* count;
};
void coverAreas(const AreasView& areas, uint8_t around, ImageView<uint8_t> scope, Stream stream);
void scopeByHue(ImageView<const uint8_t> hue, ImageView<const uint8_t> evidence,
                ImageView<const uint8_t> scope, ImageView<uint8_t> out, Stream stream);

}  // namespace rg::gpu::segmentation
