// SPDX-License-Identifier: LGPL-2.1-or-later
// Where a foreground part ends: faint evidence beside a sure part belongs to it, and pixels at its
// border that the smoothing of the picture has drawn in do not.
//
// Determinism: integers, each pixel by itself; the same bits for any number of threads.
#pragma once

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

/// Clears border pixels whose colour in the picture as it came, not smoothed, is closer to the
/// model's than to that three pixels inside, from which it differs by more than 1.5 radii. Parts
/// thinner than 5 pixels stay as they are.
void trimBorder(const Picture& picture, const SmoothPicture& smoothed,
                const ConsensusBackground& model, const Tolerance& tolerance,
                const Executor& executor, ContourScratch& scratch, BitMask& mask);

}  // namespace rg::background
