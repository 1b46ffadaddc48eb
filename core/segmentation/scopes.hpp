// SPDX-License-Identifier: LGPL-2.1-or-later
// Scope planes (core/base/row_spans.hpp): which pixels are divided into regions (part of stage 2).
#pragma once

#include "core/base/geometry.hpp"
#include "core/base/memory/image.hpp"

#include <cstdint>
#include <span>

namespace rg::segmentation {

/// kInScope where areas cover the frame (coverOf), else `around`.
void coverAreas(std::span<const Box> areas, uint8_t around, ImageView<uint8_t> scope);

/// What hue (hue_decision.hpp) leaves of a scope, which without data is all: what is of an object
/// and, where hue says nothing, what `evidence` has as foreground, if it has data.
void scopeByHue(ImageView<const uint8_t> hue, ImageView<const uint8_t> evidence,
                ImageView<const uint8_t> scope, ImageView<uint8_t> out);

}  // namespace rg::segmentation
