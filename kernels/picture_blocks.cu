// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/camera/camera_pixels.hpp"
#include "kernels/block_reduce.hpp"
#include "kernels/picture_blocks.hpp"
#include "kernels/start.hpp"
#include "kernels/threads.hpp"

#include <cassert>

namespace rg::gpu {
namespace {

__global__ void averageBoxes(ImageView<const uint8_t> from, int side, ImageView<uint8_t> to) {
  const Point p = pixelOfThread();
  if (isWithin(p, to.size)) to.at(p.x, p.y) = meanOfBox(from, side, p);
}

/// A row of a block.
struct Eight {
  unsigned low, high;
};
static_assert(kCameraBlock == 8);

/// Of a row that lies within the plane: no word is read that has none of its pixels, for behind the
/// last one there may be nothing.
__device__ Eight loadEightAnywhere(const uint8_t* bytes) {
  const auto offset = static_cast<unsigned>(reinterpret_cast<uintptr_t>(bytes) % 4);
  const uint8_t* words = bytes - offset;
  const unsigned first = loadQuad(words), second = loadQuad(words + 4);
  const unsigned third = offset == 0 ? 0 : loadQuad(words + 8);
  return {__funnelshift_r(first, second, 8 * offset), __funnelshift_r(second, third, 8 * offset)};
}

__device__ uint32_t sadOfBlock(ImageView<const uint8_t> now, ImageView<const uint8_t> before,
                               Point at, Point from) {
  uint32_t sad = 0;
  for (int y = 0; y < kCameraBlock; ++y) {
    const uint8_t* row = now.row(at.y + y) + at.x;
    const Eight then = loadEightAnywhere(before.row(from.y + y) + from.x);
    sad += __vsadu4(loadQuad(row), then.low) + __vsadu4(loadQuad(row + 4), then.high);
  }
  return sad;
}

/// A block of threads for each block of pixels; neighbours in a warp see neighbouring pixels.
__global__ void searchBlocks(ImageView<const uint8_t> now, ImageView<const uint8_t> before,
                             const Point* shifts, int reach, BlockMatch* matches) {
  RG_SHARED(unsigned long long, ranks, kReduceWarps);
  const auto block = static_cast<int>(blockIdx.x);
  const Point at = BlockGrid::of(now.size).cornerOf(block), middle = shifts[block];
  const ShiftSpan xs = ShiftSpan::of(at.x, before.width(), middle.x, reach);
  const ShiftSpan ys = ShiftSpan::of(at.y, before.height(), middle.y, reach);
  const int columns = xs.count(), count = columns * ys.count();
  if (count == 0) return;
  unsigned long long least = ~0ull;
  for (int i = static_cast<int>(threadIdx.x); i < count; i += kReduceThreads) {
    const Point shift{xs.last - i % columns, ys.last - i / columns};
    const uint32_t sad = sadOfBlock(now, before, at, {at.x - shift.x, at.y - shift.y});
    Point apart{shift.x - middle.x, shift.y - middle.y};
    if (isMutated(Mutant::WrongTieBreak)) apart = {-apart.x, apart.y};
    const unsigned long long rank = rankOfMatch(sad, apart);
    least = rank < least ? rank : least;
  }
  least = reduceBlock(least, ranks,
                      [](unsigned long long a, unsigned long long b) { return a < b ? a : b; });
  if (threadIdx.x != 0) return;
  BlockMatch found = matchOfRank(least, middle);
  if (isMutated(Mutant::WrongTieBreak)) found.shift.x = 2 * middle.x - found.shift.x;
  if (found.sad <= matches[block].sad) matches[block] = found;
}

constexpr int kSumWarps = 8;

template <class T>
__device__ void addWarp(T& value) {
  for (int i = kWarp / 2; i > 0; i /= 2) value += __shfl_xor_sync(kFullWarp, value, i);
}

/// A warp for each block of pixels: eight lanes have a row and the one four below, and share the
/// places of its ends.
__global__ void sumPixels(ImageView<const uint8_t> now, ImageView<const uint8_t> before,
                          const __grid_constant__ CameraMotion camera, BlockSums* out) {
  constexpr int kRows = kWarp / kCameraBlock;
  const BlockGrid grid = BlockGrid::of(now.size);
  const int block = static_cast<int>(blockIdx.x * blockDim.y + threadIdx.y);
  if (block >= grid.count()) return;
  const Point at = grid.cornerOf(block);
  const auto lane = static_cast<int>(threadIdx.x);
  const int i = lane % kCameraBlock, begin = lane - i;
  BlockSums sums;
  for (int y = at.y + lane / kCameraBlock; y < at.y + kCameraBlock; y += kRows) {
    const Point end = camera.before(i < kCameraBlock / 2 ? at.x : at.x + kCameraBlock, y);
    const int last = begin + kCameraBlock - 1;
    const Point first{__shfl_sync(kFullWarp, end.x, begin), __shfl_sync(kFullWarp, end.y, begin)};
    const Point until{__shfl_sync(kFullWarp, end.x, last), __shfl_sync(kFullWarp, end.y, last)};
    const Point place = placeBetween(first, until, i, kCameraBlock);
    if (showsPlace(before.size, place)) addPixel(now, {at.x + i, y}, before, place, sums);
  }
  addWarp(sums.xx);
  addWarp(sums.xy);
  addWarp(sums.yy);
  addWarp(sums.xe);
  addWarp(sums.ye);
  addWarp(sums.ee);
  addWarp(sums.pixels);
  if (lane == 0) out[block] = sums;
}

constexpr double kBlockPixels = kCameraBlock * kCameraBlock;

}  // namespace

void shrink(ImageView<const uint8_t> from, int side, ImageView<uint8_t> to, Stream stream) {
  if (to.size.isEmpty()) return;
  const auto boxes = static_cast<double>(to.size.area());
  const double seen = boxes * side * side;
  start(launchOver("shrink", to.size, 1, {seen + boxes, seen + 2 * boxes}), stream, averageBoxes,
        from, side, to);
}

void matchBlocks(ImageView<const uint8_t> now, ImageView<const uint8_t> before, const Point* shifts,
                 int reach, BlockMatch* matches, Stream stream) {
  assert(reach < kMostCameraReach);
  const int blocks = BlockGrid::of(now.size).count();
  if (blocks == 0) return;
  // Of four pixels: two loads, a shift, a sum of differences, and as much for the loop.
  const double side = 2 * reach + 1, each = blocks;
  const auto pixels = static_cast<double>(now.size.area());
  const double perBlock = sizeof(Point) + 2 * sizeof(BlockMatch);
  start({"matchBlocks",
         {static_cast<unsigned>(blocks), 1, 1},
         {kReduceThreads, 1, 1},
         {2 * pixels + perBlock * each, 2 * kBlockPixels * side * side * each}},
        stream, searchBlocks, now, before, shifts, reach, matches);
}

void sumBlocks(ImageView<const uint8_t> now, ImageView<const uint8_t> before,
               const CameraMotion& camera, BlockSums* sums, Stream stream) {
  const int blocks = BlockGrid::of(now.size).count();
  if (blocks == 0) return;
  // Two divisions of 64 bits for a pixel, of 70 instructions each; as many for the rest.
  const double each = blocks;
  const auto pixels = static_cast<double>(now.size.area());
  start({"sumBlocks",
         {blocksFor(blocks, kSumWarps), 1, 1},
         {kWarp, kSumWarps, 1},
         {2 * pixels + sizeof(BlockSums) * each, 280 * kBlockPixels * each}},
        stream, sumPixels, now, before, camera, sums);
}

}  // namespace rg::gpu
