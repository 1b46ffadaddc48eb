// SPDX-License-Identifier: LGPL-2.1-or-later
#include "kernels/paper_masks.hpp"
#include "kernels/start.hpp"
#include "kernels/threads.hpp"

namespace rg::gpu::background {
namespace {

__global__ void keepPixelsAbove(const int* threshold, ImageView<uint8_t> plane) {
  const Point p = pixelOfThread();
  if (!isWithin(p, plane.size)) return;
  uint8_t& level = plane.at(p.x, p.y);
  level = level > *threshold ? 255 : 0;
}

__global__ void keepPixelsOfBoth(ImageView<const uint8_t> a, ImageView<const uint8_t> b,
                                 ImageView<uint8_t> out) {
  const Point p = pixelOfThread();
  if (isWithin(p, out.size)) out.at(p.x, p.y) = a.at(p.x, p.y) & b.at(p.x, p.y);
}

__global__ void joinPixels(const __grid_constant__ PaperTests tests,
                           ImageView<const uint8_t> filled, ImageView<uint8_t> out) {
  const Point p = pixelOfThread();
  if (!isWithin(p, out.size)) return;
  const int either = tests.simple.at(p.x, p.y) | tests.gaussian.at(p.x, p.y);
  out.at(p.x, p.y) =
      static_cast<uint8_t>(tests.common.at(p.x, p.y) | (filled.at(p.x, p.y) & either));
}

/// How far edges reach from a box's ends: the first of a column counted from the bottom, the last
/// one from the top, of a row from the right and from the left; 0 where there is none.
struct Reaches {
  uint32_t *columns, *rows;
};
__device__ Reaches reachesOf(const LineBoxes& boxes, const LineBox& line) {
  uint32_t* const columns = boxes.reaches + line.reaches;
  return {columns, columns + 2 * static_cast<ptrdiff_t>(line.box.width)};
}

/// Calls visit(left, y) for 32 columns of a row of the block's strip at a time; a warp has a row.
template <class Visit>
__device__ void forStrip(const LineBoxes& boxes, const Visit& visit) {
  const LineStrip& strip = boxes.strips[blockIdx.x];
  const Box& box = boxes.boxes[strip.box].box;
  const int end = std::min(strip.top + kStripRows, box.bottom());
  for (int y = strip.top + static_cast<int>(threadIdx.y); y < end; y += static_cast<int>(kTile.y))
    for (int left = box.x; left < box.right(); left += kWarp) visit(left, y);
}

__global__ void findReaches(ImageView<const uint8_t> edges,
                            const __grid_constant__ LineBoxes boxes) {
  const LineBox& line = boxes.boxes[boxes.strips[blockIdx.x].box];
  const Box& box = line.box;
  const Reaches reaches = reachesOf(boxes, line);
  const int lane = static_cast<int>(threadIdx.x);
  const auto raise = [](uint32_t* places, int i, int first, int last) {
    atomicMax(places + 2 * static_cast<ptrdiff_t>(i), static_cast<uint32_t>(first));
    atomicMax(places + 2 * static_cast<ptrdiff_t>(i) + 1, static_cast<uint32_t>(last));
  };
  forStrip(boxes, [&](int left, int y) {
    const int x = left + lane;
    const bool isEdge = x < box.right() && edges.at(x, y) != 0;
    const unsigned found = __ballot_sync(kFullWarp, isEdge);
    if (isEdge) raise(reaches.columns, x - box.x, box.bottom() - y, y - box.y + 1);
    if (lane != 0 || found == 0) return;
    const int first = left + __ffsll(found) - 1, last = left + kWarp - 1 - __clz(found);
    raise(reaches.rows, y - box.y, box.right() - first, last - box.x + 1);
  });
}

__global__ void fillBetween(const __grid_constant__ LineBoxes boxes, ImageView<uint8_t> out) {
  const LineBox& line = boxes.boxes[boxes.strips[blockIdx.x].box];
  const Box& box = line.box;
  const Reaches reaches = reachesOf(boxes, line);
  const auto isBetween = [](const uint32_t* places, int i, int toEnd, int fromBegin) {
    const uint32_t* two = places + 2 * static_cast<ptrdiff_t>(i);
    return two[0] >= static_cast<uint32_t>(toEnd) && two[1] >= static_cast<uint32_t>(fromBegin);
  };
  forStrip(boxes, [&](int left, int y) {
    const int x = left + static_cast<int>(threadIdx.x);
    if (x < box.right() && isBetween(reaches.columns, x - box.x, box.bottom() - y, y - box.y + 1) &&
        isBetween(reaches.rows, y - box.y, box.right() - x, x - box.x + 1))
      out.at(x, y) = 255;
  });
}

Launch over(const char* name, Size size, double bytes) {
  const auto pixels = static_cast<double>(size.area());
  return launchOver(name, size, 1, {bytes * pixels, 3 * pixels});
}

}  // namespace

void keepAbove(const int* threshold, ImageView<uint8_t> plane, Stream stream) {
  start(over("keepAbove", plane.size, 2), stream, keepPixelsAbove, threshold, plane);
}

void keepBoth(ImageView<const uint8_t> a, ImageView<const uint8_t> b, ImageView<uint8_t> out,
              Stream stream) {
  start(over("keepBoth", out.size, 3), stream, keepPixelsOfBoth, a, b, out);
}

void joinFound(const PaperTests& tests, ImageView<const uint8_t> filled, ImageView<uint8_t> out,
               Stream stream) {
  start(over("joinFound", out.size, 5), stream, joinPixels, tests, filled, out);
}

void LineList::clear() {
  boxes.clear();
  strips.clear();
  reaches = 0;
}

void LineList::add(const Box& box) {
  const auto number = static_cast<uint32_t>(boxes.size());
  boxes.push_back({box, reaches});
  for (int y = box.y; y < box.bottom(); y += kStripRows) strips.push_back({number, y});
  reaches += 2 * static_cast<uint32_t>(box.width + box.height);
}

void fillLines(ImageView<const uint8_t> edges, const LineBoxes& boxes, ImageView<uint8_t> out,
               Stream stream) {
  if (boxes.stripCount == 0) return;
  const Extent grid{static_cast<unsigned>(boxes.stripCount), 1, 1};
  const double pixels = boxes.pixels;
  clear(boxes.reaches, boxes.reachCount * sizeof *boxes.reaches, stream);
  start({"findReaches", grid, kTile, {pixels, 6 * pixels}}, stream, findReaches, edges, boxes);
  start({"fillLines", grid, kTile, {pixels, 10 * pixels}}, stream, fillBetween, boxes, out);
}

}  // namespace rg::gpu::background
