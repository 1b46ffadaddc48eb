// SPDX-License-Identifier: LGPL-2.1-or-later
// Floating point rounds as on the host: nvcc is told not to fuse (meson.build).
#include "kernels/haar_cascade.hpp"
#include "kernels/start.hpp"
#include "kernels/threads.hpp"

namespace rg::gpu::detection {
namespace {

using rg::detection::Integrals;
using rg::detection::JudgedPlanes;
using rg::detection::WindowPlace;
using rg::detection::WindowTable;

/// The sum of a warp's values up to this lane's.
__device__ uint32_t sumUpTo(uint32_t value, int lane) {
  for (int i = 1; i < kWarp; i *= 2) {
    const uint32_t before = __shfl_up_sync(kFullWarp, value, static_cast<unsigned>(i));
    if (lane >= i) value += before;
  }
  return value;
}

/// A warp for each row of sums, 32 columns after the other: sums along the row only. The first row
/// and column are 0. Of the last, half-empty group all lanes take part.
__global__ void sumRows(ImageView<const uint8_t> luma, const __grid_constant__ Integrals to) {
  const int lane = static_cast<int>(threadIdx.x);
  const int y = static_cast<int>(blockIdx.y * blockDim.y + threadIdx.y);
  const bool isRow = y < to.sums.height();
  uint32_t sum = 0, squared = 0;
  for (int first = 0; first < to.sums.width(); first += kWarp) {
    const int x = first + lane;
    const bool isInside = isRow && x < to.sums.width();
    const uint32_t level = isInside && x > 0 && y > 0 ? luma.at(x - 1, y - 1) : 0;
    const uint32_t upTo = sum + sumUpTo(level, lane);
    const uint32_t squaredUpTo = squared + sumUpTo(level * level, lane);
    if (isInside) {
      to.sums.at(x, y) = upTo;
      to.squares.at(x, y) = static_cast<double>(squaredUpTo);
    }
    sum = __shfl_sync(kFullWarp, upTo, kWarp - 1);
    squared = __shfl_sync(kFullWarp, squaredUpTo, kWarp - 1);
  }
}

/// A thread for each column: whole numbers below 2^53, so that the order does not matter.
__global__ void sumColumns(const __grid_constant__ Integrals to) {
  const int x = indexInGrid();
  if (x >= to.sums.width()) return;
  uint32_t sum = 0;
  double squares = 0;
  for (int y = 0; y < to.sums.height(); ++y) {
    sum += to.sums.at(x, y);
    squares += to.squares.at(x, y);
    to.sums.at(x, y) = sum;
    to.squares.at(x, y) = squares;
  }
}

__global__ void locate(WindowTable windows, WindowPlace* places) {
  const auto id = static_cast<uint32_t>(indexInGrid());
  if (id < windows.count) places[id] = rg::detection::placeOf(windows, id);
}

__global__ void judge(JudgedPlanes planes, WindowTable windows, uint16_t* stages) {
  const auto id = static_cast<uint32_t>(indexInGrid());
  if (id < windows.count) stages[id] = rg::detection::judgeWindowOf(planes, windows, id);
}

}  // namespace

void sumIntegrals(ImageView<const uint8_t> luma, const Integrals& to, Stream stream) {
  const auto pixels = static_cast<double>(to.sums.size.area());
  const Extent rows{1, blocksFor(to.sums.height(), kTile.y), 1};
  start({"sumRows", rows, kTile, {13 * pixels, 30 * pixels}}, stream, sumRows, luma, to);
  start(launchOverList("sumColumns", to.sums.width(), {24 * pixels, 4 * pixels}), stream,
        sumColumns, to);
}

void locateWindows(const WindowTable& windows, WindowPlace* places, Stream stream) {
  if (windows.count == 0) return;
  const double count = windows.count;
  start(launchOverList("locateWindows", windows.count, {12 * count, 60 * count}), stream, locate,
        windows, places);
}

void judgeWindows(const JudgedPlanes& planes, const WindowTable& windows, uint16_t* stages,
                  Stream stream) {
  if (windows.count == 0) return;
  // Some 25 features a window, each of eight sums that neighbours share.
  const double count = windows.count;
  start(launchOverList("judgeWindows", windows.count, {60 * count, 1000 * count}), stream, judge,
        planes, windows, stages);
}

}  // namespace rg::gpu::detection
