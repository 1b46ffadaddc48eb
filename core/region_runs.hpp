// SPDX-License-Identifier: LGPL-2.1-or-later
// The pixels of regions as runs along the rows: what works on a region walks those, so that its
// cost follows the region's pixels and not its box.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace rg {

/// Pixels begin … end − 1 of row y, all of one region, that go on to neither side.
struct RegionRun {
  uint16_t y = 0;
  uint16_t begin = 0;
  uint16_t end = 0;
  friend constexpr bool operator==(const RegionRun&, const RegionRun&) = default;
};

struct RegionRuns {
  std::vector<RegionRun> list;   ///< By region, then by row, then by column.
  std::vector<uint32_t> starts;  ///< Those of region i: starts[i] … starts[i + 1] − 1.

  [[nodiscard]] std::span<const RegionRun> of(size_t region) const {
    return {list.data() + starts[region], starts[region + 1] - starts[region]};
  }
};

}  // namespace rg
