// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/motion/camera/camera_view.hpp"

#include "core/base/pixel.hpp"

#include <algorithm>
#include <cstdlib>

namespace rg::motion {

int furthestMotion(const CameraMotion& camera, Size frame) {
  int furthest = 0;
  for (const int x : {0, frame.width - 1})
    for (const int y : {0, frame.height - 1}) {
      const Point by = camera.at(x, y);
      furthest = std::max({furthest, std::abs(by.x), std::abs(by.y)});
    }
  return furthest;
}

void CameraView::show(ImageView<const uint8_t> previous, const CameraMotion& camera,
                      const Executor& executor) {
  camera_ = camera;
  if (camera.isShift()) {
    const Point by = camera.at(0, 0);
    const auto whole = [](int motion) {
      return static_cast<int>(divideRounded(motion, kMotionUnit)) * kMotionUnit;
    };
    camera_ = CameraMotion(Point{whole(by.x), whole(by.y)});
  }
  shown_.resize(static_cast<size_t>(previous.height()));
  warpByCamera(previous, camera_, executor, picture_.writeGrey(previous.size), shown_);
}

void CameraView::addCamera(const graph::Graph& graph, const MatchedBlocks& blocks,
                           std::span<RegionMotion> motion) const {
  for (size_t i = 0; i < motion.size(); ++i) {
    const graph::Region& region = graph.regions[i];
    const Point by = camera_.at(region.centroidX >> 8, region.centroidY >> 8);
    bool isHidden = false;
    for (const MatchedPart& part : blocks.partsOf(segmentation::RegionLabel::ofIndex(i)))
      forBlocks(part, [&](int x, int y) {
        const ShownRange& shown = shown_[static_cast<size_t>(y)];
        isHidden |= x < shown.first || x + kBlockWidth > shown.last;
      });
    if (isHidden) motion[i].reliability = 0;
    motion[i].dx += by.x;
    motion[i].dy += by.y;
  }
}

}  // namespace rg::motion
