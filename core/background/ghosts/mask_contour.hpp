// SPDX-License-Identifier: LGPL-2.1-or-later
// Where a foreground part ends: faint evidence beside a sure part belongs to it, and pixels at its
// border that the smoothing of the picture has drawn in do not.
//
// Determinism: integers, each pixel by itself; the same bits for any number of threads.
#pragma once

#include "core/background/ghosts/drawn_border.hpp"
#include "core/background/mask_cleaning.hpp"
#include "core/background/models/consensus_background.hpp"
#include "core/base/bit_mask.hpp"
#include "core/base/memory/executor.hpp"
#include "core/base/picture.hpp"

#include <array>

namespace rg::background {

struct ContourScratch {
  BitMask across, near, candidates;
};

/// What is looked at, and the model as a picture, of which only parts get painted.
struct FaintEvidence {
  const SmoothPicture& picture;
  const ConsensusBackground& model;
  const BitMask& faint;  ///< Verdicts by a smaller radius.
  std::array<Image<uint8_t>, 3>& shown;
};
/// Sets what is at most 6 pixels from the mask, where most of the 5x5 around is mask or faint, but
/// leaves out what a weak shadow explains: the model's colour, darker by at most a half.
void growFaint(const FaintEvidence& evidence, const Executor& executor, CleaningScratch& cleaning,
               ContourScratch& scratch, BitMask& mask);

struct BorderEvidence {
  const Picture& picture;  ///< As it came.
  const SmoothPicture& smoothed;
  const ConsensusBackground& model;
  const std::array<Image<uint8_t>, 3>& shown;  ///< The model, painted to two pixels from the mask.
  Tolerance tolerance;
};
/// Clears border pixels that belong to a layer by their colour in the picture, not smoothed:
/// those closer to the model's than to that three pixels inside, from which they differ by
/// more than 1.5 radii, and which are closer to that three pixels outside, too, or lie on a slope.
/// Parts thinner than 5 pixels stay as they are.
void trimBorder(const BorderEvidence& evidence, BorderLayer layer, const Executor& executor,
                ContourScratch& scratch, BitMask& mask);

}  // namespace rg::background
