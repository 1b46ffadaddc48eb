// SPDX-License-Identifier: LGPL-2.1-or-later
// Counterpart of core/objects/merge/region_comparison.hpp.
#pragma once

#include "core/objects/merge/region_comparison.hpp"
#include "kernels/launch.hpp"
#include "kernels/views.hpp"

#include <cstdint>

namespace rg::gpu::objects {

using rg::objects::OwnMotionScratch;

/// What is to be known of a region.
struct ComparedRegion {
  Point shift;    ///< That is tried; {} = none.
  Point covered;  ///< By how much it moves, if it does.
  Box box;
  uint8_t moves = 0;
  uint8_t mostLevels = 255;  ///< That the difference of a pixel counts, the same for all regions:
                             ///< here, as what changes in a kernel's arguments updates its graph.
};

/// labels: 1 … count, 0: none. expected and shown: as warpByCamera() writes them.
struct ComparedPictures {
  ImageView<const uint16_t> labels;
  ImageView<const uint8_t> luma, expected;
  const ShownRange* shown;
};
struct RegionList {
  const ComparedRegion* list;
  int count;
  int everyRow = 1;
  bool hidesAny = false;
};
/// bands: kBands for each region.
struct ComparisonView {
  uint32_t* hidden;  ///< One for each pixel, row by row; unused where nothing is hidden.
  OwnMotionScratch::Sums* bands;
  OwnMotionScratch::Trial* trials;  ///< One for each region.
};
void compareRegions(const ComparedPictures& pictures, const RegionList& regions,
                    const ComparisonView& out, Stream stream);

}  // namespace rg::gpu::objects
