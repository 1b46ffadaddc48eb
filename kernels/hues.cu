// SPDX-License-Identifier: LGPL-2.1-or-later
#include "kernels/hue_of.hpp"
#include "kernels/hues.hpp"
#include "kernels/start.hpp"
#include "kernels/threads.hpp"

namespace rg::gpu::segmentation {
namespace {

using rg::segmentation::HueBands;
using rg::segmentation::kBackgroundHue;
using rg::segmentation::kNoHue;
using rg::segmentation::kObjectHue;

__global__ void classify(const __grid_constant__ Planes picture, HueBands bands,
                         ImageView<const uint8_t> scope, ImageView<uint8_t> raw) {
  const Point p = pixelOfThread();
  if (!isWithin(p, raw.size)) return;
  raw.at(p.x, p.y) = isInScope(scope, p) ? bands.classOf(hueAt(picture, p)) : kNoHue;
}

/// The picture's sides repeat.
__global__ void settle(ImageView<const uint8_t> raw, ImageView<const uint8_t> scope,
                       ImageView<uint8_t> classes) {
  const Point p = pixelOfThread();
  if (!isWithin(p, raw.size)) return;
  int votes = 0;
  for (int i = 0; i < 9; ++i) {
    const int x = std::clamp(p.x + i % 3 - 1, 0, raw.width() - 1);
    const int y = std::clamp(p.y + i / 3 - 1, 0, raw.height() - 1);
    const uint8_t found = raw.at(x, y);
    votes += found == kNoHue ? 0 : found == kObjectHue ? 1 : -1;
  }
  classes.at(p.x, p.y) = isInScope(scope, p)
                             ? rg::segmentation::settledClass(raw.at(p.x, p.y), votes)
                             : kBackgroundHue;
}

}  // namespace

void classifyHues(const Planes& picture, const HueBands& bands, ImageView<const uint8_t> scope,
                  ImageView<uint8_t> raw, ImageView<uint8_t> classes, Stream stream) {
  const auto pixels = static_cast<double>(raw.size.area());
  start(launchOver("classifyHues", raw.size, 1, {5 * pixels, 30 * pixels}), stream, classify,
        picture, bands, scope, raw);
  start(launchOver("settleHues", raw.size, 1, {3 * pixels, 20 * pixels}), stream, settle,
        ImageView<const uint8_t>(raw), scope, classes);
}

}  // namespace rg::gpu::segmentation
