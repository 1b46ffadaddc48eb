// SPDX-License-Identifier: LGPL-2.1-or-later
// The camera's own gain, which hunts: how much brighter than the model the picture is as a whole,
// told from a grid of points, and the picture as the model's exposure would show it.
//
// Determinism: integer sums over fixed points; everything else is per pixel.
#pragma once

#include "core/background/light/light_switch.hpp"
#include "core/background/models/consensus_background.hpp"
#include "core/base/histogram.hpp"
#include "core/base/memory/executor.hpp"

#include <algorithm>
#include <cstdint>

namespace rg::background {

/// What a picture's levels are multiplied by, in 1/512; kNoGain where no gain explains it.
inline constexpr int kSameGain = 512, kNoGain = 0;
inline constexpr int kMostGain = 2 * kSameGain, kLeastGain = kSameGain / 2;

/// Half the way, as an octave goes, to where a gain is not told any more.
[[nodiscard]] constexpr bool isFar(int gain) {
  return gain * gain > kSameGain * kMostGain || gain * gain < kSameGain * kLeastGain;
}
static_assert(!isFar(kSameGain) && !isFar(724) && isFar(725) && isFar(362) && !isFar(363));

/// By how much grey levels of a scene differ, against a common day's, on which so many lie between
/// the darkest and the brightest, but for a 64th of the pixels on either side. Fog and night leave
/// less, and as much less of any difference in it.
inline constexpr int kUsualRange = 180, kFullContrast = 256;
[[nodiscard]] inline int contrastOf(const Histogram& levels) {
  constexpr int kExtremes = 4;  // Of 256.
  const int range = quantile(levels, 256 - kExtremes) - quantile(levels, kExtremes);
  return std::clamp(kFullContrast * range / kUsualRange, 1, kFullContrast);
}

/// By how much points of a grid are brighter than the model.
struct GainSums {
  static constexpr int kGains = kMostGain + 2;
  static constexpr int kDark = 16, kClipped = 250;  ///< Grey levels that tell no gain.
  uint32_t weight[kGains] = {};  ///< Grey levels of the model, of up to 2^16 points.

  [[nodiscard]] static constexpr bool tells(int shown, int modelled) {
    return std::min(shown, modelled) >= kDark && std::max(shown, modelled) <= kClipped;
  }
  [[nodiscard]] static constexpr int gainOf(int shown, int modelled) {
    return std::min(kGains - 1, (shown * kSameGain + modelled / 2) / modelled);
  }
};
[[nodiscard]] GainSums sumGains(const SmoothPicture& picture, const ConsensusBackground& model);

/// The median by weight; kNoGain out of bounds or unless half has about that gain: light that
/// comes from somewhere is none.
[[nodiscard]] int medianGain(const GainSums& sums);

/// Takes the gain back. A clipped level may be anything above what it would be without.
[[nodiscard]] LevelMap withoutGain(int gain);

/// What the levels become by the gain.
[[nodiscard]] LevelMap withGain(int gain);

/// Puts every level of the picture through the map.
void mapLevels(const LevelMap& map, const Executor& executor, SmoothPicture& picture);

}  // namespace rg::background
