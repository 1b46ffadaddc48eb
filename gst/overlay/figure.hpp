// SPDX-License-Identifier: LGPL-2.1-or-later
// An object as it is to be drawn: everything in pixels of the frame.
#pragma once

#include "core/base/mapping.hpp"
#include "core/objects/objects.hpp"
#include "gst/overlay/canvas.hpp"
#include "gst/overlay/style.hpp"
#include "gst/overlay/trails.hpp"

#include <span>
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
  graph::Colour colour;
  Stroke stroke = Stroke::Solid;
  Box box;
  Point centre;
  Point tip;  ///< Where it will be in half a second; the centre where it has no speed.
  Box label;  ///< Ground of the text, which is drawn over all figures.
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
void layOut(const objects::Object& object, const Layout& layout, const Trails& trails,
            Figure& figure);

/// A figure that is a label only, in the frame's left upper corner. Very long texts are cut off.
void layOutCaption(const std::string& text, const Layout& layout, Figure& figure);

/// Finds a place in the frame for each label that has none: clear of those before it and, if there
/// is such a place, of all boxes.
void placeLabels(std::span<Figure> figures, const Layout& layout);

/// The part of the frame that the figure touches, lines' thickness included, the label not.
[[nodiscard]] Box extentOf(const Figure& figure, const Layout& layout);

void draw(const Figure& figure, const Layout& layout, Canvas& canvas);
void drawLabel(const Figure& figure, Canvas& canvas);

}  // namespace rg::overlay
