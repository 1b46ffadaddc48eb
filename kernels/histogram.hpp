// SPDX-License-Identifier: LGPL-2.1-or-later
// Counterpart of core/base/histogram.hpp.
#pragma once

#include "core/base/histogram.hpp"
#include "kernels/launch.hpp"

namespace rg::gpu {

/// rg::countLevels. levels: 256 counts.
void countLevels(ImageView<const uint8_t> image, uint32_t* levels, Stream stream);

}  // namespace rg::gpu
