// SPDX-License-Identifier: LGPL-2.1-or-later
// The previous frame as the camera's motion alone makes it look now, for a search of what moves
// otherwise (part of stage 4). It is shifted by whole pixels, where a shift is all: what
// interpolation smooths is hard to compare with what it does not.
#pragma once

#include "core/base/camera/camera_motion.hpp"
#include "core/base/camera/camera_warp.hpp"
#include "core/base/memory/executor.hpp"
#include "core/base/picture.hpp"
#include "core/motion/matched_blocks.hpp"
#include "core/motion/motion.hpp"

#include <span>
#include <vector>

namespace rg::motion {

/// Of a camera's motions at the frame's corners the longest along one axis, in 1/16 px.
[[nodiscard]] int furthestMotion(const CameraMotion& camera, Size frame);

class CameraView {
 public:
  void show(ImageView<const uint8_t> previous, const CameraMotion& camera,
            const Executor& executor);
  [[nodiscard]] const Picture& picture() const { return picture_; }
  /// Motions in the shown picture become those between the frames. None is relied on where the
  /// previous frame does not show all that was matched.
  void addCamera(const graph::Graph& graph, const MatchedBlocks& blocks,
                 std::span<RegionMotion> motion) const;

 private:
  Picture picture_;
  CameraMotion camera_;
  std::vector<ShownRange> shown_;
};

}  // namespace rg::motion
