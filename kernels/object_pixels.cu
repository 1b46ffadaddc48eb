// SPDX-License-Identifier: LGPL-2.1-or-later
#include "kernels/object_pixels.hpp"
#include "kernels/start.hpp"
#include "kernels/threads.hpp"
#include "kernels/warp_runs.hpp"

namespace rg::gpu::objects {
namespace {

using rg::objects::ObjectSums;

__global__ void beginObjects(const __grid_constant__ ObjectPixelsView out) {
  const int i = indexInGrid();
  if (i >= out.count) return;
  out.sums[i] = {};
  out.firsts[i] = UINT32_MAX;
}

__device__ uint32_t ownerOf(const OwnedPixels& owned, Point p) {
  const uint32_t label = owned.labels.at(p.x, p.y);
  if (label == 0 || owned.isBackground[label - 1] != 0) return 0;
  return owned.owners[p.y / owned.stepPx * owned.cellsPerRow + p.x / owned.stepPx];
}

/// A warp adds what it has of an object side by side once.
__global__ void givePixels(const __grid_constant__ OwnedPixels owned,
                           const __grid_constant__ ObjectPixelsView out) {
  const Point p = pixelOfThread();
  const bool isInside = isWithin(p, owned.labels.size);
  const uint32_t slot = isInside ? ownerOf(owned, p) : 0;
  if (isInside) out.slots.at(p.x, p.y) = static_cast<uint16_t>(slot);
  if (!__any_sync(kFullWarp, slot != 0)) return;
  const auto level = [&](int c) {
    const int channel = c < owned.picture.channels ? c : 0;
    return slot == 0 ? 0u : uint32_t{owned.picture.planes[channel].at(p.x, p.y)};
  };
  const LaneRun run = runOfLane(slot);
  const uint32_t red = sumOfRun(run, level(0)), green = sumOfRun(run, level(1)),
                 blue = sumOfRun(run, level(2));
  if (slot == 0 || !run.isLast) return;
  ObjectSums& sums = out.sums[slot - 1];
  const auto count = static_cast<uint64_t>(run.before) + 1;
  const auto first = static_cast<uint32_t>(p.x - run.before), y = static_cast<uint32_t>(p.y);
  addSum(sums.count, count);
  addSum(sums.x, count * (first + static_cast<uint32_t>(p.x)) / 2);
  addSum(sums.y, count * y);
  addSum(sums.red, red);
  addSum(sums.green, green);
  addSum(sums.blue, blue);
  atomicMin(out.firsts + (slot - 1), y * static_cast<uint32_t>(owned.labels.width()) + first);
}

__global__ void placeFirsts(const __grid_constant__ ObjectPixelsView out) {
  const int i = indexInGrid();
  if (i >= out.count || out.sums[i].count == 0) return;
  const auto width = static_cast<uint32_t>(out.slots.width());
  out.sums[i].first = {static_cast<int>(out.firsts[i] % width),
                       static_cast<int>(out.firsts[i] / width)};
}

}  // namespace

void findObjectPixels(const OwnedPixels& owned, const ObjectPixelsView& out, Stream stream) {
  if (out.count == 0) return;
  const auto pixels = static_cast<double>(owned.labels.size.area());
  const auto count = static_cast<double>(out.count);
  start(launchOverList("beginObjects", out.count, {60 * count, 8 * count}), stream, beginObjects,
        out);
  start(launchOver("givePixels", owned.labels.size, 1,
                   {(4 + owned.picture.channels) * pixels, 60 * pixels}),
        stream, givePixels, owned, out);
  start(launchOverList("placeFirsts", out.count, {24 * count, 40 * count}), stream, placeFirsts,
        out);
}

}  // namespace rg::gpu::objects
