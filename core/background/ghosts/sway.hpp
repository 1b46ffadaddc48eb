// SPDX-License-Identifier: LGPL-2.1-or-later
// Whether a pixel shows what belongs close by: the arithmetic that every backend shares
// (swaying_parts.hpp).
#pragma once

#include "core/background/models/consensus_background.hpp"
#include "core/base/geometry.hpp"
#include "core/base/pixel.hpp"

#include <cstdint>

namespace rg::background {

/// Unrest from which on a pixel may be of something that sways: its verdict has flipped twice
/// within the last frames. Once is what each thing leaves that goes by.
inline constexpr int kRestless = 24;

/// Pixels between places that are looked at: something sways by up to a 40th of the picture.
[[nodiscard]] constexpr int swayStepPx(Size size) {
  const int least = size.width < size.height ? size.width : size.height;
  return least < 160 ? 1 : least / 80;
}

/// Of the pixel's radius: 25 places are asked, of which one or another has a colour by chance.
[[nodiscard]] constexpr int nearbyRadius(int radius) {
  return 2 * radius / 3;
}

/// Whether the model has the pixel's colour at its place or at one of 24 round it: two of every
/// second sample within that radius. now(channel), sample(place, sample, channel): levels.
template <class Now, class Sample>
[[nodiscard]] constexpr bool isKnownNearby(Point p, Size size, int channels, int radius,
                                           const Now& now, const Sample& sample) {
  constexpr int kSteps = 2;
  const int step = swayStepPx(size);
  for (int i = -kSteps; i <= kSteps; ++i)
    for (int k = -kSteps; k <= kSteps; ++k) {
      const Point q{p.x + k * step, p.y + i * step};
      if (!boundsOf(size).contains(q)) continue;
      int alike = 0;
      for (int s = 0; s < kSamples && alike < 2; s += 2) {
        bool isAlike = true;
        for (int c = 0; c < channels && isAlike; ++c)
          isAlike = absDiff(now(c), sample(q, s, c)) <= radius;
        alike += isAlike;
      }
      if (alike == 2) return true;
    }
  return false;
}

/// Of a part every second pixel of every second row is looked at.
[[nodiscard]] constexpr bool isLookedAt(int row) {
  return row % 2 == 0;
}
inline constexpr uint64_t kLookedAtColumns = 0x5555555555555555;

/// A part's pixels that are looked at.
struct PartCount {
  uint32_t all = 0, restless = 0, known = 0;
};
/// Leaves let some pixels rest.
[[nodiscard]] constexpr bool isRestless(const PartCount& part) {
  return 4 * uint64_t{part.restless} > part.all;
}
[[nodiscard]] constexpr bool sways(const PartCount& part) {
  return isRestless(part) && 2 * uint64_t{part.known} > part.all;
}

}  // namespace rg::background
