// SPDX-License-Identifier: LGPL-2.1-or-later
// Things of the scene that somebody has moved a little or turned: what stands there now has the
// colours of what stood there before.
//
// Determinism: integers; parts in raster order (core/base/components.hpp).
#pragma once

#include "core/background/ghosts/ghosts.hpp"
#include "core/background/models/consensus_background.hpp"
#include "core/base/components.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace rg::background {

inline constexpr int kMostDisplaced = 16;  ///< Each costs a pass over all runs.
inline constexpr int kColourBits = 4;      ///< Of each channel that tell colours apart.
inline constexpr int kColours = 1 << 3 * kColourBits;

/// The number of a colour; below 0: it is too grey to tell anything.
[[nodiscard]] constexpr int vividColour(int green, int red, int blue) {
  constexpr int kLeastChroma = 32;  // Grey levels between the largest and the smallest channel.
  const int most = std::max(std::max(green, red), blue);
  const int least = std::min(std::min(green, red), blue);
  if (most - least < kLeastChroma) return -1;
  constexpr int kDropped = 8 - kColourBits;
  return (green >> kDropped << kColourBits | red >> kDropped) << kColourBits | blue >> kDropped;
}
[[nodiscard]] constexpr bool isStillPart(uint32_t stillPx, uint32_t areaPx, Size frame) {
  const auto leastPx = static_cast<uint32_t>(std::max(int64_t{30}, frame.area() / 500));
  return areaPx >= leastPx && 4 * stillPx >= 3 * areaPx;
}
[[nodiscard]] constexpr bool isDisplaced(uint32_t sharedPx, uint32_t areaPx) {
  return 8 * sharedPx >= areaPx;
}

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
