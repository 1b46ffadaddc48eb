// SPDX-License-Identifier: LGPL-2.1-or-later
// What something looks like: colour histograms of the upper, middle and lower third of its box.
//
// Determinism: integer counts over samples, normalised with a rounding of their own.
#pragma once

#include <array>
#include <cstdint>

namespace rg::objects {

inline constexpr int kColourBins = 32;  ///< 12 hues x 2 saturations, then 8 greys.
inline constexpr int kBodyBands = 3;
inline constexpr int kFullMatch = 4096;  ///< Similarity of a look with itself.

/// Bin of a colour: R'G'B' of 8 bits.
[[nodiscard]] uint8_t colourBin(int red, int green, int blue);

/// Counts of one frame.
struct LookCounts {
  std::array<std::array<uint32_t, kColourBins>, kBodyBands> bins{};
};

/// Shares in 1/4096 of each band; a band without samples is empty.
struct Look {
  std::array<std::array<uint16_t, kColourBins>, kBodyBands> shares{};
  uint32_t frames = 0;  ///< From how many it was made.
};

/// Mixes one frame's counts in, with weight 1/8 once eight frames are known, equally before.
void learn(Look& look, const LookCounts& counts);

/// 0 (nothing in common) … kFullMatch: what the histograms of the bands that both have share.
/// kFullMatch / 2 where there is no such band.
[[nodiscard]] int similarity(const Look& a, const Look& b);

/// The share of a bin over all bands, 0 … kFullMatch.
[[nodiscard]] int shareOf(const Look& look, int bin);

}  // namespace rg::objects
