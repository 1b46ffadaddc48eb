// SPDX-License-Identifier: LGPL-2.1-or-later
// Whether a window of the picture is the background, darkened: the arithmetic that every backend
// shares (shadow.hpp).
#pragma once

#include <cstdint>

namespace rg::background {

inline constexpr int kShadowRadius = 2;
inline constexpr int64_t kMostResidual = 36;  ///< Square grey levels that noise and texture leave.
inline constexpr int64_t kMostTint = 14;      ///< Grey levels that a channel may leave the line.

/// Sums of picture I and background B over a window.
struct WindowSums {
  int64_t count = 0, i = 0, b = 0, ii = 0, ib = 0, bb = 0;
};

/// The factor lies between 0.4 and 0.95.
[[nodiscard]] constexpr bool isInRange(const WindowSums& s) {
  return s.i * 20 <= s.b * 19 && s.i * 5 >= s.b * 2;
}

/// One factor explains the window: the rest of I − (Σi / Σb) B is noise.
[[nodiscard]] constexpr bool isDarkened(const WindowSums& s) {
  const int64_t squareB = s.b * s.b;  // Sums below 25 · 255² keep all products under 2⁵⁰.
  const int64_t rest = s.ii * squareB - 2 * s.i * s.b * s.ib + s.i * s.i * s.bb;
  return rest <= s.count * kMostResidual * squareB;
}

/// A channel is darkened by the window's factor, too.
[[nodiscard]] constexpr bool keepsColour(uint8_t now, uint8_t before, const WindowSums& s) {
  const int64_t off = now * s.b - before * s.i;
  return off <= kMostTint * s.b && -off <= kMostTint * s.b;
}

}  // namespace rg::background
