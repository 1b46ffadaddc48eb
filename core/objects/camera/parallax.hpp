// SPDX-License-Identifier: LGPL-2.1-or-later
// What stands still beside the plane that the camera's homography follows (part of stage 5).
//
// Between two frames such things are displaced, beyond the homography, along lines through one
// point of the picture, the epipole: the nearer ones one way, the farther ones the other way, and
// all the more the farther from the plane. A thing that moves may do so along its line by chance,
// and any that moves straight on lies on lines through a point of its own. So a direction counts
// only where those who follow it are spread over the frame as no single thing is.
//
// Determinism: one thread, a fixed order, and of floating point only what IEEE 754 rounds in one
// way.
#pragma once

#include "core/motion/motion.hpp"
#include "core/objects/camera/camera_motion.hpp"

#include <cstdint>
#include <vector>

namespace rg::objects {

class Parallax {
 public:
  /// threshold: motions that differ by less are alike, 1/16 px.
  void find(const motion::Motion& motion, const CameraMotion& camera, int threshold);
  /// Whether what is at `place` (pixels) moves beyond the camera's motion (by `beyond`, 1/16 px) as
  /// if it stood still.
  [[nodiscard]] bool explains(Point place, Point beyond) const;
  [[nodiscard]] bool isSeen() const { return follows_[0] || follows_[1]; }

 private:
  struct Sample {
    double x = 0, y = 0;    ///< Pixels.
    double dx = 0, dy = 0;  ///< Beyond the camera's motion.
    double weight = 0;
    uint32_t cell = 0;
  };
  struct Epipole {
    double x = 0, y = 0, w = 0;
  };
  struct Support {
    double weight = 0;
    double spread = 0;  ///< Variance of the places, as share of that of the frame's.
  };

  void listSamples(const motion::Motion& motion, const CameraMotion& camera);
  /// −1 = not on its line, 0 = towards the epipole, 1 = away from it.
  [[nodiscard]] int sideOf(const Epipole& epipole, const Sample& sample) const;
  [[nodiscard]] Support supportOf(const Epipole& epipole, int side);

  std::vector<Sample> samples_;
  std::vector<double> cells_;
  Size frame_;
  double threshold_ = 1;
  Epipole epipole_;
  bool follows_[2] = {false, false};  ///< By side.
};

}  // namespace rg::objects
