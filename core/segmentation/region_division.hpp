// SPDX-License-Identifier: LGPL-2.1-or-later
// From linked runs to numbered regions: small ones are absorbed, the rest gets labels (part of
// stage 2).
//
// Determinism: components are numbered in raster order, sums commute, absorption runs in
// synchronous rounds. Regions count from 1 in the raster order of their first pixels.
#pragma once

#include "core/base/memory/executor.hpp"
#include "core/base/memory/image.hpp"
#include "core/segmentation/absorption.hpp"
#include "core/segmentation/colour_cells.hpp"
#include "core/segmentation/pixel_runs.hpp"

#include <cstdint>
#include <vector>

namespace rg::segmentation {

/// Of the least area between rounds: pieces that the pixels at a border left mostly touch one
/// region only, and the order in which they go matters less.
inline constexpr uint32_t kPieceGrowth = 16;

class RegionDivision {
 public:
  struct Limits {
    uint32_t minAreaPx = 1;
    uint32_t maxRegions = 1024;  ///< Up to 65535.
  };

  /// Writes the region of every pixel or cell of `planes`, which `runs` belong to: 1 … count, or 0
  /// out of scope. Where parts that touch nothing are more than allowed, the smallest get 0, too.
  /// Returns count.
  uint32_t run(const ColourGrid& planes, const PixelRuns& runs, const Limits& limits,
               const Executor& executor, ImageView<uint16_t> ids);

  /// The same for the parts of equal labels that `runs` are, where the labels in `ids` are those of
  /// `first`, moved a little: each part has the mean colour of its label's region.
  uint32_t runAgain(const RegionDivision& first, const ColourGrid& planes, const PixelRuns& runs,
                    const Limits& limits, const Executor& executor, ImageView<uint16_t> ids);

 private:
  uint32_t divide(const AbsorptionLimits& limits, const Executor& executor,
                  ImageView<uint16_t> ids);
  void sumParts(const Executor& executor);
  void addRow(int y);
  void collectBorders();
  uint32_t numberRegions(uint32_t maxRegions);
  void writeRow(int y, uint16_t* ids) const;

  ColourGrid planes_;
  const PixelRuns* runs_ = nullptr;
  struct Sums {
    uint32_t red = 0, green = 0, blue = 0;  // Of a band's pixels: 255 · 2^14 · 64 < 2^32.
    uint32_t areaPx = 0;
  };
  std::vector<Sums> sums_;  ///< Of each part, at its first run.
  Absorption absorption_;
  std::vector<AbsorbedRegion> labelled_;  ///< What is left, by label.
  std::vector<uint32_t> numbers_;
  std::vector<uint64_t> order_;
};

}  // namespace rg::segmentation
