// SPDX-License-Identifier: LGPL-2.1-or-later
// The pixels of regions as runs along the rows: what works on a region walks those, so that its
// cost follows the region's pixels and not its box.
#pragma once

#include "core/base/run.hpp"

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

namespace rg::graph {

/// How far from `begin` on, at most to `end`, a row's values are those of its begin. Long runs are
/// passed by four values at a time.
[[nodiscard]] inline int endOfRun(const uint16_t* row, int begin, int end) {
  const uint16_t value = row[begin];
  const uint64_t four = value * uint64_t{0x0001'0001'0001'0001};
  int at = begin + 1;
  for (uint64_t next = 0; at + 4 <= end; at += 4) {
    std::memcpy(&next, row + at, sizeof next);
    if (next != four) break;
  }
  while (at < end && row[at] == value) ++at;
  return at;
}

struct RegionRuns {
  std::vector<Run> list;         ///< By region, then by row, then by column; none
                                 ///< goes on to either side.
  std::vector<uint32_t> starts;  ///< Those of region i: starts[i] … starts[i + 1] − 1.

  [[nodiscard]] std::span<const Run> of(size_t region) const {
    return {list.data() + starts[region], starts[region + 1] - starts[region]};
  }
};

}  // namespace rg::graph
