// SPDX-License-Identifier: LGPL-2.1-or-later
// A camera's motion as of the frame that its pixels are in now, and as plain numbers for readers.
//
// Determinism: sums, products and quotients of doubles, which are the same everywhere.
#pragma once

#include "core/base/camera/camera_motion.hpp"
#include "core/base/mapping.hpp"

#include <array>

namespace rg {

/// Where the middle of each pixel goes: x' = xx x + xy y + x0, y' = yx x + yy y + y0. There has to
/// be a way back.
struct PixelWay {
  double xx = 1, xy = 0, x0 = 0;
  double yx = 0, yy = 1, y0 = 0;

  friend constexpr bool operator==(const PixelWay&, const PixelWay&) = default;
};

/// The centre of a pixel goes to the centre of those that it becomes.
[[nodiscard]] constexpr PixelWay wayAlong(const FrameMap& map) {
  const double x = static_cast<double>(map.to.width) / map.from.width;
  const double y = static_cast<double>(map.to.height) / map.from.height;
  return {x, 0, (x - 1) / 2, 0, y, (y - 1) / 2};
}
static_assert(wayAlong({{4, 6}, {8, 3}}) == PixelWay{2, 0, .5, 0, .5, -.25});

/// From a pixel (x, y) of this frame to where the same was in the previous one: previous · w =
/// (m0 x + m1 y + m2, m3 x + m4 y + m5), w = m6 x + m7 y + m8, m8 = 1. (0, 0) is the middle of the
/// left upper pixel.
using CameraMatrix = std::array<double, 9>;

/// First by b, then by a.
[[nodiscard]] CameraMatrix chained(const CameraMatrix& a, const CameraMatrix& b);

/// The motion of a camera whose frames' pixels all went that way. Where that can't be computed with
/// it is the shift at the origin; no motion where `camera` is not safe.
[[nodiscard]] CameraMotion moved(const CameraMotion& camera, const PixelWay& way);

/// The motion since an older frame: first `since`, which leads to a frame, then that from there on.
/// Where it can't be computed with it is that of the origin; no motion where one is not safe.
[[nodiscard]] CameraMotion followed(const CameraMotion& since, const CameraMotion& before);

/// Finite numbers. Where w is not what CameraMotion asks for at (0, 0) it is the shift at the
/// origin; the unit matrix where `camera` is not safe.
[[nodiscard]] CameraMatrix matrixOf(const CameraMotion& camera);

}  // namespace rg
