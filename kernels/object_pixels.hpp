// SPDX-License-Identifier: LGPL-2.1-or-later
// Counterpart of core/objects/tracking/looks/object_pixels.hpp.
#pragma once

#include "core/objects/tracking/looks/object_pixels.hpp"
#include "kernels/launch.hpp"
#include "kernels/views.hpp"

#include <cstdint>

namespace rg::gpu::objects {

/// Who owns the pixels of regions that are no background. Channels: red, green, blue.
struct OwnedPixels {
  ImageView<const uint16_t> labels;
  const uint8_t* isBackground;  ///< Of each region.
  const uint16_t* owners;       ///< Of each cell, row by row: 1 + track, 0 = none.
  int stepPx, cellsPerRow;
  Planes picture;
};
/// sums and firsts: one for each of `count` tracks.
struct ObjectPixelsView {
  ImageView<uint16_t> slots;
  rg::objects::ObjectSums* sums;
  uint32_t* firsts;
  int count;
};
void findObjectPixels(const OwnedPixels& owned, const ObjectPixelsView& out, Stream stream);

}  // namespace rg::gpu::objects
