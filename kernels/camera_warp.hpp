// SPDX-License-Identifier: LGPL-2.1-or-later
// Counterpart of core/base/camera/camera_warp.hpp.
#pragma once

#include "core/base/camera/camera_warp.hpp"
#include "kernels/launch.hpp"
#include "kernels/views.hpp"

#include <cstdint>

namespace rg::gpu {

/// expected: of the size of `previous`. shown: one for each row. camera.isSafe().
void warpByCamera(ImageView<const uint8_t> previous, const CameraMotion& camera,
                  ImageView<uint8_t> expected, ShownRange* shown, Stream stream);

}  // namespace rg::gpu
