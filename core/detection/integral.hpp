// SPDX-License-Identifier: LGPL-2.1-or-later
// Sums of pixels above and to the left of each place, of which four give the sum in any rectangle.
#pragma once

#include "core/base/geometry.hpp"
#include "core/base/memory/image.hpp"

#include <cstdint>

namespace rg::detection {

/// Planes with a column and a row more than the picture: at (x, y) the sum of the pixels of columns
/// below x and rows below y. Sums of levels go round at 2^32; those of squared levels are whole
/// numbers below 2^53.
struct Integrals {
  ImageView<uint32_t> sums;
  ImageView<double> squares;
};

/// Of the pixels in an area, at their places in planes for the whole picture: what is left of it or
/// above counts as nothing. Writes the area's columns and rows and the ones behind them.
void sumArea(ImageView<const uint8_t> luma, const Box& area, const Integrals& to);

/// Of the whole picture.
void sumIntegrals(ImageView<const uint8_t> luma, const Integrals& to);

}  // namespace rg::detection
