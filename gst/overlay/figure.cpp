// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/overlay/figure.hpp"

#include "core/text/line.hpp"
#include "core/text/names.hpp"

#include <algorithm>
#include <cstdlib>

namespace rg::overlay {
namespace {

Point fromFine(Point p, const FrameMap& map) {
  return {static_cast<int>(divideRounded(map.x(p.x), kPositionUnit)),
          static_cast<int>(divideRounded(map.y(p.y), kPositionUnit))};
}

void writeLabel(const Object& object, std::string& label) {
  text::appendUnsigned(label, object.id);
  if (object.state == ObjectState::Tracked) return;
  label += ' ';
  label += text::name(object.state);
}

/// Above the box, inside where there is no room above; never beyond the frame's sides.
Point labelCornerOf(const Box& box, const Size& label, Size frame) {
  const int y = box.y >= label.height ? box.y - label.height : std::max(box.y, 0);
  return {std::clamp(box.x, 0, std::max(0, frame.width - label.width)),
          std::clamp(y, 0, std::max(0, frame.height - label.height))};
}

Box boundsOf(std::span<const Point> points) {
  Box bounds;
  for (const Point& p : points) bounds = unite(bounds, {p.x, p.y, 1, 1});
  return bounds;
}

/// A vector so short that its arrow would be all head says nothing.
bool hasArrow(const Figure& figure, const Parts& parts, const Style& style) {
  const int length =
      std::max(std::abs(figure.tip.x - figure.centre.x), std::abs(figure.tip.y - figure.centre.y));
  return parts.vectors && length > 3 * style.linePx;
}

}  // namespace

void layOut(const Object& object, const Trails& trails, const FrameMap& map, const Parts& parts,
            const Style& style, Figure& figure) {
  figure.colour = colourOf(object.id);
  figure.stroke = object.state == ObjectState::Occluded ? Stroke::Dashed : Stroke::Solid;
  figure.box = map.box(object.box);
  const Point centre{object.centroidX, object.centroidY};
  figure.centre = fromFine(centre, map);
  figure.tip = object.hasSpeed
                   ? fromFine({centre.x + object.speedX / 2, centre.y + object.speedY / 2}, map)
                   : figure.centre;
  figure.label.clear();
  if (parts.ids) {
    writeLabel(object, figure.label);
    figure.labelCorner = labelCornerOf(figure.box, labelSize(figure.label, style), map.to);
  }
  figure.trail.clear();
  if (parts.trails) {
    trails.copy(object, figure.trail);
    for (Point& point : figure.trail) point = fromFine(point, map);
  }
  figure.contour.clear();
  if (parts.contours)
    for (const Point& point : object.contour) figure.contour.push_back(map.point(point));
}

Box extentOf(const Figure& figure, const Parts& parts, const Style& style, Size frame) {
  Box extent;
  if (parts.boxes) extent = unite(extent, figure.box);
  extent = unite(extent, boundsOf(figure.trail));
  extent = unite(extent, boundsOf(figure.contour));
  if (hasArrow(figure, parts, style)) {
    const int head = 5 * style.linePx;
    const Point ends[] = {figure.centre, figure.tip};
    extent = unite(extent, inflate(boundsOf(ends), head));
  }
  extent = extent.isEmpty() ? extent : inflate(extent, 3 * style.linePx);
  if (!figure.label.empty()) {
    const Size ground = labelSize(figure.label, style);
    extent =
        unite(extent, {figure.labelCorner.x, figure.labelCorner.y, ground.width, ground.height});
  }
  return intersect(extent, rg::boundsOf(frame));
}

void draw(const Figure& figure, const Parts& parts, Canvas& canvas) {
  if (figure.trail.size() > 1) canvas.path(figure.trail, figure.colour, Ends::Open);
  if (!figure.contour.empty()) canvas.path(figure.contour, figure.colour, Ends::Closed);
  if (parts.boxes) canvas.box(figure.box, figure.colour, figure.stroke);
  if (hasArrow(figure, parts, canvas.style()))
    canvas.arrow(figure.centre, figure.tip, figure.colour);
  if (!figure.label.empty()) canvas.label(figure.labelCorner, figure.label, figure.colour);
}

}  // namespace rg::overlay
