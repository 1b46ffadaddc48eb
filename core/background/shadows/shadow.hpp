// SPDX-License-Identifier: LGPL-2.1-or-later
// Cast shadows: places where the picture is the background, darker by a factor (paper, section
// 2.2.1: "shadows are removed").
//
// Determinism: integers only; each pixel looks at its own window.
#pragma once

#include "core/base/bit_mask.hpp"
#include "core/base/memory/executor.hpp"
#include "core/base/memory/image.hpp"

#include <cstdint>

namespace rg::background {

/// A picture to compare, or the background without objects. Grey ones have all planes alike.
struct ColourPlanes {
  ImageView<const uint8_t> red, green, blue;
};

/// Sets `shadow` where `mask` is set and the window of 5x5 around the pixel is explained by
/// one factor between 0.4 and 0.95 on the background and the colour agrees; clears it elsewhere.
/// The background is read no farther than two columns and two rows from the mask.
void findShadows(const ColourPlanes& picture, const ColourPlanes& background, const BitMask& mask,
                 const Executor& executor, BitMask& shadow);

}  // namespace rg::background
