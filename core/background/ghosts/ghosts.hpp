// SPDX-License-Identifier: LGPL-2.1-or-later
// Foreground that does not change: what has stopped, and ghosts, which are places that something
// has left while the model still shows it.
//
// Determinism: per pixel, and sums over components (core/base/components.hpp). Integers only.
#pragma once

#include "core/background/models/consensus_background.hpp"
#include "core/base/components.hpp"
#include "core/base/memory/executor.hpp"
#include "core/base/memory/image.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace rg::background {

/// The colour that a foreground pixel keeps and for how many frames it has kept it.
struct StillPixels {
  std::array<Image<uint8_t>, 3> colours;
  Image<uint16_t> ages;  ///< 0: background, or just changed. Whole words.
  BitMask aged;          ///< Where ages are not 0.
  Image<uint8_t> fresh;  ///< Frames for which a dissolved ghost's place is no witness; 0: it is.
  std::vector<uint8_t> freshRows;  ///< Of each row: the most frames of its pixels.
};

void prepare(Size size, int channels, StillPixels& still);
/// Forgets all.
void clear(StillPixels& still);

/// Ages pixels of `foreground` whose colour stays within the model's radius, ages the others
/// backwards.
void followStill(const SmoothPicture& picture, const ConsensusBackground& model,
                 const Tolerance& tolerance, const BitMask& foreground, const Executor& executor,
                 StillPixels& still);

/// Of one part: edges across its contour, summed over the pixels where they could be read.
struct ContourSums {
  int64_t inPicture = 0, inModel = 0;
  int64_t readPixels = 0, allPixels = 0;
};

struct StillScratch {
  BitMask still;  ///< Foreground that is old enough.
  Components parts;
  std::vector<uint8_t> isGhost;
  std::vector<ContourSums> contours;
};

/// Sets `ghosts` on the 8-connected parts of still foreground, at least `leastAge` frames
/// old, whose contour towards the background shows an edge in the model rather than in the
/// picture; clears it elsewhere. Returns the number of their pixels.
uint32_t findGhosts(const SmoothPicture& picture, const ConsensusBackground& model,
                    const BitMask& foreground, StillPixels& still, int leastAge,
                    StillScratch& scratch, BitMask& ghosts);

}  // namespace rg::background
