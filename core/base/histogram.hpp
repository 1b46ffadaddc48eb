// SPDX-License-Identifier: LGPL-2.1-or-later
// Thresholds that follow from a histogram of 256 grey levels (paper, section 2.1: "dynamic
// threshold"). Integers only: counts commute, so any order of counting gives the same threshold.
#pragma once

#include "core/base/memory/executor.hpp"
#include "core/base/memory/image.hpp"

#include <array>
#include <cstdint>

namespace rg {

using Histogram = std::array<uint32_t, 256>;

[[nodiscard]] Histogram countLevels(ImageView<const uint8_t> image, const Executor& executor);

/// Lowest level that at least `share` of 256 of the pixels do not exceed; 0 without pixels.
[[nodiscard]] int quantile(const Histogram& histogram, int share);

/// Threshold for a picture of absolute differences, most of which are noise: the corner of the
/// histogram (Rosin), which is the level below the line from its peak to its last level by most;
/// but never under three times the median noise, nor under `least`. 0 … 255.
[[nodiscard]] int differenceThreshold(const Histogram& histogram, int least);

/// Threshold for differences between pictures that have this histogram of grey levels: an eighth of
/// the range of the middle 80 % of its pixels, so that it follows light and contrast, but never
/// under `least`. 0 … 255.
[[nodiscard]] int contrastThreshold(const Histogram& histogram, int least);

}  // namespace rg
