// SPDX-License-Identifier: LGPL-2.1-or-later
// Foreground that does not change: what has stopped, and ghosts, which are places that something
// has left while the model still shows it.
//
// Determinism: per pixel, and sums over components (core/components.hpp). Integers only.
#pragma once

#include "core/components.hpp"
#include "core/consensus_background.hpp"
#include "core/executor.hpp"
#include "core/image.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace rg {

/// The colour that a foreground pixel keeps and for how many frames it has kept it.
struct StillPixels {
  std::array<Image<uint8_t>, 3> colours;
  Image<uint16_t> ages;  ///< 0: background, or just changed.
  Image<uint8_t> fresh;  ///< Frames for which a dissolved ghost's place is no witness; 0: it is.
};

void prepare(Size size, int channels, StillPixels& still);

/// Ages pixels of `foreground` whose colour stays within `radii`, ages the others backwards.
void followStill(const SmoothPicture& picture, ImageView<const uint8_t> foreground,
                 ImageView<const uint8_t> radii, const Executor& executor, StillPixels& still);

/// Of one part: edges across its contour, summed over the pixels where they could be read.
struct ContourSums {
  int64_t inPicture = 0, inModel = 0;
  int64_t readPixels = 0, allPixels = 0;
};

struct StillScratch {
  Image<uint8_t> still;  ///< 255 where a foreground pixel is old enough.
  Components parts;
  std::vector<uint8_t> isGhost;
  std::vector<ContourSums> contours;
};

/// Sets `ghosts` to 255 on the 8-connected parts of still foreground, at least `leastAge` frames
/// old, whose contour towards the background shows an edge in the model rather than in the
/// picture; to 0 elsewhere. Returns the number of their pixels.
uint32_t findGhosts(const SmoothPicture& picture, const ConsensusBackground& model,
                    ImageView<const uint8_t> foreground, StillPixels& still, int leastAge,
                    StillScratch& scratch, ImageView<uint8_t> ghosts);

}  // namespace rg
