// SPDX-License-Identifier: LGPL-2.1-or-later
// Differences of two pictures along pieces of rows (paper, section 2.1). Per pixel only.
#pragma once

#include "core/background/shadows/shadow.hpp"
#include "core/base/memory/image.hpp"
#include "core/base/picture.hpp"
#include "core/base/run.hpp"

#include <cstdint>

namespace rg::background {

[[nodiscard]] ColourPlanes planesOf(const Picture& picture);

/// Rows first, first + step, … of all planes, as pictures of fewer rows.
[[nodiscard]] ImageView<const uint8_t> everyRow(ImageView<const uint8_t> plane, int first,
                                                int step);
[[nodiscard]] ColourPlanes everyRow(const ColourPlanes& planes, int first, int step);

/// out[x]: largest absolute difference of a channel. Both pictures have the same size.
void measureChange(const ColourPlanes& a, const ColourPlanes& b, const Run& at, uint8_t* out);

/// out[x]: 255 where that difference is above `threshold`, else 0. threshold 0 … 255.
void markChange(const ColourPlanes& a, const ColourPlanes& b, const Run& at, int threshold,
                uint8_t* out);

/// Sets out[x] to 255 where the difference is above `threshold` and isKnown[x] is 255, too.
void addStrange(const ColourPlanes& a, const ColourPlanes& b, const Run& at, int threshold,
                const uint8_t* isKnown, uint8_t* out);

inline constexpr int kLeastDense = 4;
/// Columns of `at`: out[x] is 255 where at least kLeastDense of the square of 3x3 around the pixel
/// are 255, else 0. The rows hold 0 or 255 and can be read one column to the left and right.
void keepDense(const uint8_t* above, const uint8_t* row, const uint8_t* below, const Run& at,
               uint8_t* out);

}  // namespace rg::background
