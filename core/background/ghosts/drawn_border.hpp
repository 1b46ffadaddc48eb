// SPDX-License-Identifier: LGPL-2.1-or-later
// What tells a part's own pixels at its border from others: the arithmetic that every backend
// shares (mask_contour.hpp).
#pragma once

#include "core/base/geometry.hpp"
#include "core/base/memory/image.hpp"
#include "core/base/pixel.hpp"

#include <algorithm>
#include <cstdint>

namespace rg::background {

inline constexpr int kFaintReach = 6;  ///< Pixels from a sure part to its faint ones.

/// Could a pixel be the background in a weak shadow? now(channel), before(channel): its levels in
/// the picture and in the model.
template <class Now, class Before>
[[nodiscard]] constexpr bool isDimmed(int channels, const Now& now, const Before& before) {
  constexpr int kMostTint = 14;  // Grey levels that a channel may be off the shadow's factor.
  const int level = now(0), modelled = before(0);
  if (level >= modelled || 2 * level < modelled) return false;
  for (int c = 1; c < channels; ++c) {
    const int off = now(c) * modelled - before(c) * level;
    if (absDiff(off, 0) > kMostTint * modelled) return false;
  }
  return true;
}

/// Reads border pixels of a mask in the picture as it came. Mask: at(x, y); Before: the model's
/// level of a pixel and a channel.
template <class Mask, class Before>
struct BorderReader {
  const ImageView<const uint8_t>* planes;  ///< As many as there are channels.
  int channels;
  const Mask& mask;
  Size size;
  Before before;

  /// Whether the smoothing of the picture has drawn in the pixel, which is in the mask, from any of
  /// the four sides; radius: by how much it may be off anyway.
  [[nodiscard]] constexpr bool isDrawnIn(Point p, int radius) const {
    int toBackground = 0;
    for (int c = 0; c < channels; ++c)
      toBackground = std::max(toBackground, absDiff(planes[c].at(p.x, p.y), before(p, c)));
    // Closer to the background than to the inside, from which it is off by more than 1.5 radii.
    const int least = std::max(toBackground, 3 * radius / 2);
    return isCloserOutside(p, {-1, 0}, least) || isCloserOutside(p, {1, 0}, least) ||
           isCloserOutside(p, {0, -1}, least) || isCloserOutside(p, {0, 1}, least);
  }

 private:
  /// Whether what lies inside, seen from the side `out`, is off by more than `least`.
  [[nodiscard]] constexpr bool isCloserOutside(Point p, Point out, int least) const {
    constexpr int kSide = 3;  // Pixels from the border to what stands for the inside.
    const Point beside{p.x + out.x, p.y + out.y};
    return boundsOf(size).contains(beside) && !mask.at(beside.x, beside.y) && isDeep(p, out) &&
           difference(p, {p.x - kSide * out.x, p.y - kSide * out.y}) > least;
  }
  [[nodiscard]] constexpr bool isDeep(Point p, Point out) const {
    constexpr int kLeastDepth = 4;
    for (int i = 1; i <= kLeastDepth; ++i) {
      const Point q{p.x - i * out.x, p.y - i * out.y};
      if (boundsOf(size).contains(q) && !mask.at(q.x, q.y)) return false;
    }
    return true;
  }

  /// Outside the frame its border is repeated.
  [[nodiscard]] constexpr int difference(Point p, Point other) const {
    const int x = std::clamp(other.x, 0, size.width - 1);
    const int y = std::clamp(other.y, 0, size.height - 1);
    int most = 0;
    for (int c = 0; c < channels; ++c)
      most = std::max(most, absDiff(planes[c].at(p.x, p.y), planes[c].at(x, y)));
    return most;
  }
};
template <class Mask, class Before>
BorderReader(const ImageView<const uint8_t>*, int, const Mask&, Size, Before)
    -> BorderReader<Mask, Before>;

}  // namespace rg::background
