// SPDX-License-Identifier: LGPL-2.1-or-later
// A change of light over the whole picture, as a map of grey levels for each channel.
//
// Determinism: maps follow from histograms, which are sums; everything else is per pixel.
#pragma once

#include "core/background/models/consensus_background.hpp"
#include "core/base/histogram.hpp"
#include "core/base/memory/executor.hpp"
#include "core/base/memory/image.hpp"

#include <array>
#include <cstdint>

namespace rg::background {

using LevelMap = std::array<uint8_t, 256>;

/// The rising map that gives `from` the histogram `to`: level by level of the same rank.
[[nodiscard]] LevelMap matchLevels(const Histogram& from, const Histogram& to);

/// One map per channel from what the model shows to the picture.
using LevelMaps = std::array<LevelMap, 3>;
[[nodiscard]] LevelMaps matchLight(const std::array<Image<uint8_t>, 3>& shown,
                                   const SmoothPicture& picture, const Executor& executor);

/// How many pixels of the mapped model's picture are off by more than their radius.
[[nodiscard]] uint32_t countApart(const std::array<Image<uint8_t>, 3>& shown,
                                  const SmoothPicture& picture, const LevelMaps& maps,
                                  const ConsensusBackground& model, const Tolerance& tolerance);

/// Puts everything that the model remembers into the other light.
void relight(const LevelMaps& maps, const Executor& executor, ConsensusBackground& model);

}  // namespace rg::background
