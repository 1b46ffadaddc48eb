// SPDX-License-Identifier: LGPL-2.1-or-later
// Leaves in the wind: parts of the foreground that show what the background has close by, where its
// verdict flips all the time.
//
// Determinism: integers, each pixel by itself, sums that commute.
#pragma once

#include "core/background/ghosts/sway.hpp"
#include "core/background/models/consensus_background.hpp"
#include "core/base/bit_mask.hpp"
#include "core/base/components.hpp"

#include <cstdint>
#include <vector>

namespace rg::background {

struct SwayScratch {
  Components components;
  std::vector<PartCount> parts;
  std::vector<uint8_t> isChosen;
};

/// Clears 8-connected parts of which a quarter is restless and most has a colour that the model has
/// close by (sway.hpp). A thing that passes has its own colours and lets the model rest.
void dropSwaying(const SmoothPicture& picture, const ConsensusBackground& model,
                 const Tolerance& tolerance, SwayScratch& scratch, BitMask& mask);

}  // namespace rg::background
