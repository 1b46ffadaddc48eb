// SPDX-License-Identifier: LGPL-2.1-or-later
// From the picture that a result was made for to a frame that was scaled since. Every output maps
// through here, so that boxes, masks and lines of one frame agree.
#pragma once

#include "core/base/geometry.hpp"
#include "core/base/pixel.hpp"

#include <algorithm>
#include <cstdint>

namespace rg {

/// The pixel of a row of `to` pixels that lies under a place in one of `from`, in half pixels.
[[nodiscard]] constexpr int pixelUnder(int64_t halves, int from, int to) {
  return static_cast<int>(halves * to / (2 * int64_t{from}));
}

/// Maps by the ratio of two sizes, neither of them empty. Equal sizes change nothing.
/// Range: sides up to 2^16, |x| and |y| < 2^47, areas within the frame.
struct FrameMap {
  Size from;
  Size to;

  /// Columns and rows, positions as well as lengths, in any unit of the pixel.
  [[nodiscard]] constexpr int64_t x(int64_t value) const {
    return divideRounded(value * to.width, from.width);
  }
  [[nodiscard]] constexpr int64_t y(int64_t value) const {
    return divideRounded(value * to.height, from.height);
  }
  [[nodiscard]] constexpr Point point(Point p) const {
    return {static_cast<int>(x(p.x)), static_cast<int>(y(p.y))};
  }
  /// Maps the edges, so that boxes that touch still touch; what was not empty keeps the
  /// pixel under its middle.
  [[nodiscard]] constexpr Box box(const Box& b) const {
    const Point first = point({b.x, b.y});
    const Point last = point({b.right(), b.bottom()});
    Box mapped{first.x, first.y, last.x - first.x, last.y - first.y};
    if (b.width > 0 && mapped.width == 0) {
      mapped.x = pixelUnder(2 * int64_t{b.x} + b.width, from.width, to.width);
      mapped.width = 1;
    }
    if (b.height > 0 && mapped.height == 0) {
      mapped.y = pixelUnder(2 * int64_t{b.y} + b.height, from.height, to.height);
      mapped.height = 1;
    }
    return mapped;
  }
  /// Pixels, and means of pixels in 1/unit of one: the centre of one goes to the centre of those
  /// that it becomes.
  [[nodiscard]] constexpr int64_t centreX(int64_t value, int64_t unit) const {
    return divideRounded((2 * value + unit) * to.width - unit * from.width, 2 * from.width);
  }
  [[nodiscard]] constexpr int64_t centreY(int64_t value, int64_t unit) const {
    return divideRounded((2 * value + unit) * to.height - unit * from.height, 2 * from.height);
  }
  [[nodiscard]] constexpr int64_t area(int64_t areaPx) const {
    return divideRounded(areaPx * to.area(), from.area());
  }

  /// The way back, for whole pixels of `to`: the pixel of `from` that lies under the centre.
  [[nodiscard]] constexpr int sourceX(int column) const {
    return pixelUnder(2 * int64_t{column} + 1, to.width, from.width);
  }
  [[nodiscard]] constexpr int sourceY(int row) const {
    return pixelUnder(2 * int64_t{row} + 1, to.height, from.height);
  }
  /// The first column x for which sourceX(x) is `column` or more.
  [[nodiscard]] constexpr int firstX(int column) const {
    const int64_t twice = 2 * int64_t{column} * to.width - from.width;
    return twice <= 0 ? 0 : static_cast<int>((twice + 2 * from.width - 1) / (2 * from.width));
  }
};

/// A result of a skipped frame may have no size; there is nothing in it to be mapped.
[[nodiscard]] constexpr FrameMap mapBetween(Size from, Size to) {
  return {from.isEmpty() ? to : from, to};
}
static_assert(FrameMap{{4, 4}, {8, 2}}.box({1, 1, 2, 2}) == Box{2, 1, 4, 1});
static_assert(FrameMap{{100, 100}, {1, 1}}.box({40, 40, 3, 3}) == Box{0, 0, 1, 1});
static_assert(FrameMap{{8, 8}, {4, 4}}.box({7, 5, 1, 1}) == Box{3, 2, 1, 1});
static_assert(FrameMap{{3, 3}, {6, 6}}.area(5) == 20);
static_assert(FrameMap{{5, 5}, {15, 25}}.centreX(2, 1) == 7 &&
              FrameMap{{5, 5}, {15, 25}}.centreY(4, 1) == 22);
static_assert(FrameMap{{3, 3}, {12, 3}}.firstX(1) == 4 && FrameMap{{9, 9}, {3, 3}}.firstX(8) == 3);
static_assert(FrameMap{{3, 3}, {6, 6}}.sourceX(5) == 2 && FrameMap{{9, 9}, {3, 3}}.sourceY(0) == 1);

}  // namespace rg
