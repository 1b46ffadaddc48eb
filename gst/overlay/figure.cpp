// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/overlay/figure.hpp"

#include "core/text/line.hpp"
#include "core/text/names.hpp"

#include <algorithm>
#include <cstdlib>

namespace rg::overlay {
namespace {

/// A position in 1/16 px of the result, in pixels of the frame.
Point fromFine(int64_t x, int64_t y, const FrameMap& map) {
  return {static_cast<int>(divideRounded(map.x(x), kPositionUnit)),
          static_cast<int>(divideRounded(map.y(y), kPositionUnit))};
}

Stroke strokeOf(ObjectState state) {
  switch (state) {
    case ObjectState::Occluded:
      return Stroke::Dashed;
    case ObjectState::Stopped:
      return Stroke::Corners;
    default:
      return Stroke::Solid;
  }
}

void writeLabel(const Object& object, const Style& style, std::string& label) {
  text::appendUnsigned(label, object.id);
  if (object.state == ObjectState::Tracked || !style.hasWords) return;
  label += ' ';
  label += text::name(object.state);
}

bool isFree(const Box& place, std::span<const Box> taken) {
  return std::none_of(taken.begin(), taken.end(),
                      [&](const Box& other) { return !intersect(place, other).isEmpty(); });
}

/// Around the object's box or inside: the first place that lies in the frame and covers no other
/// label. Where there is none, above, moved into the frame.
Box placeLabel(const Box& box, Size label, Size frame, std::span<const Box> taken) {
  const Point corners[] = {{box.x, box.y - label.height},
                           {box.x, box.bottom()},
                           {box.right() - label.width, box.y - label.height},
                           {box.right(), box.y},
                           {box.x - label.width, box.y},
                           {box.x, box.y - 2 * label.height},
                           {box.x, box.bottom() + label.height},
                           {box.x, box.y}};
  for (const Point& corner : corners) {
    const Box place{corner.x, corner.y, label.width, label.height};
    if (intersect(place, boundsOf(frame)) == place && isFree(place, taken)) return place;
  }
  return {std::clamp(box.x, 0, std::max(0, frame.width - label.width)),
          std::clamp(box.y - label.height, 0, std::max(0, frame.height - label.height)),
          label.width, label.height};
}

Box hullOf(std::span<const Point> points) {
  Box bounds;
  for (const Point& p : points) bounds = unite(bounds, {p.x, p.y, 1, 1});
  return bounds;
}

/// A vector so short that its arrow would be all head says nothing.
bool hasArrow(const Figure& figure, const Layout& layout) {
  const int length =
      std::max(std::abs(figure.tip.x - figure.centre.x), std::abs(figure.tip.y - figure.centre.y));
  return layout.parts.vectors && length > 3 * layout.style.linePx;
}

}  // namespace

void layOut(const Object& object, const Layout& layout, const Trails& trails,
            std::vector<Box>& labels, Figure& figure) {
  const FrameMap& map = layout.map;
  figure.colour = colourOf(object.id);
  figure.stroke = strokeOf(object.state);
  figure.box = map.box(object.box);
  figure.centre = fromFine(object.centroidX, object.centroidY, map);
  figure.tip = figure.centre;
  if (object.hasSpeed)
    figure.tip = fromFine(int64_t{object.centroidX} + object.speedX / 2,
                          int64_t{object.centroidY} + object.speedY / 2, map);
  figure.text.clear();
  if (layout.parts.ids) {
    writeLabel(object, layout.style, figure.text);
    figure.label = placeLabel(figure.box, labelSize(figure.text, layout.style), map.to, labels);
    labels.push_back(figure.label);
  }
  figure.trail.clear();
  if (layout.parts.trails) {
    trails.copy(object, figure.trail);
    for (Point& point : figure.trail) point = fromFine(point.x, point.y, map);
  }
  figure.contour.clear();
  if (layout.parts.contours)
    for (const Point& point : object.contour) figure.contour.push_back(map.point(point));
}

Box extentOf(const Figure& figure, const Layout& layout) {
  const int linePx = layout.style.linePx;
  Box extent;
  if (layout.parts.boxes) extent = unite(extent, figure.box);
  extent = unite(extent, hullOf(figure.trail));
  extent = unite(extent, hullOf(figure.contour));
  if (hasArrow(figure, layout)) {
    const Point ends[] = {figure.centre, figure.tip};
    extent = unite(extent, inflate(hullOf(ends), 5 * linePx));
  }
  if (!extent.isEmpty()) extent = inflate(extent, 3 * linePx);
  if (!figure.text.empty()) extent = unite(extent, figure.label);
  return intersect(extent, boundsOf(layout.map.to));
}

void draw(const Figure& figure, const Layout& layout, Canvas& canvas) {
  if (figure.trail.size() > 1) canvas.path(figure.trail, figure.colour, Ends::Open);
  if (!figure.contour.empty()) canvas.path(figure.contour, figure.colour, Ends::Closed);
  if (layout.parts.boxes) canvas.box(figure.box, figure.colour, figure.stroke);
  if (hasArrow(figure, layout)) canvas.arrow(figure.centre, figure.tip, figure.colour);
  if (!figure.text.empty())
    canvas.label({figure.label.x, figure.label.y}, figure.text, figure.colour);
}

}  // namespace rg::overlay
