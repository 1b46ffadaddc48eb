// SPDX-License-Identifier: LGPL-2.1-or-later
// From sums over a region's pixels to its description: the arithmetic that every backend shares
// (part of stage 3).
#pragma once

#include "core/base/pixel.hpp"
#include "core/graph/graph.hpp"

#include <algorithm>
#include <cstdint>

namespace rg::graph {

struct RegionSums {
  uint64_t x = 0, y = 0, red = 0, green = 0, blue = 0;
  uint32_t areaPx = 0;
  int32_t left = INT32_MAX, right = 0, top = INT32_MAX, bottom = 0;  // right, bottom: exclusive.
  uint32_t runs = 0;  ///< Their number; then where the next one goes in the graph.
};

constexpr void add(RegionSums& to, const RegionSums& from) {
  to.x += from.x;
  to.y += from.y;
  to.red += from.red;
  to.green += from.green;
  to.blue += from.blue;
  to.areaPx += from.areaPx;
  to.left = std::min(to.left, from.left);
  to.right = std::max(to.right, from.right);
  to.top = std::min(to.top, from.top);
  to.bottom = std::max(to.bottom, from.bottom);
  to.runs += from.runs;
}

[[nodiscard]] constexpr Region describe(const RegionSums& sums) {
  constexpr int kCentroidFraction = 256;
  const auto area = int64_t{sums.areaPx};
  const auto mean = [&](uint64_t sum) {
    return static_cast<uint8_t>(divideRounded(static_cast<int64_t>(sum), area));
  };
  const auto centre = [&](uint64_t sum) {
    return static_cast<int32_t>(divideRounded(static_cast<int64_t>(sum) * kCentroidFraction, area));
  };
  return {sums.areaPx,
          {sums.left, sums.top, sums.right - sums.left, sums.bottom - sums.top},
          centre(sums.x),
          centre(sums.y),
          {mean(sums.red), mean(sums.green), mean(sums.blue)}};
}

}  // namespace rg::graph
