// SPDX-License-Identifier: LGPL-2.1-or-later
// Counterpart of core/base/bit_mask.hpp.
#pragma once

#include "kernels/launch.hpp"
#include "kernels/views.hpp"

namespace rg::gpu {

void countSet(const BitView& mask, uint32_t* count, Stream stream);
/// Of core/base/row_spans.hpp.
void keepInside(ImageView<const uint8_t> interest, ImageView<uint8_t> scope, Stream stream);
void packEqual(ImageView<const uint8_t> bytes, uint8_t value, const BitTarget& mask, Stream stream);
void paint(const BitView& mask, uint8_t value, ImageView<uint8_t> bytes, Stream stream);
void remove(const BitView& b, const BitTarget& a, Stream stream);
void keepOnly(const BitView& b, const BitTarget& a, Stream stream);
/// Sets in `a` what is set in `b`.
void add(const BitView& b, const BitTarget& a, Stream stream);
/// margin 1 … 63. In and out must differ.
void thicken(const BitView& mask, int margin, const BitTarget& out, Stream stream);

}  // namespace rg::gpu
