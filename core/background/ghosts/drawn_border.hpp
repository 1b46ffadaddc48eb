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

inline constexpr int kBorderDepth = 4;  ///< Pixels of a part that lie behind a border pixel.

/// For each side, the set pixels of a word that have an unset one beside them there, and behind
/// them four that are set. Outside the frame all is set.
struct BorderSides {
  uint64_t left = 0, right = 0, above = 0, below = 0;

  [[nodiscard]] constexpr uint64_t any() const { return left | right | above | below; }
};
/// wordAt(words to the right, rows down): a word of the mask, what is beyond the frame set.
template <class WordAt>
[[nodiscard]] constexpr BorderSides borderSides(uint64_t here, const WordAt& wordAt) {
  const uint64_t seen = wordAt(0, 0), before = wordAt(-1, 0), after = wordAt(1, 0);
  const auto leftOf = [&](int columns) { return seen << columns | before >> (64 - columns); };
  const auto rightOf = [&](int columns) { return seen >> columns | after << (64 - columns); };
  BorderSides sides{here & ~leftOf(1), here & ~rightOf(1), here & ~wordAt(0, -1),
                    here & ~wordAt(0, 1)};
  for (int i = 1; i <= kBorderDepth; ++i) {
    sides.left &= rightOf(i);
    sides.right &= leftOf(i);
    if (sides.above != 0) sides.above &= wordAt(0, i);
    if (sides.below != 0) sides.below &= wordAt(0, -i);
  }
  return sides;
}

/// Reads border pixels in the picture as it came.
struct BorderReader {
  const ImageView<const uint8_t>* planes;  ///< As many as there are channels.
  const ImageView<const uint8_t>* shown;   ///< The model's, painted as far as two pixels around.
  int channels;
  Size size;

  /// Whether a pixel goes with the layer, seen from one of its sides; bit: the pixel's in the word;
  /// radius: by how much it may be off anyway.
  [[nodiscard]] constexpr bool isOn(BorderLayer layer, Point p, const BorderSides& sides,
                                    uint64_t bit, int radius) const {
    return ((sides.left & bit) != 0 && isOn(layer, p, {-1, 0}, radius)) ||
           ((sides.right & bit) != 0 && isOn(layer, p, {1, 0}, radius)) ||
           ((sides.above & bit) != 0 && isOn(layer, p, {0, -1}, radius)) ||
           ((sides.below & bit) != 0 && isOn(layer, p, {0, 1}, radius));
  }

 private:
  [[nodiscard]] constexpr bool isOn(BorderLayer layer, Point p, Point out, int radius) const {
    constexpr int kSide = 3;  // Pixels from the border to what stands for a side.
    const int toInside = difference(p, along(p, out, -kSide));
    if (2 * toInside <= 3 * radius) return false;
    const bool isDrawnIn = layer == BorderLayer::DrawnIn;
    if (isDrawnIn && difference(p, along(p, out, kSide)) >= toInside) return false;
    const int off = toBackground(p);
    return off < toInside && (isDrawnIn || isOnSlope(p, out, off));
  }
  /// Whether the further in, the further from the background, from one pixel outside to two inside;
  /// off: how far the pixel itself is.
  [[nodiscard]] constexpr bool isOnSlope(Point p, Point out, int off) const {
    if (toBackground(along(p, out, 1)) >= off) return false;
    const int inside = toBackground(along(p, out, -1));
    return inside > off && toBackground(along(p, out, -2)) > inside;
  }
  [[nodiscard]] static constexpr Point along(Point p, Point out, int steps) {
    return {p.x + steps * out.x, p.y + steps * out.y};
  }

  [[nodiscard]] constexpr int difference(Point p, Point other) const {
    const Point q = repeated(other);
    return most([&](int c) { return absDiff(planes[c].at(p.x, p.y), planes[c].at(q.x, q.y)); });
  }
  [[nodiscard]] constexpr int toBackground(Point p) const {
    const Point q = repeated(p);
    return most([&](int c) { return absDiff(planes[c].at(q.x, q.y), shown[c].at(q.x, q.y)); });
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
}  // namespace rg::background
