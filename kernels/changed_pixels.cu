// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/pixel.hpp"
#include "kernels/changed_pixels.hpp"
#include "kernels/start.hpp"
#include "kernels/threads.hpp"

namespace rg::gpu::background {
namespace {

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

__global__ void mark(const __grid_constant__ Planes a, const __grid_constant__ Planes b,
                     int threshold, ImageView<uint8_t> out) {
  const Point p = pixelOfThread();
  if (isWithin(p, out.size)) out.at(p.x, p.y) = distanceAt(a, b, p) > threshold ? 255 : 0;
}

__global__ void add(const __grid_constant__ Planes a, const __grid_constant__ Planes b,
                    int threshold, ImageView<const uint8_t> isKnown, ImageView<uint8_t> out) {
  const Point p = pixelOfThread();
  if (isWithin(p, out.size) && isKnown.at(p.x, p.y) == 255 && distanceAt(a, b, p) > threshold)
    out.at(p.x, p.y) = 255;
}

__global__ void thinOut(ImageView<const uint8_t> marked, ImageView<uint8_t> out) {
  const Point p = pixelOfThread();
  if (!isWithin(p, out.size)) return;
  int set = 0;
  for (int y = std::max(0, p.y - 1); y <= std::min(out.height() - 1, p.y + 1); ++y)
    for (int x = std::max(0, p.x - 1); x <= std::min(out.width() - 1, p.x + 1); ++x)
      set += marked.at(x, y) & 1;
  out.at(p.x, p.y) = set >= 4 ? 255 : 0;
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

void markChange(const Planes& a, const Planes& b, int threshold, ImageView<uint8_t> out,
                Stream stream) {
  start(over("markChange", a, 1), stream, mark, a, b, threshold, out);
}

void addStrange(const Planes& a, const Planes& b, int threshold, ImageView<const uint8_t> isKnown,
                ImageView<uint8_t> out, Stream stream) {
  start(over("addStrange", a, 2), stream, add, a, b, threshold, isKnown, out);
}

void keepDense(ImageView<const uint8_t> marked, ImageView<uint8_t> out, Stream stream) {
  const auto pixels = static_cast<double>(out.size.area());
  start(launchOver("keepDense", out.size, 1, {2 * pixels, 10 * pixels}), stream, thinOut, marked,
        out);
}

}  // namespace rg::gpu::background
