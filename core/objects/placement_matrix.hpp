// SPDX-License-Identifier: LGPL-2.1-or-later
// From a homography between two frames to a placement, where the one is a part of the other, scaled
// or turned by right angles.
#pragma once

#include "core/objects/result_placer.hpp"

#include <optional>

namespace rg::objects {

/// A frame that was drawn into another one: what lay in `fromPart` lies in `toPart`. The matrix
/// takes edges of pixels from the left upper corner of the one to that of the other, as GStreamer's
/// GstVideoMetaTransformMatrix (1.28).
struct Drawn {
  Size from, to;
  Box fromPart, toPart;
  const float (*matrix)[3];
};

/// Of results, which keep the scale that they were made at. None where the matrix turns by other
/// angles, shears or shows perspective, and where nothing is left.
[[nodiscard]] std::optional<Placement> placementOf(const Drawn& drawn);

}  // namespace rg::objects
