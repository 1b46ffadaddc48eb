// SPDX-License-Identifier: LGPL-2.1-or-later
// Counterpart of core/base/picture.hpp.
#pragma once

#include "core/base/picture.hpp"
#include "kernels/launch.hpp"

namespace rg::gpu {

/// rg::loadPlanes for a frame and planes in device memory. The frame's rows may lie anywhere.
void loadPlanes(const Frame& frame, const PicturePlanes& to, Stream stream);

}  // namespace rg::gpu
