// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/motion/camera/camera_view.hpp"

#include <algorithm>
#include <cstdlib>

namespace rg::motion {

void CameraView::show(ImageView<const uint8_t> previous, const CameraMotion& camera,
                      const Executor& executor) {
  camera_ = camera;
  shown_.resize(static_cast<size_t>(previous.height()));
  warpByCamera(previous, camera, executor, picture_.writeGrey(previous.size), shown_);
}

int CameraView::furthest() const {
  const Size size = picture_.size();
  int furthest = 0;
  for (const int x : {0, size.width - 1})
    for (const int y : {0, size.height - 1}) {
      const Point by = camera_.at(x, y);
      furthest = std::max({furthest, std::abs(by.x), std::abs(by.y)});
    }
  return furthest;
}

void CameraView::addCamera(const graph::Graph& graph, const MatchedBlocks& blocks,
                           std::span<RegionMotion> motion) const {
  for (size_t i = 0; i < motion.size(); ++i) {
    const graph::Region& region = graph.regions[i];
    const Point by = camera_.at(region.centroidX >> 8, region.centroidY >> 8);
    uint32_t all = 0, hidden = 0;
    for (const MatchedPart& part : blocks.partsOf(segmentation::RegionLabel::ofIndex(i)))
      forBlocks(part, [&](int x, int y) {
        const ShownRange& shown = shown_[static_cast<size_t>(y)];
        ++all;
        hidden += x < shown.first || x + kBlockWidth > shown.last ? 1 : 0;
      });
    if (4 * hidden > all) motion[i].reliability = 0;
    motion[i].dx += by.x;
    motion[i].dy += by.y;
  }
}

}  // namespace rg::motion
