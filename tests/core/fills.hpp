// SPDX-License-Identifier: LGPL-2.1-or-later
// Pictures that are hard on vectors of bytes.
#pragma once

#include "core/base/memory/image.hpp"
#include "core/base/pixel.hpp"

#include <cstdint>

namespace rg::test {

[[nodiscard]] inline uint32_t hashOf(int x, int y, uint32_t what) {
  return mixHash(static_cast<uint32_t>(x), static_cast<uint32_t>(y), what);
}

/// Fills that make differences largest, smallest, alternating, alike in patches or arbitrary; those
/// from kFills on are arbitrary, too.
inline constexpr int kFills = 6;
[[nodiscard]] inline int levelAt(int fill, int x, int y) {
  switch (fill) {
    case 0:
      return 255;
    case 1:
      return 0;
    case 2:
      return (x + y) % 2 * 255;
    case 3:
      return x % 3 == 0 ? 254 : 1;
    case 4:
      return static_cast<int>(100 + (hashOf(x / 3, y / 3, 2) & 63) + (hashOf(x, y, 3) & 7));
    default:
      return static_cast<int>(hashOf(x, y, 9) & 255);
  }
}

[[nodiscard]] inline Image<uint8_t> filled(Size size, int fill) {
  Image<uint8_t> image(size);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x) image.at(x, y) = static_cast<uint8_t>(levelAt(fill, x, y));
  return image;
}

}  // namespace rg::test
