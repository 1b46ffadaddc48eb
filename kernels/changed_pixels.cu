// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/pixel.hpp"
#include "kernels/changed_pixels.hpp"
#include "kernels/start.hpp"
#include "kernels/threads.hpp"

namespace rg::gpu::background {
namespace {

using rg::background::CellCounts;
using rg::background::kCellPx;

__device__ int distanceAt(const Planes& a, const Planes& b, Point p) {
  int most = 0;
  for (int c = 0; c < a.channels; ++c)
    most = std::max(most, absDiff(a.planes[c].at(p.x, p.y), b.planes[c].at(p.x, p.y)));
  return most;
}

__global__ void measure(const __grid_constant__ Planes a, const __grid_constant__ Planes b,
                        ImageView<uint8_t> out) {
  const Point p = pixelOfThread();
  if (isWithin(p, out.size)) out.at(p.x, p.y) = static_cast<uint8_t>(distanceAt(a, b, p));
}

/// What a thread's pixel is: found, of it what differs from the frame before, and whether that is a
/// hit.
struct Look {
  bool isFound, hasMoved, isHit;
};
__device__ Look lookAt(const SearchedFrame& frame, Point p) {
  if (!isWithin(p, frame.now.size())) return {};
  const bool hasMoved =
      frame.before.channels != 0 && distanceAt(frame.now, frame.before, p) > frame.threshold;
  const bool isHit = hasMoved && frame.scanned.holds(p.y);
  const bool isRecalled = !hasMoved && frame.seeds.at(p.x / kCellPx, p.y / kCellPx) != 0 &&
                          frame.known.at(p.x, p.y) != 0 &&
                          distanceAt(frame.now, frame.scene, p) > frame.sceneThreshold;
  return {hasMoved || isRecalled, hasMoved, isHit};
}

constexpr int kCellsOfWarp = kWarp / kCellPx;
static_assert(kTile.x == kWarp && kTile.y == kCellPx);  // A block has four cells side by side.

/// Counts of a cell in one number: each is at most 64.
__device__ uint32_t countOfLane(unsigned bits, unsigned lane, int place) {
  const unsigned own = bits >> (lane / kCellPx * kCellPx) & ((1u << kCellPx) - 1);
  return static_cast<uint32_t>(__popcll(own)) << (8 * place);
}

__global__ void lookAtCells(const __grid_constant__ SearchedFrame frame, ImageView<uint8_t> pixels,
                            CellCounts* cells) {
  RG_SHARED(uint32_t, counts, kCellsOfWarp);
  const Point p = pixelOfThread();
  const unsigned lane = threadIdx.x;
  if (threadIdx.y == 0 && lane < kCellsOfWarp) counts[lane] = 0;
  __syncthreads();
  const Look look = lookAt(frame, p);
  if (isWithin(p, frame.now.size())) pixels.at(p.x + 1, p.y + 1) = look.isFound ? 255 : 0;
  const unsigned found = __ballot_sync(kFullWarp, look.isFound);
  const unsigned moved = __ballot_sync(kFullWarp, look.hasMoved);
  const unsigned hits = __ballot_sync(kFullWarp, look.isHit);
  if (lane % kCellPx == 0)
    atomicAdd(&counts[lane / kCellPx], countOfLane(found, lane, 0) | countOfLane(moved, lane, 1) |
                                           countOfLane(hits, lane, 2));
  __syncthreads();
  const Size grid = frame.seeds.size;
  const Point cell{static_cast<int>(blockIdx.x) * kCellsOfWarp + static_cast<int>(lane),
                   static_cast<int>(blockIdx.y)};
  if (threadIdx.y != 0 || lane >= kCellsOfWarp || !isWithin(cell, grid)) return;
  const uint32_t of = counts[lane];
  cells[cell.y * grid.width + cell.x] = {static_cast<uint8_t>(of), static_cast<uint8_t>(of >> 8),
                                         static_cast<uint8_t>(of >> 16)};
}

/// A warp has a word, a lane two of its columns. A row and a column of 0 are round the pixels.
__global__ void keepDenseOfWords(ImageView<const uint8_t> pixels, ImageView<const uint8_t> cells,
                                 BitTarget out) {
  const Point at = wordOfWarp();
  if (at.y >= out.size.height) return;  // The whole warp.
  const int lane = static_cast<int>(threadIdx.x);
  const auto isDense = [&](int column) {
    const Point p{at.x * kWordColumns + column, at.y};
    if (p.x >= out.size.width ||
        (cells.at(p.x / kCellPx, p.y / kCellPx) & rg::background::kThingCell) == 0)
      return false;
    int set = 0;
    for (int i = 0; i < 9; ++i) set += pixels.at(p.x + i % 3, p.y + i / 3) & 1;
    return set >= rg::background::kLeastDense;
  };
  const uint64_t word = packWord(isDense(lane), isDense(lane + kWarp));
  if (lane == 0) out.words.at(at.x, at.y) = word;
}

/// bytes: of a pixel beside those of the two pictures.
Launch over(const char* name, const Planes& a, double bytes) {
  const auto pixels = static_cast<double>(a.size().area());
  return launchOver(name, a.size(), 1,
                    {pixels * (2 * a.channels + bytes), pixels * (2 * a.channels + 2)});
}

}  // namespace

void differ(const Planes& a, const Planes& b, ImageView<uint8_t> out, Stream stream) {
  measureChange(a, b, out, stream);
}

void measureChange(const Planes& a, const Planes& b, ImageView<uint8_t> out, Stream stream) {
  start(over("measureChange", a, 1), stream, measure, a, b, out);
}

void searchCells(const SearchedFrame& frame, ImageView<uint8_t> pixels, CellCounts* cells,
                 Stream stream) {
  start(over("searchCells", frame.now, 1 + 3.0 / (kCellPx * kCellPx)), stream, lookAtCells, frame,
        pixels, cells);
}

void keepDenseInCells(ImageView<const uint8_t> pixels, ImageView<const uint8_t> cells,
                      const BitTarget& out, Stream stream) {
  const auto area = static_cast<double>(out.size.area());
  start(launchOverWords("keepDenseInCells", out.size, {1.25 * area, 10 * area}), stream,
        keepDenseOfWords, pixels, cells, out);
}

}  // namespace rg::gpu::background
