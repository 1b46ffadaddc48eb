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

/// Which pixels of a part's border go.
enum class BorderLayer : uint8_t {
  DrawnIn,  ///< Closer to the background, and to what is beside the part, than to its inside.
  Blurred,  ///< Closer to the background than to the inside, on a slope that leads from it inwards.
};

/// Reads border pixels of a mask in the picture as it came. Mask: at(x, y); Before: the model's
/// level of a pixel and a channel.
template <class Mask, class Before>
struct BorderReader {
  const ImageView<const uint8_t>* planes;  ///< As many as there are channels.
  int channels;
  const Mask& mask;
  Size size;
  Before before;

  /// Whether a pixel, which is in the mask, goes with the layer, seen from any of the four sides;
  /// radius: by how much it may be off anyway.
  [[nodiscard]] constexpr bool isOn(BorderLayer layer, Point p, int radius) const {
    return isOn(layer, p, {-1, 0}, radius) || isOn(layer, p, {1, 0}, radius) ||
           isOn(layer, p, {0, -1}, radius) || isOn(layer, p, {0, 1}, radius);
  }

 private:
  [[nodiscard]] constexpr bool isOn(BorderLayer layer, Point p, Point out, int radius) const {
    constexpr int kSide = 3;  // Pixels from the border to what stands for a side.
    const Point beside = along(p, out, 1);
    if (!boundsOf(size).contains(beside) || mask.at(beside.x, beside.y) || !isDeep(p, out))
      return false;
    const int toInside = difference(p, along(p, out, -kSide));
    if (2 * toInside <= 3 * radius || toInside <= toBackground(p)) return false;
    return layer == BorderLayer::DrawnIn ? difference(p, along(p, out, kSide)) < toInside
                                         : isOnSlope(p, out);
  }
  /// Whether the further in, the further from the background, from one pixel outside to two inside.
  [[nodiscard]] constexpr bool isOnSlope(Point p, Point out) const {
    for (int i = -2; i < 1; ++i)
      if (toBackground(along(p, out, i)) <= toBackground(along(p, out, i + 1))) return false;
    return true;
  }
  [[nodiscard]] static constexpr Point along(Point p, Point out, int steps) {
    return {p.x + steps * out.x, p.y + steps * out.y};
  }
  [[nodiscard]] constexpr bool isDeep(Point p, Point out) const {
    constexpr int kLeastDepth = 4;
    for (int i = 1; i <= kLeastDepth; ++i) {
      const Point q = along(p, out, -i);
      if (boundsOf(size).contains(q) && !mask.at(q.x, q.y)) return false;
    }
    return true;
  }

  [[nodiscard]] constexpr int difference(Point p, Point other) const {
    const Point q = repeated(other);
    return most([&](int c) { return absDiff(planes[c].at(p.x, p.y), planes[c].at(q.x, q.y)); });
  }
  [[nodiscard]] constexpr int toBackground(Point p) const {
    const Point q = repeated(p);
    return most([&](int c) { return absDiff(planes[c].at(q.x, q.y), before(q, c)); });
  }
  /// Outside the frame its border is repeated.
  [[nodiscard]] constexpr Point repeated(Point p) const {
    return {std::clamp(p.x, 0, size.width - 1), std::clamp(p.y, 0, size.height - 1)};
  }
  template <class Of>
  [[nodiscard]] constexpr int most(const Of& of) const {
    int all = 0;
    for (int c = 0; c < channels; ++c) all = std::max(all, of(c));
    return all;
  }
};
template <class Mask, class Before>
BorderReader(const ImageView<const uint8_t>*, int, const Mask&, Size, Before)
    -> BorderReader<Mask, Before>;

}  // namespace rg::background
