// SPDX-License-Identifier: LGPL-2.1-or-later
// Hues and scopes of pixels; for .cu files only.
#pragma once

#include "core/base/row_spans.hpp"
#include "core/segmentation/hue.hpp"
#include "kernels/device.hpp"
#include "kernels/views.hpp"

namespace rg::gpu::segmentation {

/// rg::segmentation::hueOf by a division: core's table is no memory of the device.
__device__ inline int hueAt(const Planes& picture, Point p) {
  const auto reciprocalOf = [](int chroma) {
    constexpr int kOne = rg::segmentation::kHueSextant << 16;
    return (kOne + chroma / 2) / chroma;
  };
  return rg::segmentation::hueBy(picture.planes[0].at(p.x, p.y), picture.planes[1].at(p.x, p.y),
                                 picture.planes[2].at(p.x, p.y), reciprocalOf);
}

__device__ inline bool isInScope(ImageView<const uint8_t> scope, Point p) {
  return scope.data == nullptr || rg::isInScope(scope.at(p.x, p.y));
}

}  // namespace rg::gpu::segmentation
