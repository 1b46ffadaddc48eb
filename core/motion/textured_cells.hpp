// SPDX-License-Identifier: LGPL-2.1-or-later
// Which of a large region's matched blocks its motion is looked for with (part of stage 4): the
// paper's "presence of gradients".
//
// What a flat cell adds to a sum of absolute differences is noise, and a few hundred pixels with
// texture tell a motion as well as all do: so what a region costs has a bound, whatever the size of
// the frame. Cells of 8x8 pixels are kept by classes of their mean squared gradient, each four
// times the one below; those of a class evenly over the region.
// Determinism: integers; the order within a class is a fixed one of the cells' places.
#pragma once

#include "core/base/memory/image.hpp"
#include "core/motion/fit_sums.hpp"
#include "core/motion/matched_part.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace rg::motion {

/// Cells are kept until they hold so many matched pixels.
inline constexpr uint32_t kEnoughPx = 768;

/// What a thread needs; reused from region to region.
struct TextureScratch {
  std::vector<uint64_t> ranks;
  std::vector<GradientProducts> gradients;  ///< By cell, those without blocks as well.
};

/// Removes blocks from the parts of one region, those of whole cells, until what is left is enough;
/// parts may be left without any. luma: of the frame that the region is in. Returns the sums over
/// what is left.
GradientProducts keepTextured(ImageView<const uint8_t> luma, std::span<MatchedPart> parts,
                              TextureScratch& scratch);

}  // namespace rg::motion
