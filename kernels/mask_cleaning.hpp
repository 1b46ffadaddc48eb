// SPDX-License-Identifier: LGPL-2.1-or-later
// Counterpart of core/background/mask_cleaning.hpp.
#pragma once

#include "kernels/components.hpp"
#include "kernels/launch.hpp"
#include "kernels/views.hpp"

#include <cstdint>

namespace rg::gpu::background {

void keepMajority(const BitView& mask, int radius, int share, const BitTarget& out, Stream stream);
void dropSmallParts(const BitTarget& mask, uint32_t leastPx, const ComponentsView& scratch,
                    Stream stream);
void fillHoles(const BitTarget& mask, uint32_t mostPx, const ComponentsView& scratch,
               Stream stream);
void keepSupported(const BitTarget& mask, const BitView& strong, uint32_t leastPx,
                   const ComponentsView& scratch, Stream stream);
void paintForeground(const BitView& mask, const BitView& shadow, Point shift,
                     ImageView<uint8_t> out, Stream stream);

}  // namespace rg::gpu::background
