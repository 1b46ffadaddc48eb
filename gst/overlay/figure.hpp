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
  Point labelCorner;
  std::string label;
  std::vector<Point> trail;
  std::vector<Point> contour;
};

/// Lays an object out; `figure` keeps its memory. What `parts` leaves out is left empty.
void layOut(const Object& object, const Trails& trails, const FrameMap& map, const Parts& parts,
            const Style& style, Figure& figure);

/// The part of the frame that the figure touches, lines' thickness included.
[[nodiscard]] Box extentOf(const Figure& figure, const Parts& parts, const Style& style,
                           Size frame);

void draw(const Figure& figure, const Parts& parts, Canvas& canvas);

}  // namespace rg::overlay
