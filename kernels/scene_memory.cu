// SPDX-License-Identifier: LGPL-2.1-or-later
#include "kernels/block_reduce.hpp"
#include "kernels/scene_memory.hpp"
#include "kernels/start.hpp"
#include "kernels/threads.hpp"
#include "kernels/warp_runs.hpp"

namespace rg::gpu::background {
namespace {

using rg::background::kCellPx;
using rg::background::kComparedColumns;
using rg::background::OutlinePlanes;
using rg::background::OutlineSums;
using rg::background::ScannedRows;
using rg::background::SceneCounts;

/// Threads take the compared columns of all rows in turns.
__global__ void countSceneInTurns(ImageView<const uint8_t> now, ImageView<const uint8_t> scene,
                                  ImageView<const uint8_t> isKnown, int threshold, int perRow,
                                  SceneCounts* counts) {
  RG_SHARED(uint32_t, values, kReduceWarps);
  const int count = perRow * now.height();
  SceneCounts own;
  for (int i = indexInGrid(); i < count; i += static_cast<int>(gridDim.x) * kReduceThreads) {
    const int x = i % perRow * kComparedColumns, y = i / perRow;
    if (isKnown.at(x, y) == 0) continue;
    const int level = now.at(x, y), before = scene.at(x, y);
    ++own.known;
    own.brighter += level > before + threshold;
    own.darker += before > level + threshold;
  }
  const SceneCounts all{reduceBlock(own.known, values, Total{}),
                        reduceBlock(own.brighter, values, Total{}),
                        reduceBlock(own.darker, values, Total{})};
  if (threadIdx.x != 0) return;
  atomicAdd(&counts->known, all.known);
  atomicAdd(&counts->brighter, all.brighter);
  atomicAdd(&counts->darker, all.darker);
}

__global__ void learnPixels(const __grid_constant__ Planes now, ScannedRows scanned,
                            ImageView<const uint8_t> cells,
                            const __grid_constant__ MemoryView memory) {
  const Point p = pixelOfThread();
  if (!isWithin(p, memory.known.size)) return;
  const int cell = cells.at(p.x / kCellPx, p.y / kCellPx);
  const bool isFree = (cell & rg::background::kKeptCell) == 0 && scanned.holds(p.y);
  if (!isFree && (cell & rg::background::kSceneCell) == 0) return;
  for (int c = 0; c < now.channels; ++c)
    memory.seen.planes[c].at(p.x, p.y) = now.planes[c].at(p.x, p.y);
  memory.known.at(p.x, p.y) = 255;
}

/// What a lane, then a warp has read; of a cell at most 64 * 4 * 255.
struct OwnOutline {
  uint32_t inPicture = 0, inScene = 0, read = 0;
};

/// A warp has a cell, a lane two of its pixels.
__global__ void readOutlines(OutlineCells cells, ImageView<const uint8_t> pixels,
                             const __grid_constant__ OutlinePlanes planes, OutlineSums* sums) {
  const int index = indexInGrid() / kWarp;
  if (index >= cells.count) return;  // The whole warp.
  const OutlineCell cell = cells.list[index];
  const auto lane = static_cast<int>(threadIdx.x % kWarp);
  const auto isFound = [&](Point p) { return pixels.at(p.x + 1, p.y + 1) != 0; };
  OwnOutline own;
  for (int i = lane; i < kCellPx * kCellPx; i += kWarp) {
    const Point p{cell.x * kCellPx + i % kCellPx, cell.y * kCellPx + i / kCellPx};
    if (isWithin(p, planes.known.size) && isFound(p))
      rg::background::addOutline(p, isFound, planes, own);
  }
  own = {sumOfWarp(own.inPicture), sumOfWarp(own.inScene), sumOfWarp(own.read)};
  if (lane != 0 || own.read == 0) return;
  OutlineSums& to = sums[cell.part];
  addSum(to.inPicture, own.inPicture);
  addSum(to.inScene, own.inScene);
  addSum(to.read, own.read);
}

}  // namespace

void countScene(ImageView<const uint8_t> now, ImageView<const uint8_t> scene,
                ImageView<const uint8_t> isKnown, int threshold, SceneCounts* counts,
                Stream stream) {
  const int perRow = (now.width() + kComparedColumns - 1) / kComparedColumns;
  const int64_t points = int64_t{perRow} * now.height();
  const auto of = static_cast<double>(points);
  clear(counts, sizeof *counts, stream);
  // A byte that is looked at costs the 32 round it.
  start(launchInTurns("countScene", points, {3 * 32 * of, 8 * of}), stream, countSceneInTurns, now,
        scene, isKnown, threshold, perRow, counts);
}

void learnScene(const Planes& now, ScannedRows scanned, ImageView<const uint8_t> cells,
                const MemoryView& memory, Stream stream) {
  const auto pixels = static_cast<double>(memory.known.size.area());
  const double learnt = pixels / scanned.step;
  start(launchOver("learnScene", memory.known.size, 1,
                   {(2.0 * now.channels + 1) * learnt, 4 * pixels}),
        stream, learnPixels, now, scanned, cells, memory);
}

void sumOutlines(const OutlineCells& cells, ImageView<const uint8_t> pixels,
                 const OutlinePlanes& planes, OutlineSums* sums, Stream stream) {
  const double area = static_cast<double>(cells.count) * kCellPx * kCellPx;
  clear(sums, static_cast<size_t>(cells.parts) * sizeof *sums, stream);
  start(launchOverList("sumOutlines", int64_t{cells.count} * kWarp, {8 * area, 20 * area}), stream,
        readOutlines, cells, pixels, planes, sums);
}

}  // namespace rg::gpu::background
