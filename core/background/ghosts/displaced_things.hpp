// SPDX-License-Identifier: LGPL-2.1-or-later
// Things of the scene that somebody has moved a little or turned: what stands there now has the
// colours of what stood there before.
//
// Determinism: integers; parts in raster order (core/base/components.hpp).
#pragma once

#include "core/background/ghosts/ghosts.hpp"
#include "core/background/models/consensus_background.hpp"
#include "core/base/components.hpp"

#include <cstdint>
#include <vector>

namespace rg::background {

struct DisplacedScratch {
  Components parts;
  std::vector<uint32_t> stillPx;        ///< Of each part.
  std::vector<uint8_t> isChosen;        ///< Of each part.
  std::vector<uint32_t> before, after;  ///< Pixels of each colour in one part.
};

/// Sets in `moved` the 8-connected parts of the foreground of which three quarters have been still
/// for `leastAge` frames and that share at least an eighth of their pixels' colours with the model
/// beneath them. Only vivid colours count: grey on grey is no evidence. At most 16 parts are looked
/// at; nothing is found in a grey picture.
void addDisplaced(const SmoothPicture& picture, const ConsensusBackground& model,
                  const BitMask& foreground, const StillPixels& still, int64_t leastAge,
                  DisplacedScratch& scratch, BitMask& moved);

}  // namespace rg::background
