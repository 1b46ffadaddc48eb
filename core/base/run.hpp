// SPDX-License-Identifier: LGPL-2.1-or-later
// Pieces of rows, half open.
#pragma once

#include <cstdint>

namespace rg {

/// Columns first … last − 1.
struct Span {
  int first = 0;
  int last = 0;
  [[nodiscard]] constexpr int count() const { return last > first ? last - first : 0; }
};

/// Columns begin … end − 1 of row y. Frames are smaller than 65536 in both directions.
struct Run {
  uint16_t y = 0;
  uint16_t begin = 0;
  uint16_t end = 0;
  friend constexpr bool operator==(const Run&, const Run&) = default;
};

[[nodiscard]] constexpr Run runOf(int y, int begin, int end) {
  return {static_cast<uint16_t>(y), static_cast<uint16_t>(begin), static_cast<uint16_t>(end)};
}

}  // namespace rg
