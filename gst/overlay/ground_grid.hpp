// SPDX-License-Identifier: LGPL-2.1-or-later
// A grid that lies on the ground and moves as the camera moves the ground.
#pragma once

#include "core/base/camera/camera_place.hpp"
#include "core/objects/objects.hpp"
#include "gst/overlay/canvas.hpp"

#include <array>
#include <span>
#include <vector>

namespace rg::overlay {

/// Squares in the frame that they were laid out in; from then on what the camera makes of them.
/// They cover all that is seen. Laid out anew where the scene or the frames' size changes, and
/// where a square has become three times as large or small, or a plane is seen from too low.
class GroundGrid {
 public:
  struct Place {
    double x, y;
  };
  struct Line {
    Place from, to;
  };

  void clear() { size_ = {}; }
  /// Of the frames that the results were made for; empty before the first one.
  [[nodiscard]] Size size() const { return size_; }

  /// Moves on to the next frame.
  void advance(const objects::Objects& objects);

  /// The parts of its lines that the frame shows, in pixels of these frames.
  [[nodiscard]] std::span<const Line> lines();

 private:
  void layOut(Size size);
  [[nodiscard]] bool isReadable() const;
  [[nodiscard]] Place laidOutAt(Place now) const;
  [[nodiscard]] std::array<Place, 4> corners() const;
  void addLines(size_t axis);

  Size size_;
  CameraMatrix anchor_{};  ///< From this frame to the one in which it was laid out.
  std::vector<Line> lines_;
};

/// The lines on a frame of any size.
void drawGrid(GroundGrid& grid, const FrameMap& map, Canvas& canvas);

}  // namespace rg::overlay
