// SPDX-License-Identifier: LGPL-2.1-or-later
// Integer hue, and the band of hues that the background has (paper, section 2.2.2).
//
// Hues lie on a circle of 6 x 256 steps: red 0, yellow 256, green 512, cyan 768, blue 1024, magenta
// 1280. Pixels with too little colour to have one are achromatic.
// Determinism: integer counts; of equal peaks the lower hue wins.
#pragma once

#include "core/base/pixel.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

namespace rg::segmentation {

inline constexpr int kHueSextant = 256;
inline constexpr int kHueCount = 6 * kHueSextant;
inline constexpr int kAchromatic = -1;
/// Least max(R, G, B) − min(R, G, B) of a chromatic pixel: below it, camera noise of 3 grey levels
/// turns the hue by more than a sixth of a sextant.
inline constexpr int kLeastChroma = 24;

namespace detail {
/// 256 / chroma in Q16.
constexpr auto kHueReciprocals = [] {
  std::array<int32_t, 256> table{};
  for (int chroma = 1; chroma < 256; ++chroma)
    table[static_cast<size_t>(chroma)] =
        static_cast<int32_t>(divideRounded(int64_t{kHueSextant} << 16, chroma));
  return table;
}();
}  // namespace detail

/// hueOf for who has no table: reciprocalOf(chroma) is 256 / chroma in Q16, rounded.
template <class Reciprocal>
[[nodiscard]] constexpr int hueBy(int red, int green, int blue, const Reciprocal& reciprocalOf) {
  const int largest = std::max(red, std::max(green, blue));
  const int chroma = largest - std::min(red, std::min(green, blue));
  if (chroma < kLeastChroma) return kAchromatic;
  const int32_t reciprocal = reciprocalOf(chroma);
  const auto turn = [&](int a, int b) { return roundShift((a - b) * reciprocal, 16); };
  if (largest == red) {
    const int hue = turn(green, blue);
    return hue < 0 ? hue + kHueCount : hue;
  }
  return largest == green ? 2 * kHueSextant + turn(blue, red) : 4 * kHueSextant + turn(red, green);
}

/// Hue of a pixel of at least kLeastChroma, else kAchromatic. Of equal channels red counts as the
/// largest before green, green before blue. |255 · 256 · 2^16 / 24| < 2^31.
[[nodiscard]] constexpr int hueOf(int red, int green, int blue) {
  return hueBy(red, green, blue,
               [](int chroma) { return detail::kHueReciprocals[static_cast<size_t>(chroma)]; });
}
static_assert(hueOf(255, 0, 0) == 0 && hueOf(255, 255, 0) == 256 && hueOf(0, 255, 0) == 512);
static_assert(hueOf(0, 0, 255) == 1024 && hueOf(255, 0, 255) == 1280 && hueOf(100, 0, 1) == 1533);
static_assert(hueOf(90, 80, 70) == kAchromatic);

/// Of HSV: 0 (grey) … 255 (pure), (max − min) / max rounded; 0 of black.
[[nodiscard]] constexpr int saturationOf(int red, int green, int blue) {
  const int largest = std::max(red, std::max(green, blue));
  const int chroma = largest - std::min(red, std::min(green, blue));
  return largest == 0 ? 0 : (255 * chroma + largest / 2) / largest;
}
static_assert(saturationOf(200, 0, 30) == 255 && saturationOf(100, 100, 100) == 0);
static_assert(saturationOf(0, 0, 0) == 0 && saturationOf(200, 150, 100) == 128);

/// Of HSV.
[[nodiscard]] constexpr int valueOf(int red, int green, int blue) {
  return std::max(red, std::max(green, blue));
}

/// Distance along the shorter arc, 0 … kHueCount / 2.
[[nodiscard]] constexpr int hueDistance(int a, int b) {
  const int d = absDiff(a, b);
  return std::min(d, kHueCount - d);
}

/// The same as 256ths of the circle, rounded: the scale that 8 bits give a hue. 0 where one of the
/// two has no hue.
[[nodiscard]] constexpr int hueStep(int a, int b) {
  constexpr int kStep = kHueCount / 256;
  return a < 0 || b < 0 ? 0 : (hueDistance(a, b) + kStep / 2) / kStep;
}
static_assert(hueStep(0, 1535) == 0 && hueStep(1530, 6) == 2 && hueStep(kAchromatic, 700) == 0);

/// What neighbouring pixels are compared by.
enum class ColourSpace : uint8_t {
  Rgb,  ///< The largest difference of R', G' and B'.
  Hsv,  ///< The largest difference of hue, in 256ths of the circle, saturation and value.
};

/// A range of hues: first … first + count − 1 round the circle; count 0 = none.
struct HueBand {
  int first = 0;
  int count = 0;
  [[nodiscard]] constexpr bool contains(int hue) const {
    const int d = hue - first;
    return (d < 0 ? d + kHueCount : d) < count;
  }
  friend constexpr bool operator==(const HueBand&, const HueBand&) = default;
};

/// How a histogram of hues is read.
inline constexpr int kSmoothingReach = 16;  ///< Hues on either side that a smoothed one sums up.
inline constexpr uint32_t kTailShare = 8;
[[nodiscard]] constexpr int wrapped(int hue) {
  return (hue + kHueCount) % kHueCount;
}
[[nodiscard]] constexpr bool isColourful(uint64_t chromatic, uint64_t total) {
  constexpr uint64_t kLeastShare = 16;
  return chromatic > 0 && chromatic >= total / kLeastShare;
}
/// The band of a peak and so many hues below and above it.
[[nodiscard]] constexpr HueBand bandRound(int peak, int below, int above) {
  const int count = below + 1 + above;
  return count > kHueCount / 2 ? HueBand{} : HueBand{wrapped(peak - below), count};
}

using HueHistogram = std::array<uint32_t, kHueCount>;

/// The band round the histogram's peak, after smoothing by a window of 33 hues: as far as the
/// counts stay above an eighth of the peak. No band where fewer than 1/16 of the `total` counted
/// pixels are chromatic, or where it would take more than half of the circle: then the background
/// has no distinct peak.
[[nodiscard]] HueBand findBackgroundBand(const HueHistogram& histogram, uint64_t total);

}  // namespace rg::segmentation
