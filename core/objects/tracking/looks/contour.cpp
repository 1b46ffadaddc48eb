// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/tracking/looks/contour.hpp"

namespace rg::objects {
namespace {

/// Clockwise from the right, y downwards.
constexpr Point kDirections[8] = {{1, 0},  {1, 1},   {0, 1},  {-1, 1},
                                  {-1, 0}, {-1, -1}, {0, -1}, {1, -1}};

}  // namespace

// Moore's walk: from each pixel look around clockwise, beginning behind the way it was entered. It
// ends when the start is left again in the first direction.
void traceContour(ImageView<const uint16_t> picture, Point start, int limit,
                  std::vector<Point>& contour) {
  contour.clear();
  const uint16_t value = picture.at(start.x, start.y);
  const Box bounds = boundsOf(picture.size);
  const auto isInside = [&](Point p) {
    return bounds.contains(p) && picture.at(p.x, p.y) == value;
  };
  const auto next = [&](Point p, int from) {
    for (int turn = 0; turn < 8; ++turn) {
      const int direction = (from + turn) & 7;
      if (isInside({p.x + kDirections[direction].x, p.y + kDirections[direction].y}))
        return direction;
    }
    return -1;
  };
  // The first pixel in raster order has nothing of its own above it nor to its left.
  const int first = next(start, 7);
  contour.push_back(start);
  if (first < 0) return;
  Point at = start;
  int direction = first;
  for (int step = 0; step < limit; ++step) {
    at = {at.x + kDirections[direction].x, at.y + kDirections[direction].y};
    const int onward = next(at, (direction + 5) & 7);
    if (at == start && onward == first) return;
    if (onward != direction) contour.push_back(at);
    direction = onward;
  }
}

}  // namespace rg::objects
