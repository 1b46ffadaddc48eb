// SPDX-License-Identifier: LGPL-2.1-or-later
// Which regions move otherwise than the camera (part of stage 5).
//
// Vectors of small or plain regions are uncertain, so the pixels decide: the previous frame is
// shifted as the camera moved, and a region moves otherwise if another shift explains its pixels
// clearly better than none. Tried is the region's own vector, then for those that are not found to
// move the vector of the moving neighbour with the longest border: a part that no shift explains
// better goes with most of its border, unless it is the larger part. Ground that a mover has just
// left says nothing, as it was not to be seen before. All shifts are whole pixels away from the
// camera's, so that interpolation smooths the noise of both sides alike. Determinism: integer sums
// over pixels; rounds read the state before them.
#pragma once

#include "core/executor.hpp"
#include "core/image.hpp"
#include "core/region_motion.hpp"

#include <cstdint>
#include <vector>

namespace rg {

struct OwnMotionScratch {
  struct Trial {
    Point shift;          ///< Whole pixels, beyond the camera's; {} = none.
    uint64_t still = 0;   ///< Sum of absolute differences without the shift,
    uint64_t moved = 0;   ///< and with it,
    uint64_t pixels = 0;  ///< over so many pixels.
  };
  Image<uint8_t> expected;    ///< The previous frame as the camera's motion moves it.
  Image<uint16_t> hidden;     ///< Its pixels that a mover covered: the label of that, else 0;
                              ///< all 0 between measurements.
  std::vector<Point> shifts;  ///< Of each mover.
  std::vector<Trial> trials;
  std::vector<uint32_t> border, movingBorder, longest;  ///< Of each region, in pixels.
  std::vector<uint64_t> movingArea;                     ///< Of all its moving neighbours.
  std::vector<uint32_t> neighbour;                      ///< 1 + region at the longest; 0 = none.
};

struct OwnMotionRules {
  RegionMotion camera;
  int32_t threshold;  ///< Vectors that differ from the camera's by no more are the camera's, in
                      ///< 1/16 px.
};

/// previous: the luma that `motion` was measured against. Result: for each region 1 if it moves
/// otherwise, 0 if not. Cost: follows the pixels of the movers and of their neighbours; where no
/// vector differs from the camera's, nothing is compared.
void findOwnMotion(const Motion& motion, ImageView<const uint8_t> previous,
                   const OwnMotionRules& rules, const Executor& executor, OwnMotionScratch& scratch,
                   std::vector<uint8_t>& movesOtherwise);

}  // namespace rg
