// SPDX-License-Identifier: LGPL-2.1-or-later
// Windows that see the same thing, brought together.
#pragma once

#include "core/base/geometry.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace rg::detection {

/// What was found: the mean of windows that lie near each other.
struct Detection {
  Box box;
  int windows = 0;  ///< How many of them.
  friend bool operator==(const Detection&, const Detection&) = default;
};

/// More windows than these are not grouped; the first count.
inline constexpr size_t kMostGrouped = 4096;

/// Unites windows whose four sides are nearer to each other than a fifth of the mean of the smaller
/// width and the smaller height, and what these are near to; edges are means, rounded. Groups of
/// fewer than `least` windows are left out, and those that lie in another one with more windows
/// (its sides a fifth out). Sorted by row and column. least = 0: each window by itself, as it is.
/// Integers throughout: the same for any order of windows that are not more than kMostGrouped.
void groupWindows(std::span<const Box> windows, int least, std::vector<Detection>& groups);

}  // namespace rg::detection
