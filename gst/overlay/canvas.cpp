// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/overlay/canvas.hpp"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <array>
#include <cstdlib>

namespace rg::overlay {
namespace {

constexpr int kOpaque = 255;
constexpr int kRimAlpha = 150;

/// Letters that are made of few strokes stay clear when they are small.
constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
constexpr double kCapitalPx = 21;  // Height of its capitals at scale 1.

/// Anti-aliased drawing mixes all four channels alike, which is right when the colours are
/// multiplied by alpha.
cv::Scalar ink(const Colour& colour, int alpha = kOpaque) {
  const auto channel = [&](int value) { return static_cast<double>(value * alpha / kOpaque); };
  return {channel(colour.blue), channel(colour.green), channel(colour.red),
          static_cast<double>(alpha)};
}

cv::Scalar rim() {
  return ink({0, 0, 0}, kRimAlpha);
}

int rimPx(int thickness) {
  return thickness + 2 * std::max(1, thickness / 2);
}

bool isLight(const Colour& colour) {
  return 77 * colour.red + 150 * colour.green + 29 * colour.blue > 256 * 110;
}

struct Font {
  double scale;
  int thickness;
};

Font fontOf(const Style& style) {
  return {style.textPx / kCapitalPx, std::max(1, (style.textPx + 5) / 10)};
}

cv::Size textSize(const std::string& text, const Style& style) {
  const Font font = fontOf(style);
  int baseline = 0;
  return cv::getTextSize(text, kFont, font.scale, font.thickness, &baseline);
}

}  // namespace

Canvas::Canvas(ImageView<uint32_t> pixels, Point origin, const Style& style)
    : pixels_(pixels.height(), pixels.width(), CV_8UC4, pixels.data,
              static_cast<size_t>(pixels.strideBytes)),
      origin_(origin),
      style_(style) {
  pixels_.setTo(cv::Scalar::all(0));
}

void Canvas::line(Point from, Point to, const Colour& colour, int thickness) {
  cv::line(pixels_, at(from), at(to), rim(), rimPx(thickness), cv::LINE_AA);
  cv::line(pixels_, at(from), at(to), ink(colour), thickness, cv::LINE_AA);
}

void Canvas::box(const Box& box, const Colour& colour, Stroke stroke) {
  const std::array<Point, 4> corners{Point{box.x, box.y}, Point{box.right() - 1, box.y},
                                     Point{box.right() - 1, box.bottom() - 1},
                                     Point{box.x, box.bottom() - 1}};
  if (stroke == Stroke::Solid) {
    const cv::Rect rect(at(corners[0]), at({box.right(), box.bottom()}));
    cv::rectangle(pixels_, rect, rim(), rimPx(style_.linePx));
    cv::rectangle(pixels_, rect, ink(colour), style_.linePx);
    return;
  }
  for (size_t i = 0; i < corners.size(); ++i)
    dashes(corners[i], corners[(i + 1) % corners.size()], colour, style_.linePx);
}

/// At most as many dashes as fit along the frame: the part outside the canvas is not worth a dash.
void Canvas::dashes(Point from, Point to, const Colour& colour, int thickness) {
  const int length = std::max(std::abs(to.x - from.x), std::abs(to.y - from.y));
  const int dash = 2 * (style_.spacePx + thickness);
  const auto along = [&](int i) {
    return Point{from.x + static_cast<int>(int64_t{to.x - from.x} * i / std::max(length, 1)),
                 from.y + static_cast<int>(int64_t{to.y - from.y} * i / std::max(length, 1))};
  };
  const cv::Rect visible(origin_.x - dash, origin_.y - dash, pixels_.cols + 2 * dash,
                         pixels_.rows + 2 * dash);
  for (int i = 0; i <= length; i += 2 * dash) {
    const Point start = along(i);
    const Point end = along(std::min(i + dash, length));
    if (visible.contains({start.x, start.y})) line(start, end, colour, thickness);
  }
}

void Canvas::path(std::span<const Point> points, const Colour& colour, Ends ends) {
  points_.clear();
  for (const Point& point : points) points_.push_back(at(point));
  const bool isClosed = ends == Ends::Closed;
  cv::polylines(pixels_, points_, isClosed, rim(), rimPx(style_.linePx), cv::LINE_AA);
  cv::polylines(pixels_, points_, isClosed, ink(colour), style_.linePx, cv::LINE_AA);
}

void Canvas::arrow(Point from, Point to, const Colour& colour) {
  const double length = std::hypot(to.x - from.x, to.y - from.y);
  const double tip = std::clamp(4.0 * style_.linePx / std::max(length, 1.0), 0.15, 0.5);
  cv::arrowedLine(pixels_, at(from), at(to), rim(), rimPx(style_.linePx), cv::LINE_AA, 0, tip);
  cv::arrowedLine(pixels_, at(from), at(to), ink(colour), style_.linePx, cv::LINE_AA, 0, tip);
}

void Canvas::disc(Point centre, int radius, const Colour& colour) {
  cv::circle(pixels_, at(centre), radius + std::max(1, style_.linePx / 2), rim(), cv::FILLED,
             cv::LINE_AA);
  cv::circle(pixels_, at(centre), radius, ink(colour), cv::FILLED, cv::LINE_AA);
}

void Canvas::label(Point corner, const std::string& text, const Colour& colour) {
  const Size ground = labelSize(text, style_);
  const Font font = fontOf(style_);
  cv::rectangle(pixels_, cv::Rect(at(corner), cv::Size(ground.width, ground.height)), ink(colour),
                cv::FILLED);
  const Colour letters = isLight(colour) ? Colour{0, 0, 0} : Colour{255, 255, 255};
  const Point baseline{corner.x + style_.spacePx, corner.y + ground.height - style_.spacePx - 1};
  cv::putText(pixels_, text, at(baseline), kFont, font.scale, ink(letters), font.thickness,
              cv::LINE_AA);
}

Size labelSize(const std::string& text, const Style& style) {
  const cv::Size letters = textSize(text, style);
  return {letters.width + 2 * style.spacePx, style.textPx + 2 * style.spacePx + 1};
}

}  // namespace rg::overlay
