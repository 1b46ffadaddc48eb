// SPDX-License-Identifier: LGPL-2.1-or-later
// When a pixel of the consensus model learns, and from whom: the arithmetic that every backend
// shares (models/consensus_background.hpp). It follows from a hash of place and frame.
#pragma once

#include "core/base/geometry.hpp"
#include "core/base/pixel.hpp"

#include <algorithm>
#include <cstdint>

namespace rg::background {

inline constexpr uint32_t kNoisePeriod = 16, kFirstNoisePeriod = 4;  ///< Frames from turn to turn.
inline constexpr uint32_t kLearnPeriod = 8;
inline constexpr int kFlip = 16;  ///< What unrest gains by a flip.
/// The same where a thing was in the frame before: it may have left only.
inline constexpr int kUncovered = 8;
inline constexpr int kCalm = 8;  ///< What unrest loses a turn.

// No tables, and no references to constants: a GPU has no memory that holds them.

/// Where the eight neighbours of a pixel lie, in raster order; i: 0 … 7.
[[nodiscard]] constexpr Point neighbourOffset(int i) {
  const int place = i < 4 ? i : i + 1;
  return {place % 3 - 1, place / 3 - 1};
}
static_assert(neighbourOffset(0) == Point{-1, -1} && neighbourOffset(3) == Point{-1, 0} &&
              neighbourOffset(4) == Point{1, 0} && neighbourOffset(7) == Point{1, 1});

/// Where the colour comes from that a sample of a row is filled with: the first two are the pixel
/// itself, the others its eight neighbours in turn.
[[nodiscard]] constexpr Point fillOffset(int sample) {
  return sample < 2 ? Point{} : neighbourOffset((sample - 2) % 8);
}

/// What all columns of a row draw in a round: the seeds of their own colour's turn and of a
/// neighbour's, and that neighbour.
struct Draw {
  uint64_t own, other;
  Point offset;
};
[[nodiscard]] constexpr Draw drawOf(uint32_t frame, int y, uint32_t round) {
  const uint64_t seed = uint64_t{frame} << 32 | static_cast<uint32_t>(y) << 2 | round;
  const uint64_t other = mixHash64(seed + 1);
  return {mixHash64(seed), other, neighbourOffset(static_cast<int>(other >> 8 & 7))};
}

/// Four dice of 16 bits for a word of 64 columns, each for 16 of them.
[[nodiscard]] constexpr uint64_t diceOf(uint64_t seed, int word) {
  return mixHash64(seed + static_cast<uint32_t>(word));
}
/// limit: of 65536, the chance in a turn.
[[nodiscard]] constexpr bool isDrawn(uint64_t dice, int column, uint32_t limit) {
  return (dice >> (column & 48) & 0xFFFF) < limit;
}

/// Frames from a row's turn to its next one, and its pixels' chance in a turn.
struct LearningTurns {
  uint32_t period, limit;
};
[[nodiscard]] constexpr LearningTurns turnsOf(int interval) {
  const uint32_t period = std::min(uint32_t{kLearnPeriod}, static_cast<uint32_t>(interval));
  return {period, 65536u * period / static_cast<uint32_t>(interval)};
}

/// noise a quarter of the way, rounded away from the old value, to 8 · nearest.
[[nodiscard]] constexpr uint8_t followedNoise(uint8_t noise, int nearest) {
  const int off = 8 * nearest - noise;
  const int step = (absDiff(off, 0) + 3) / 4;
  return static_cast<uint8_t>(noise + (off > 0 ? step : -step));
}
static_assert(followedNoise(8, 2) == 10 && followedNoise(9, 1) == 8);

[[nodiscard]] constexpr uint8_t raisedUnrest(uint8_t unrest, bool isUncovered) {
  return static_cast<uint8_t>(std::min(255, unrest + (isUncovered ? kUncovered : kFlip)));
}
[[nodiscard]] constexpr uint8_t calmedUnrest(uint8_t unrest) {
  return static_cast<uint8_t>(unrest > kCalm ? unrest - kCalm : 0);
}

}  // namespace rg::background
