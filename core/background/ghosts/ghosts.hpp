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
#include "core/base/pixel.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace rg::background {

/// How long something has kept its colour, in 16 bits: up to kFineAges frames one by one, from
/// there on only every coarseFrames-th frame counts, so that the longest time that is asked for
/// fits.
struct AgeScale {
  static constexpr int64_t kFineAges = 32768, kCoarseAges = 32000;
  int64_t coarseFrames = 1;

  /// For times of up to so many frames.
  [[nodiscard]] static constexpr AgeScale upTo(int64_t frames) {
    return {std::max<int64_t>(1, (frames - kFineAges + kCoarseAges - 1) / kCoarseAges)};
  }
  [[nodiscard]] constexpr int64_t ageOf(int64_t frames) const {
    return frames <= kFineAges ? frames : kFineAges + (frames - kFineAges) / coarseFrames;
  }
  /// Up to which age pixels may grow in this frame.
  [[nodiscard]] constexpr uint16_t mostAge(uint32_t frame) const {
    return static_cast<uint16_t>(frame % coarseFrames == 0 ? UINT16_MAX : kFineAges);
  }
};

/// The colour that a foreground pixel keeps and for how long it has kept it.
struct StillPixels {
  std::array<Image<uint8_t>, 3> colours;
  Image<uint16_t> ages;  ///< AgeScale; 0: background, or just changed. Whole words.
  BitMask aged;          ///< Where ages are not 0.
  Image<uint8_t> fresh;  ///< Frames for which a dissolved ghost's place is no witness; 0: it is.
  std::vector<uint8_t> freshRows;  ///< Of each row: the most frames of its pixels.
};

void prepare(Size size, int channels, StillPixels& still);
/// Forgets all.
void clear(StillPixels& still);

/// Ages pixels of `foreground` whose colour stays within the model's radius, ages the others
/// backwards. No age grows beyond mostAge.
void followStill(const SmoothPicture& picture, const ConsensusBackground& model,
                 const Tolerance& tolerance, const BitMask& foreground, uint16_t mostAge,
                 const Executor& executor, StillPixels& still);

/// Of one part: edges across its contour, summed over the pixels where they could be read.
struct ContourSums {
  int64_t inPicture = 0, inModel = 0;
  int64_t readPixels = 0, allPixels = 0;
};

/// The largest difference of a channel between two places; levelAt(place, channel).
template <class LevelAt>
[[nodiscard]] constexpr int edgeBetween(int channels, Point a, Point b, const LevelAt& levelAt) {
  int most = 0;
  for (int c = 0; c < channels; ++c) most = std::max(most, absDiff(levelAt(a, c), levelAt(b, c)));
  return most;
}

/// Whether the contour of a still part is an edge in the model rather than in the picture.
[[nodiscard]] constexpr bool isGhostly(const ContourSums& sums) {
  constexpr int64_t kLeastContour = 6;  // Contour pixels that a verdict needs.
  constexpr int64_t kLeastShare = 100;  // Of 256: share of the contour that must be readable.
  constexpr int64_t kLeastEdge = 12;    // Half grey levels by which the model's edge must lead.
  const bool isWitnessed =
      sums.readPixels >= kLeastContour && sums.readPixels * 256 >= sums.allPixels * kLeastShare;
  return isWitnessed && 2 * sums.inModel > 3 * sums.inPicture + kLeastEdge * sums.readPixels;
}

/// Frames for which a dissolved ghost's place is no witness.
inline constexpr uint8_t kFreshFrames = 250;

struct StillScratch {
  BitMask still;  ///< Foreground that is old enough.
  Components parts;
  std::vector<uint8_t> isGhost;
  std::vector<ContourSums> contours;
};

/// Sets in `places` the pixels of `foreground` that are at least `leastAge` old.
void addAged(const BitMask& foreground, const StillPixels& still, int64_t leastAge,
             BitMask& places);

/// Sets `ghosts` on the 8-connected parts of still foreground, at least `leastAge` frames
/// old, whose contour towards the background shows an edge in the model rather than in the
/// picture; clears it elsewhere. Returns the number of their pixels.
uint32_t findGhosts(const SmoothPicture& picture, const ConsensusBackground& model,
                    const BitMask& foreground, StillPixels& still, int leastAge,
                    StillScratch& scratch, BitMask& ghosts);

}  // namespace rg::background
