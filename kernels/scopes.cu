// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/row_spans.hpp"
#include "core/segmentation/hue_decision.hpp"
#include "core/segmentation/segmentation.hpp"
#include "kernels/scopes.hpp"
#include "kernels/start.hpp"
#include "kernels/threads.hpp"

namespace rg::gpu::segmentation {
namespace {

__global__ void fillScope(uint8_t value, ImageView<uint8_t> scope) {
  const Point p = pixelOfThread();
  if (isWithin(p, scope.size)) scope.at(p.x, p.y) = value;
}

/// Blocks take areas in turn. Where some overlap, they write the same.
__global__ void coverBoxes(AreasView areas, ImageView<uint8_t> scope) {
  for (uint32_t i = blockIdx.x; i < *areas.count; i += gridDim.x) {
    const Box box = rg::segmentation::coverOf(areas.list[i].box, scope.size);
    for (int y = box.y + static_cast<int>(threadIdx.y); y < box.bottom(); y += kTile.y)
      for (int x = box.x + static_cast<int>(threadIdx.x); x < box.right(); x += kTile.x)
        scope.at(x, y) = kInScope;
  }
}

__global__ void choosePixels(ImageView<const uint8_t> hue, ImageView<const uint8_t> evidence,
                             ImageView<const uint8_t> scope, ImageView<uint8_t> out) {
  const Point p = pixelOfThread();
  if (!isWithin(p, out.size)) return;
  const bool isForeground =
      evidence.data != nullptr && evidence.at(p.x, p.y) == rg::background::kForegroundPixel;
  const uint8_t own = scope.data != nullptr ? scope.at(p.x, p.y) : kInScope;
  out.at(p.x, p.y) = rg::segmentation::isWanted(hue.at(p.x, p.y), isForeground)
                         ? own
                         : rg::background::kBackgroundPixel;
}

}  // namespace

void coverAreas(const AreasView& areas, uint8_t around, ImageView<uint8_t> scope, Stream stream) {
  const auto pixels = static_cast<double>(scope.size.area());
  start(launchOver("fillScope", scope.size, 1, {pixels, pixels}), stream, fillScope, around, scope);
  start({"coverAreas",
         {std::min(blocksFor(scope.size.area(), 256), kMostBlocks), 1, 1},
         kTile,
         {pixels, pixels}},
        stream, coverBoxes, areas, scope);
}

void scopeByHue(ImageView<const uint8_t> hue, ImageView<const uint8_t> evidence,
                ImageView<const uint8_t> scope, ImageView<uint8_t> out, Stream stream) {
  const auto pixels = static_cast<double>(out.size.area());
  start(launchOver("scopeByHue", out.size, 1, {4 * pixels, 2 * pixels}), stream, choosePixels, hue,
        evidence, scope, out);
}

}  // namespace rg::gpu::segmentation
