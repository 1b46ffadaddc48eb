// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/overlay/canvas.hpp"

#include "gst/overlay/lettering.hpp"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>

namespace rg::overlay {
namespace {

constexpr int kOpaque = 255;
constexpr int kRimAlpha = 150;

/// Anti-aliased drawing mixes all four channels alike, which is right when the colours are
/// multiplied by alpha.
cv::Scalar ink(const graph::Colour& colour, int alpha = kOpaque) {
  const double share = static_cast<double>(alpha) / kOpaque;
  return {colour.blue * share, colour.green * share, colour.red * share,
          static_cast<double>(alpha)};
}

cv::Scalar rim() {
  return ink({0, 0, 0}, kRimAlpha);
}

bool isLight(const graph::Colour& colour) {
  return 77 * colour.red + 150 * colour.green + 29 * colour.blue > 256 * 110;
}

}  // namespace

Canvas::Canvas(ImageView<uint32_t> pixels, Point origin, const Style& style)
    : pixels_(pixels.height(), pixels.width(), CV_8UC4, pixels.data,
              static_cast<size_t>(pixels.strideBytes)),
      origin_(origin),
      style_(style) {
  pixels_.setTo(cv::Scalar::all(0));
}

void Canvas::line(Point from, Point to, const graph::Colour& colour) {
  if (style_.rimPx > 0) cv::line(pixels_, at(from), at(to), rim(), rimmedPx(), cv::LINE_AA);
  cv::line(pixels_, at(from), at(to), ink(colour), style_.linePx, cv::LINE_AA);
}

void Canvas::box(const Box& whole, const graph::Colour& colour, Stroke stroke) {
  // Edges far outside cost nothing: they are drawn just outside.
  constexpr int kOutsidePx = 256;
  const Box visible{origin_.x, origin_.y, pixels_.cols, pixels_.rows};
  const Box box = intersect(whole, inflate(visible, kOutsidePx));
  if (box.isEmpty()) return;
  const std::array<Point, 4> corners{Point{box.x, box.y}, Point{box.right() - 1, box.y},
                                     Point{box.right() - 1, box.bottom() - 1},
                                     Point{box.x, box.bottom() - 1}};
  if (stroke == Stroke::Solid) {
    border(inflate(box, style_.borderPx - 1 + style_.rimPx), style_.borderPx + 2 * style_.rimPx,
           rim());
    border(inflate(box, style_.borderPx - 1), style_.borderPx, ink(colour));
    return;
  }
  for (size_t i = 0; i < corners.size(); ++i) {
    const Point next = corners[(i + 1) % corners.size()];
    if (stroke == Stroke::Dashed) {
      dashes(corners[i], next, colour);
    } else {
      cornerMark(corners[i], next, colour);
      cornerMark(next, corners[i], colour);
    }
  }
}

/// Exactly as thick as asked, inwards from the box: OpenCV's own thick lines are thicker.
void Canvas::border(const Box& outer, int thickness, const cv::Scalar& ink) {
  const int upright = std::max(outer.height - 2 * thickness, 0);
  for (const Box& side : {Box{outer.x, outer.y, outer.width, thickness},
                          Box{outer.x, outer.bottom() - thickness, outer.width, thickness},
                          Box{outer.x, outer.y + thickness, thickness, upright},
                          Box{outer.right() - thickness, outer.y + thickness, thickness, upright}})
    if (!side.isEmpty())
      cv::rectangle(pixels_, cv::Rect(at({side.x, side.y}), cv::Size(side.width, side.height)), ink,
                    cv::FILLED);
}

void Canvas::cornerMark(Point corner, Point towards, const graph::Colour& colour) {
  const auto part = [](int from, int to) { return from + (to - from) / 4; };
  line(corner, {part(corner.x, towards.x), part(corner.y, towards.y)}, colour);
}

void Canvas::dashes(Point from, Point to, const graph::Colour& colour) {
  const int length = std::max(std::abs(to.x - from.x), std::abs(to.y - from.y));
  const int dash = 2 * (style_.spacePx + style_.linePx);
  const auto along = [&](int i) {
    return Point{from.x + static_cast<int>(int64_t{to.x - from.x} * i / std::max(length, 1)),
                 from.y + static_cast<int>(int64_t{to.y - from.y} * i / std::max(length, 1))};
  };
  for (int i = 0; i <= length; i += 2 * dash)
    line(along(i), along(std::min(i + dash, length)), colour);
}

void Canvas::path(std::span<const Point> points, const graph::Colour& colour, Ends ends) {
  points_.clear();
  for (const Point& point : points) points_.push_back(at(point));
  const bool isClosed = ends == Ends::Closed;
  if (style_.rimPx > 0) cv::polylines(pixels_, points_, isClosed, rim(), rimmedPx(), cv::LINE_AA);
  cv::polylines(pixels_, points_, isClosed, ink(colour), style_.linePx, cv::LINE_AA);
}

void Canvas::arrow(Point from, Point to, const graph::Colour& colour) {
  const double length = std::hypot(to.x - from.x, to.y - from.y);
  const double tip = std::clamp(4.0 * style_.linePx / std::max(length, 1.0), 0.15, 0.5);
  if (style_.rimPx > 0)
    cv::arrowedLine(pixels_, at(from), at(to), rim(), rimmedPx(), cv::LINE_AA, 0, tip);
  cv::arrowedLine(pixels_, at(from), at(to), ink(colour), style_.linePx, cv::LINE_AA, 0, tip);
}

void Canvas::disc(Point centre, int radius, const graph::Colour& colour,
                  const graph::Colour& ring) {
  const int ringPx = std::max(1, style_.linePx / 2), outer = radius + ringPx;
  cv::circle(pixels_, at(centre), outer + std::max(1, style_.rimPx), rim(), cv::FILLED,
             cv::LINE_AA);
  cv::circle(pixels_, at(centre), outer, ink(ring), cv::FILLED, cv::LINE_AA);
  cv::circle(pixels_, at(centre), radius, ink(colour), cv::FILLED, cv::LINE_AA);
}

void Canvas::label(Point corner, const std::string& text, const graph::Colour& colour) {
  const Size ground = labelSize(text, style_);
  cv::rectangle(pixels_, cv::Rect(at(corner), cv::Size(ground.width, ground.height)), ink(colour),
                cv::FILLED);
  const graph::Colour letters =
      isLight(colour) ? graph::Colour{0, 0, 0} : graph::Colour{255, 255, 255};
  const cv::Point left = at({corner.x + style_.spacePx, corner.y + style_.spacePx});
  drawLettering(pixels_, left, text, style_, letters);
}

Size labelSize(const std::string& text, const Style& style) {
  const Size letters = letteringSize(text, style);
  return {letters.width + 2 * style.spacePx, letters.height + 2 * style.spacePx};
}

}  // namespace rg::overlay
