// SPDX-License-Identifier: LGPL-2.1-or-later
// Frames of a plan, and what is true in each of them.
#pragma once

#include "tests/accuracy/view.hpp"
#include "tests/benchmarks/scene.hpp"

#include <cstdint>
#include <memory>
#include <vector>

namespace rg::truth {

/// Upper left corner and size, unrounded.
struct RealBox {
  double x = 0, y = 0, width = 0, height = 0;
};

/// An actor in a frame.
struct Fact {
  int actor = 0;
  RealBox box;                          ///< All of it, hidden or not.
  double centroidX = 0, centroidY = 0;  ///< Of all its pixels.
  double visible = 0;                   ///< Share of its pixels that is to be seen, 0 … 1.
  bool isInside = false;                ///< All of it lies within the frame.
  bool isSteady = false;                ///< It keeps its speed for a second before and after.
};

struct Scene {
  Size frame;
  std::vector<Fact> facts;
  Affine before;  ///< From this frame's pixels to where the same ground was in the previous one.
  double cameraDx = 0, cameraDy = 0;  ///< By how much it moved at the frame's middle, in pixels.
};

class Painter {
 public:
  Painter(Plan plan, std::unique_ptr<CanvasSource> source, uint32_t seed);

  /// Paints the next frame; false when the plan is over.
  bool next(bench::RawFrame& frame, Scene& scene);
  /// Leaves frames out.
  void skip(int frames);
  [[nodiscard]] const Plan& plan() const { return plan_; }
  /// Of each pixel of the last frame the actor that is seen, −1 = the ground.
  [[nodiscard]] const std::vector<int>& top() const { return top_; }

 private:
  struct Parts {
    float x = 0, y = 0;
  };
  void paintGround(const Canvas& canvas, const Affine& view, const Box& box);
  void paintActor(size_t index, const Affine& view, Scene& scene);
  void paintShifted(const Sprite& sprite, Place corner, int number);
  void paintTurned(const Sprite& sprite, const Affine& inFrame, const RealBox& box, int number);
  void paintObstacle(const Obstacle& obstacle, const Canvas& canvas, const Affine& view);
  /// One pixel of the frame, from a sprite's four pixels from `from` on; of the left ones and the
  /// upper ones the given parts.
  void blend(Point at, const Sprite& sprite, Point from, Parts part, int number);
  [[nodiscard]] size_t pixelAt(Point at) const;
  void tellCamera(Scene& scene) const;
  void addNoise(bench::RawFrame& frame);

  Plan plan_;
  std::unique_ptr<CanvasSource> source_;
  uint32_t seed_;
  int frame_ = 0;
  std::vector<Rgb> pixels_;
  std::vector<int> top_;
  std::vector<float> noise_;
};

}  // namespace rg::truth
