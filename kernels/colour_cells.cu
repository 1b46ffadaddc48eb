// SPDX-License-Identifier: LGPL-2.1-or-later
#include "kernels/colour_cells.hpp"
#include "kernels/hue_of.hpp"
#include "kernels/start.hpp"
#include "kernels/threads.hpp"

namespace rg::gpu::segmentation {
namespace {

/// Weights 1 2 1, each half rounded up.
__device__ int meanOf(int a, int b, int middle) {
  return (((a + b + 1) >> 1) + middle + 1) >> 1;
}

__global__ void smoothPixels(const __grid_constant__ Planes picture,
                             const __grid_constant__ PlaneTargets out) {
  const Point p = pixelOfThread();
  if (!isWithin(p, out.size())) return;
  const ImageView<const uint8_t>& plane = picture.planes[blockIdx.z];
  const int above = std::max(0, p.y - 1), below = std::min(plane.height() - 1, p.y + 1);
  const auto down = [&](int x) {
    return meanOf(plane.at(x, above), plane.at(x, below), plane.at(x, p.y));
  };
  const int left = down(std::max(0, p.x - 1)), right = down(std::min(plane.width() - 1, p.x + 1));
  out.planes[blockIdx.z].at(p.x, p.y) = static_cast<uint8_t>(meanOf(left, right, down(p.x)));
}

/// A cell's pixels, cut off by the frame's border.
struct CellBox {
  int left, top, right, bottom;
};
__device__ CellBox boxOf(Point cell, int side, Size size) {
  return {cell.x * side, cell.y * side, std::min(size.width, (cell.x + 1) * side),
          std::min(size.height, (cell.y + 1) * side)};
}

struct ChannelOfCell {
  uint8_t mean, range;
};
__device__ ChannelOfCell summedUp(ImageView<const uint8_t> plane, ImageView<const uint8_t> scope,
                                  const CellBox& box, int weight) {
  int sum = 0, least = 255, most = 0;
  for (int y = box.top; y < box.bottom; ++y)
    for (int x = box.left; x < box.right; ++x) {
      if (!isInScope(scope, {x, y})) continue;
      const int level = plane.at(x, y);
      sum += level;
      least = std::min(least, level);
      most = std::max(most, level);
    }
  return {static_cast<uint8_t>((sum + weight / 2) / weight), static_cast<uint8_t>(most - least)};
}

/// A thread for each cell.
__global__ void averagePixels(const __grid_constant__ Planes smooth, ImageView<const uint8_t> scope,
                              int side, const __grid_constant__ CellTargets out) {
  const Point cell = pixelOfThread();
  if (!isWithin(cell, out.weights.size)) return;
  const CellBox box = boxOf(cell, side, smooth.size());
  int weight = 0;
  uint8_t kind = 0;
  for (int y = box.top; y < box.bottom; ++y)
    for (int x = box.left; x < box.right; ++x) {
      if (!isInScope(scope, {x, y})) continue;
      ++weight;
      if (scope.data != nullptr) kind = scope.at(x, y);  // No cell holds both kinds.
    }
  out.weights.at(cell.x, cell.y) = static_cast<uint8_t>(weight);
  if (scope.data != nullptr) out.scope.at(cell.x, cell.y) = kind;
  if (weight == 0) return;
  uint8_t range = 0;
  for (int c = 0; c < smooth.channels; ++c) {
    const ChannelOfCell channel = summedUp(smooth.planes[c], scope, box, weight);
    out.colours.planes[c].at(cell.x, cell.y) = channel.mean;
    range = std::max(range, channel.range);
  }
  out.ranges.at(cell.x, cell.y) = range;
}

}  // namespace

void smoothColours(const Planes& picture, const PlaneTargets& out, Stream stream) {
  const double bytes = static_cast<double>(picture.size().area()) * picture.channels;
  start(launchOver("smoothColours", picture.size(), static_cast<unsigned>(picture.channels),
                   {2 * bytes, 16 * bytes}),
        stream, smoothPixels, picture, out);
}

void averageCells(const Planes& smooth, ImageView<const uint8_t> scope, int sidePx,
                  const CellTargets& out, Stream stream) {
  const double bytes = static_cast<double>(smooth.size().area()) * smooth.channels;
  start(launchOver("averageCells", out.weights.size, 1, {bytes * 1.3, 6 * bytes}), stream,
        averagePixels, smooth, scope, sidePx, out);
}

}  // namespace rg::gpu::segmentation
