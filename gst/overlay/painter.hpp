// SPDX-License-Identifier: LGPL-2.1-or-later
// From results to a GstVideoOverlayComposition.
#pragma once

#include "core/base/memory/pool.hpp"
#include "core/objects/objects.hpp"
#include "gst/overlay/figure.hpp"
#include "gst/overlay/ground_grid.hpp"

#include <gst/video/video-overlay-composition.h>

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace rg::overlay {

/// What is drawn, and how large.
struct Views : Parts {
  bool graph = false;
  bool grid = false;  ///< On the ground, where there are objects' results.
  double trailLengthS = 2.0;
  double scale = 1.0;
  std::string caption;  ///< UTF-8, in the left upper corner.
};

/// What is known of a frame; each result may be missing.
struct Scene {
  Size frame;
  double framesPerSecond = 25;
  const objects::Objects* objects = nullptr;
  const graph::Graph* graph = nullptr;
  const motion::Motion* motion = nullptr;
};

struct Unref {
  void operator()(GstVideoOverlayComposition* composition) const {
    gst_video_overlay_composition_unref(composition);
  }
};
using CompositionPtr = std::unique_ptr<GstVideoOverlayComposition, Unref>;

/// Draws each object on a rectangle of its own, as large as it needs, and over these each label;
/// all on one as large as the frame where that is less. The rectangles' memory is used again once
/// nobody reads it.
class Painter {
 public:
  /// The objects of a frame that has passed, drawn or not: trails and the grid go on.
  void follow(const objects::Objects& objects, int64_t nowNs, double trailLengthS);
  /// Also drops a drawing that was begun and the memory for drawings.
  void forget();

  /// Null where there is nothing to draw.
  [[nodiscard]] CompositionPtr paint(const Scene& scene, const Views& views);

 private:
  [[nodiscard]] Layout layOutAll(const Scene& scene, const Views& views);
  [[nodiscard]] bool hasGrid(const Scene& scene, const Views& views) const;
  [[nodiscard]] Figure& nextFigure();
  [[nodiscard]] std::span<Figure> figures() { return {figures_.data(), figureCount_}; }
  void paintWhole(const Scene& scene, const Views& views, const Layout& layout);
  void paintEach(const Layout& layout);
  [[nodiscard]] Canvas addRectangle(const Box& box, const Style& style);

  Trails trails_;
  GroundGrid grid_;
  std::vector<Figure> figures_;  ///< The first figureCount_ are of this frame.
  std::vector<Box> extents_;     ///< Of these.
  size_t figureCount_ = 0;
  Pool<Image<uint32_t>> pool_;
  CompositionPtr composition_;  ///< The one being made.
};

}  // namespace rg::overlay
