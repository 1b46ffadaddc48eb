// SPDX-License-Identifier: LGPL-2.1-or-later
// Points, sizes and boxes in whole pixels; x grows to the right, y downwards.
#pragma once

#include <algorithm>
#include <cstdint>

namespace rg {

struct Point {
  int x = 0;
  int y = 0;
  friend constexpr bool operator==(const Point&, const Point&) = default;
};

struct Size {
  int width = 0;
  int height = 0;
  [[nodiscard]] constexpr int64_t area() const { return int64_t{width} * height; }
  [[nodiscard]] constexpr bool isEmpty() const { return width <= 0 || height <= 0; }
  friend constexpr bool operator==(const Size&, const Size&) = default;
};

[[nodiscard]] constexpr Size doubled(Size size) {
  return {2 * size.width, 2 * size.height};
}

/// Half-open rectangle: columns x … x + width − 1, rows y … y + height − 1.
struct Box {
  int x = 0;
  int y = 0;
  int width = 0;
  int height = 0;

  [[nodiscard]] constexpr int right() const { return x + width; }
  [[nodiscard]] constexpr int bottom() const { return y + height; }
  [[nodiscard]] constexpr bool isEmpty() const { return width <= 0 || height <= 0; }
  [[nodiscard]] constexpr int64_t area() const { return isEmpty() ? 0 : int64_t{width} * height; }
  [[nodiscard]] constexpr bool contains(Point p) const {
    return p.x >= x && p.x < right() && p.y >= y && p.y < bottom();
  }
  friend constexpr bool operator==(const Box&, const Box&) = default;
};

/// Common part of two boxes; empty (zero width and height) when they don't overlap.
[[nodiscard]] constexpr Box intersect(const Box& a, const Box& b) {
  const int x = std::max(a.x, b.x);
  const int y = std::max(a.y, b.y);
  const int width = std::min(a.right(), b.right()) - x;
  const int height = std::min(a.bottom(), b.bottom()) - y;
  return width > 0 && height > 0 ? Box{x, y, width, height} : Box{};
}

/// Smallest box around both; an empty box adds nothing.
[[nodiscard]] constexpr Box unite(const Box& a, const Box& b) {
  if (a.isEmpty()) return b;
  if (b.isEmpty()) return a;
  const int x = std::min(a.x, b.x);
  const int y = std::min(a.y, b.y);
  return {x, y, std::max(a.right(), b.right()) - x, std::max(a.bottom(), b.bottom()) - y};
}

/// The box grown by `margin` pixels on each side.
[[nodiscard]] constexpr Box inflate(const Box& box, int margin) {
  return {box.x - margin, box.y - margin, box.width + 2 * margin, box.height + 2 * margin};
}

[[nodiscard]] constexpr Box boundsOf(Size size) {
  return {0, 0, size.width, size.height};
}

/// Which pixels count as neighbours: those at the four sides, or those at the corners too.
enum class Connectivity : uint8_t { Four = 4, Eight = 8 };

}  // namespace rg
