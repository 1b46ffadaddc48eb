// SPDX-License-Identifier: LGPL-2.1-or-later
// An object as it is to be drawn: everything in pixels of the frame.
#pragma once

#include "core/mapping.hpp"
#include "core/objects.hpp"
#include "gst/overlay/canvas.hpp"
#include "gst/overlay/style.hpp"
#include "gst/overlay/trails.hpp"

#include <string>
#include <vector>

namespace rg::overlay {

/// Which parts of an object are drawn.
struct Parts {
  bool boxes = true;
  bool ids = true;
  bool trails = true;
  bool contours = false;
  bool vectors = true;

  [[nodiscard]] bool any() const { return boxes || ids || trails || contours || vectors; }
};

struct Figure {
  Colour colour;
  Stroke stroke = Stroke::Solid;
  Box box;
  Point centre;
  Point tip;  ///< Where it will be in half a second; the centre where it has no speed.
  Box label;  ///< Ground of the text.
  std::string text;
  std::vector<Point> trail;
  std::vector<Point> contour;
};

/// What all figures of a frame have in common.
struct Layout {
  FrameMap map;  ///< From the result to the frame.
  Parts parts;
  Style style;
};

/// Lays an object out; `figure` keeps its memory. What the parts leave out is left empty.
/// labels: the grounds of the labels so far, which this one keeps clear of if it can; it is added.
void layOut(const Object& object, const Layout& layout, const Trails& trails,
            std::vector<Box>& labels, Figure& figure);

/// The part of the frame that the figure touches, lines' thickness included.
[[nodiscard]] Box extentOf(const Figure& figure, const Layout& layout);

void draw(const Figure& figure, const Layout& layout, Canvas& canvas);

}  // namespace rg::overlay
