// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/camera/camera_pixels.hpp"
#include "kernels/block_reduce.hpp"
#include "kernels/camera_warp.hpp"
#include "kernels/start.hpp"
#include "kernels/threads.hpp"

namespace rg::gpu {
namespace {

/// Where all moves alike, a place takes no division.
__global__ void warpShifted(ImageView<const uint8_t> previous, Point shift,
                            ImageView<uint8_t> expected, ShownRange* shown) {
  const Point p = pixelOfThread();
  if (!isWithin(p, previous.size)) return;
  constexpr int kUnit = kCameraPlace / kCameraMotion;
  const Point place{p.x * kCameraPlace - shift.x * kUnit, p.y * kCameraPlace - shift.y * kUnit};
  expected.at(p.x, p.y) = warpedLevel(previous, place);
  if (p.x != 0) return;
  const ShownRange rows = shownAfterShift(previous.height(), shift.y);
  const bool isShown = p.y >= rows.first && p.y < rows.last;
  shown[p.y] = isShown ? shownAfterShift(previous.width(), shift.x) : ShownRange{};
}

/// A block of threads for each row. Half of a span's threads know the place of its first column,
/// the others that of the one after its last.
__global__ void warpRows(ImageView<const uint8_t> previous,
                         const __grid_constant__ CameraMotion camera, ImageView<uint8_t> expected,
                         ShownRange* shown) {
  RG_SHARED(int, values, kReduceWarps);
  static_assert(kWarp % kWarpSpan == 0);
  const auto thread = static_cast<int>(threadIdx.x), y = static_cast<int>(blockIdx.x);
  const int lane = thread % kWarp, i = lane % kWarpSpan, begin = lane - i;
  int first = INT32_MAX, last = 0;
  for (int x0 = 0; x0 < previous.width(); x0 += kReduceThreads) {
    const int x = x0 + thread;
    const Point end = camera.before(i < kWarpSpan / 2 ? x - i : x - i + kWarpSpan, y);
    const int behind = begin + kWarpSpan - 1;
    const Point from{__shfl_sync(kFullWarp, end.x, begin), __shfl_sync(kFullWarp, end.y, begin)};
    const Point until{__shfl_sync(kFullWarp, end.x, behind), __shfl_sync(kFullWarp, end.y, behind)};
    if (x >= previous.width()) continue;
    const Point place = placeBetween(from, until, i, kWarpSpan);
    expected.at(x, y) = warpedLevel(previous, place);
    if (!showsPlace(previous.size, place)) continue;
    first = first < x ? first : x;
    last = x + 1;
  }
  first = reduceBlock(first, values, [](int a, int b) { return a < b ? a : b; });
  last = reduceBlock(last, values, [](int a, int b) { return a > b ? a : b; });
  if (thread == 0) shown[y] = last == 0 ? ShownRange{} : ShownRange{first, last};
}

}  // namespace

void warpByCamera(ImageView<const uint8_t> previous, const CameraMotion& camera,
                  ImageView<uint8_t> expected, ShownRange* shown, Stream stream) {
  const Size size = previous.size;
  if (size.isEmpty()) return;
  const auto pixels = static_cast<double>(size.area());
  const double bytes = 2 * pixels + static_cast<double>(sizeof(ShownRange)) * size.height;
  if (camera.isShift()) {
    start(launchOver("warpByShift", size, 1, {bytes, 40 * pixels}), stream, warpShifted, previous,
          camera.at(0, 0), expected, shown);
  } else {
    // Two divisions of 64 bits for a pixel, of 70 instructions each.
    start({"warpByCamera",
           {static_cast<unsigned>(size.height), 1, 1},
           {kReduceThreads, 1, 1},
           {bytes, 200 * pixels}},
          stream, warpRows, previous, camera, expected, shown);
  }
}

}  // namespace rg::gpu
