// SPDX-License-Identifier: LGPL-2.1-or-later
// Which regions of one segmentation are regions of another one, pixel by pixel.
#pragma once

#include "core/segmentation/segmentation.hpp"

#include <vector>

namespace rg::test {

struct RegionMatch {
  uint32_t whole = 0;  ///< Regions of `part` that no pixel without a label touches.
  uint32_t same = 0;   ///< Of those, the ones with the very same pixels in `all`.
};

/// Compares the regions of `part` that end before its scope does with those of `all`.
inline RegionMatch matchRegions(const segmentation::Labels& part, const segmentation::Labels& all) {
  const Size size = part.size;
  std::vector<uint8_t> isCut(part.count + 1u, 0), isMixed(part.count + 1u, 0);
  std::vector<uint32_t> partner(part.count + 1u, 0), areas(part.count + 1u, 0);
  std::vector<uint32_t> allAreas(all.count + 1u, 0);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) {
      const uint32_t id = part.ids.at(x, y), other = all.ids.at(x, y);
      ++allAreas[other];
      if (id == segmentation::kNoRegion) continue;
      if (areas[id]++ == 0) partner[id] = other;
      if (partner[id] != other) isMixed[id] = 1;
      for (const Point p : {Point{x - 1, y}, {x + 1, y}, {x, y - 1}, {x, y + 1}})
        if (boundsOf(size).contains(p) && part.ids.at(p.x, p.y) == segmentation::kNoRegion)
          isCut[id] = 1;
    }
  RegionMatch match;
  for (uint32_t id = 1; id <= part.count; ++id) {
    if (isCut[id] != 0) continue;
    ++match.whole;
    match.same += isMixed[id] == 0 && areas[id] == allAreas[partner[id]];
  }
  return match;
}

}  // namespace rg::test
