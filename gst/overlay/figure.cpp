// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/overlay/figure.hpp"

#include "core/text/text.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>

namespace rg::overlay {
namespace {

/// A position in 1/16 px of the result, in pixels of the frame.
Point fromFine(int64_t x, int64_t y, const FrameMap& map) {
  return {static_cast<int>(divideRounded(map.x(x), objects::kPositionUnit)),
          static_cast<int>(divideRounded(map.y(y), objects::kPositionUnit))};
}

Stroke strokeOf(objects::ObjectState state) {
  switch (state) {
    case objects::ObjectState::Occluded:
      return Stroke::Dashed;
    case objects::ObjectState::Stopped:
      return Stroke::Corners;
    default:
      return Stroke::Solid;
  }
}

void writeLabel(const objects::Object& object, const Style& style, std::string& label) {
  text::appendUnsigned(label, object.id);
  if (object.state == objects::ObjectState::Tracked || !style.hasWords) return;
  label += ' ';
  label += text::name(object.state);
}

bool covers(const Box& place, const Box& other) {
  return !intersect(place, other).isEmpty();
}

/// Where the label of figure i may lie: around its box or inside.
std::array<Box, 8> placesFor(const Figure& figure, Size label) {
  const Box& box = figure.box;
  const Point corners[] = {{box.x, box.y - label.height},
                           {box.x, box.bottom()},
                           {box.right() - label.width, box.y - label.height},
                           {box.right(), box.y},
                           {box.x - label.width, box.y},
                           {box.x, box.y - 2 * label.height},
                           {box.x, box.bottom() + label.height},
                           {box.x, box.y}};
  std::array<Box, 8> places;
  for (size_t i = 0; i < places.size(); ++i)
    places[i] = {corners[i].x, corners[i].y, label.width, label.height};
  return places;
}

/// Of label i, by the labels before it. Where there is no place: above, moved into the frame.
Box placeLabel(std::span<const Figure> figures, size_t i, Size label, Size frame) {
  const std::array<Box, 8> places = placesFor(figures[i], label);
  const auto isFree = [&](const Box& place) {
    return intersect(place, boundsOf(frame)) == place &&
           std::none_of(figures.begin(), figures.begin() + static_cast<ptrdiff_t>(i),
                        [&](const Figure& other) { return covers(place, other.label); });
  };
  const auto hidesNothing = [&](const Box& place) {
    return std::none_of(figures.begin(), figures.end(),
                        [&](const Figure& other) { return covers(place, other.box); });
  };
  const Box* second = nullptr;
  for (const Box& place : places) {
    if (!isFree(place)) continue;
    if (hidesNothing(place)) return place;
    if (second == nullptr) second = &place;
  }
  if (second != nullptr) return *second;
  return {std::clamp(places[0].x, 0, std::max(0, frame.width - label.width)),
          std::clamp(places[0].y, 0, std::max(0, frame.height - label.height)), label.width,
          label.height};
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

void layOut(const objects::Object& object, const Layout& layout, const Trails& trails,
            Figure& figure) {
  const FrameMap& map = layout.map;
  figure.colour = colourOf(object.id);
  figure.stroke = strokeOf(object.state);
  figure.box = map.box(object.box);
  figure.centre = fromFine(object.centroidX, object.centroidY, map);
  figure.tip = figure.centre;
  // What has stopped goes nowhere, whatever its outline does.
  if (object.hasSpeed && object.state != objects::ObjectState::Stopped)
    figure.tip = fromFine(int64_t{object.centroidX} + object.speedX / 2,
                          int64_t{object.centroidY} + object.speedY / 2, map);
  figure.label = {};
  figure.text.clear();
  if (layout.parts.ids) writeLabel(object, layout.style, figure.text);
  figure.trail.clear();
  if (layout.parts.trails) {
    trails.copy(object, figure.trail);
    for (Point& point : figure.trail) point = fromFine(point.x, point.y, map);
  }
  figure.contour.clear();
  if (layout.parts.contours)
    for (const Point& point : object.contour) figure.contour.push_back(map.point(point));
}

void layOutCaption(const std::string& text, const Layout& layout, Figure& figure) {
  constexpr size_t kMostBytes = 256;
  constexpr graph::Colour kGround{40, 40, 40};
  figure = {};
  figure.colour = kGround;
  size_t end = std::min(text.size(), kMostBytes);
  const auto isInside = [&](size_t i) {  // A letter of several bytes.
    return i < text.size() && (static_cast<uint8_t>(text[i]) & 0xC0) == 0x80;
  };
  while (end > 0 && isInside(end)) --end;
  figure.text.assign(text, 0, end);
  const Size size = labelSize(figure.text, layout.style);
  figure.label = {0, 0, size.width, size.height};
}

void placeLabels(std::span<Figure> figures, const Layout& layout) {
  for (size_t i = 0; i < figures.size(); ++i) {
    Figure& figure = figures[i];
    if (figure.text.empty() || !figure.label.isEmpty()) continue;
    figure.label = placeLabel(figures, i, labelSize(figure.text, layout.style), layout.map.to);
  }
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
  return intersect(extent, boundsOf(layout.map.to));
}

void draw(const Figure& figure, const Layout& layout, Canvas& canvas) {
  if (figure.trail.size() > 1) canvas.path(figure.trail, figure.colour, Ends::Open);
  if (!figure.contour.empty()) canvas.path(figure.contour, figure.colour, Ends::Closed);
  if (layout.parts.boxes) canvas.box(figure.box, figure.colour, figure.stroke);
  if (hasArrow(figure, layout)) canvas.arrow(figure.centre, figure.tip, figure.colour);
}

void drawLabel(const Figure& figure, Canvas& canvas) {
  if (!figure.text.empty())
    canvas.label({figure.label.x, figure.label.y}, figure.text, figure.colour);
}

}  // namespace rg::overlay
