// SPDX-License-Identifier: LGPL-2.1-or-later
// A channel of a pixel of the Gaussian model: the arithmetic that every backend shares
// (gaussian_background.hpp).
#pragma once

#include "core/base/pixel.hpp"

#include <algorithm>
#include <cstdint>

namespace rg::background {

inline constexpr int kLeastVariance = 4 * 16;
inline constexpr int kMostVariance = 3600 * 16;
inline constexpr uint32_t kFarDistance = 9 * 256;  ///< Three deviations, squared, in 1/256.

struct GaussianPixel {
  uint16_t mean, variance;
};

/// From the sum and the squares of `count` training frames.
[[nodiscard]] constexpr GaussianPixel trainedPixel(uint64_t sum, uint64_t squares, uint64_t count) {
  const uint64_t spread = count * squares - sum * sum;
  const uint64_t variance = (spread * 16 + count * count / 2) / (count * count);
  return {static_cast<uint16_t>(((sum << 8) + count / 2) / count),
          static_cast<uint16_t>(
              std::clamp<uint64_t>(variance, uint64_t{kLeastVariance}, uint64_t{kMostVariance}))};
}

/// How far a channel is off its mean, in 1/256 grey level.
[[nodiscard]] constexpr int offMean(uint8_t pixel, uint16_t mean) {
  return absDiff(pixel << 8, mean);
}
/// What it adds to the squared Mahalanobis distance, in 1/256.
[[nodiscard]] constexpr uint32_t distanceOf(int off, uint16_t variance) {
  // (off / 16)² < 2²⁴, so that the dividend stays below 2²⁸.
  const auto sixteenths = static_cast<uint32_t>(off >> 4);
  return (sixteenths * sixteenths << 4) / variance;
}

/// The running average at a rate of 2^-shift; shift 1 … 8.
[[nodiscard]] constexpr GaussianPixel updatedPixel(GaussianPixel model, uint8_t pixel, int shift) {
  const int delta = (pixel << 8) - model.mean;
  // 65280^2 needs 32 unsigned bits.
  const int square = static_cast<int>(static_cast<uint32_t>(delta * int64_t{delta} >> 12));
  const int variance = model.variance + roundShift(square - model.variance, shift);
  return {static_cast<uint16_t>(model.mean + roundShift(delta, shift)),
          static_cast<uint16_t>(std::clamp(variance, int{kLeastVariance}, int{kMostVariance}))};
}

[[nodiscard]] constexpr uint8_t meanLevel(uint16_t mean) {
  return static_cast<uint8_t>(std::min(255, (mean + 128) >> 8));
}

}  // namespace rg::background
