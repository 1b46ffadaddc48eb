// SPDX-License-Identifier: LGPL-2.1-or-later
// Counterpart of core/motion/literal_search.hpp: all pixels of regions at every shift (paper,
// section 2.3 phase 2.1).
#pragma once

#include "core/base/run.hpp"
#include "core/motion/literal_search.hpp"
#include "kernels/launch.hpp"
#include "kernels/shift_search.hpp"
#include "kernels/views.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace rg::gpu::motion {

/// Runs firstRun … lastRun − 1 of a region: as many as a block of threads takes.
struct LiteralChunk {
  uint32_t region, firstRun, lastRun;
};

/// The chunks of regions, on the host.
struct LiteralList {
  std::vector<LiteralChunk> chunks;  ///< By region.
  std::vector<uint32_t> starts;      ///< Those of region i: starts[i] … starts[i + 1] − 1.

  /// The runs of region i: runs[runStarts[i]] … runs[runStarts[i + 1] − 1].
  void build(std::span<const Run> runs, std::span<const uint32_t> runStarts);
};

/// Runs and chunks in device memory.
struct LiteralRegions {
  const Run* runs;
  const LiteralChunk* chunks;
  const LiteralList& list;
  [[nodiscard]] int count() const { return static_cast<int>(list.starts.size()) - 1; }
};

/// Of regions first … first + count − 1, shiftsOf() the reach each, as rg::motion::sumAllShifts has
/// them.
struct RegionSpan {
  int first, count;
};
void sumAllShifts(const LiteralRegions& regions, RegionSpan of, ImageView<const uint8_t> luma,
                  const PaddedView& previous, int reach, unsigned long long* sums, Stream stream);

struct LiteralSums {
  unsigned long long* sums;
  int regions;                          ///< That there is room for: shiftsOf(range) of each.
  rg::motion::GradientSums* gradients;  ///< Of each region.
};
/// rg::motion::matchAllPixels of each region. previous: padded by the range's reach or more.
void matchAllPixels(const LiteralRegions& regions, ImageView<const uint8_t> luma,
                    const PaddedView& previous, const rg::motion::ShiftRange& range,
                    const LiteralSums& scratch, rg::motion::RegionMotion* motion, Stream stream);

}  // namespace rg::gpu::motion
