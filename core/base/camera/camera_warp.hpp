// SPDX-License-Identifier: LGPL-2.1-or-later
// The previous frame as the camera's motion alone makes it look now.
//
// Between its pixels it is interpolated linearly, in sixteenths; at the border it repeats.
// Determinism: integers, each pixel for itself. A place is exact at every sixteenth column and in
// proportion between them.
#pragma once

#include "core/base/camera/camera_motion.hpp"
#include "core/base/memory/executor.hpp"
#include "core/base/memory/image.hpp"

#include <cstdint>
#include <span>

namespace rg {

/// Columns or rows, `last` not among them.
struct ShownRange {
  int first = 0, last = 0;
};

/// expected: of the size of `previous`. shown: of each row, the columns that the previous frame
/// shows, too.
void warpByCamera(ImageView<const uint8_t> previous, const CameraMotion& camera,
                  const Executor& executor, ImageView<uint8_t> expected,
                  std::span<ShownRange> shown);

}  // namespace rg
