// SPDX-License-Identifier: LGPL-2.1-or-later
// Drawing with OpenCV on a part of the frame.
#pragma once

#include "core/base/geometry.hpp"
#include "core/base/memory/image.hpp"
#include "core/graph/graph.hpp"
#include "gst/overlay/style.hpp"

#include <opencv2/core.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace rg::overlay {

enum class Stroke { Solid, Dashed, Corners };
enum class Ends { Open, Closed };

/// A picture of pixels B, G, R, A, colours multiplied by alpha, that shows the part of the frame
/// whose left upper corner is `origin`. All coordinates are the frame's; what lies outside is cut
/// off. Lines have a dark rim, so that they show on any ground.
class Canvas {
 public:
  /// Clears the pixels, which must outlive the canvas.
  Canvas(ImageView<uint32_t> pixels, Point origin, const Style& style);

  void box(const Box& whole, const graph::Colour& colour, Stroke stroke);
  void path(std::span<const Point> points, const graph::Colour& colour, Ends ends);
  void arrow(Point from, Point to, const graph::Colour& colour);
  /// With a ring round it, in a colour that shows where the disc's own doesn't.
  void disc(Point centre, int radius, const graph::Colour& colour, const graph::Colour& ring);
  /// Text on a ground of the colour; `corner` is the ground's left upper one.
  void label(Point corner, const std::string& text, const graph::Colour& colour);

  [[nodiscard]] const Style& style() const { return style_; }

 private:
  void line(Point from, Point to, const graph::Colour& colour);
  [[nodiscard]] int rimmedPx() const { return style_.linePx + 2 * style_.rimPx; }
  void dashes(Point from, Point to, const graph::Colour& colour);
  void border(const Box& outer, int thickness, const cv::Scalar& ink);
  void cornerMark(Point corner, Point towards, const graph::Colour& colour);
  [[nodiscard]] cv::Point at(Point p) const { return {p.x - origin_.x, p.y - origin_.y}; }

  cv::Mat pixels_;
  Point origin_;
  Style style_;
  std::vector<cv::Point> points_;  ///< Of the path being drawn.
};

/// Size of a label's ground.
[[nodiscard]] Size labelSize(const std::string& text, const Style& style);

}  // namespace rg::overlay
