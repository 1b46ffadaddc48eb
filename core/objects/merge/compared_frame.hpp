// SPDX-License-Identifier: LGPL-2.1-or-later
// An earlier frame that this one is compared with, and what has moved since then.
#pragma once

#include "core/base/camera/camera_motion.hpp"
#include "core/base/picture.hpp"
#include "core/base/pixel.hpp"
#include "core/motion/motion.hpp"

#include <cstddef>
#include <cstdint>

namespace rg::objects {

struct ComparedFrame {
  const Picture& picture;         ///< Of which the luma is compared.
  CameraMotion camera;            ///< Since then.
  int64_t ageNs = 1, stepNs = 1;  ///< Since then, and since the previous frame; above 0.

  /// By how much a region has moved otherwise than the camera, in 1/16 px, at the speed of its last
  /// step.
  [[nodiscard]] Point beyondCamera(const motion::Motion& motion, size_t region) const {
    const motion::RegionMotion& m = motion.regions[region];
    const Point step = at(motion.camera, motion, region);
    return sinceThen({m.dx - step.x, m.dy - step.y});
  }
  /// Whether that can be seen: it is more than a pixel.
  [[nodiscard]] bool showsMotion(const motion::Motion& motion, size_t region) const {
    const Point beyond = beyondCamera(motion, region);
    constexpr int64_t kLeast = motion::kMotionUnit;
    return int64_t{beyond.x} * beyond.x + int64_t{beyond.y} * beyond.y > kLeast * kLeast;
  }
  /// What moves so in a step does so since then.
  [[nodiscard]] Point sinceThen(Point ofStep) const {
    const auto scaled = [&](int64_t v) {
      return static_cast<int>(divideRounded(v * ageNs, stepNs));
    };
    return {scaled(ofStep.x), scaled(ofStep.y)};
  }

  [[nodiscard]] static Point at(const CameraMotion& camera, const motion::Motion& motion,
                                size_t region) {
    const graph::Region& where = motion.graph->regions[region];
    return camera.at(where.centroidX >> 8, where.centroidY >> 8);
  }
};

}  // namespace rg::objects
