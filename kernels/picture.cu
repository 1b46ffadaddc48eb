// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/simd/base/conversion.hpp"
#include "kernels/picture.hpp"
#include "kernels/start.hpp"
#include "kernels/threads.hpp"

namespace rg::gpu {
namespace {

/// At an odd width the last column has a chroma sample for itself.
__device__ bool hasPixel(Point p, Size size) {
  const int width = isMutated(Mutant::OddWidth) ? size.width & ~1 : size.width;
  return isWithin(p, {width, size.height});
}

__device__ void store(const PicturePlanes& to, Point p, const Rgb& colour, uint8_t luma) {
  to.red.at(p.x, p.y) = colour.red;
  to.green.at(p.x, p.y) = colour.green;
  to.blue.at(p.x, p.y) = colour.blue;
  to.luma.at(p.x, p.y) = luma;
}

__global__ void copyGrey(ImageView<const uint8_t> from, ImageView<uint8_t> to) {
  const Point p = pixelOfThread();
  if (isWithin(p, to.size)) to.at(p.x, p.y) = from.at(p.x, p.y);
}

__global__ void loadPacked(ImageView<const uint8_t> from, PackedOrder order, PicturePlanes to) {
  const Point p = pixelOfThread();
  if (!hasPixel(p, to.luma.size)) return;
  const uint8_t* pixel = from.row(p.y) + p.x * order.bytesPerPixel;
  const Rgb colour{pixel[order.red], pixel[order.green], pixel[order.blue]};
  store(to, p, colour, lumaOf(colour.red, colour.green, colour.blue));
}

struct YuvPlanes {
  ImageView<const uint8_t> luma, cb, cr;
  int chromaStep;
};

__global__ void loadYuv(YuvPlanes from, YuvToRgb k, PicturePlanes to) {
  const Point p = pixelOfThread();
  if (!hasPixel(p, to.luma.size)) return;
  const int chroma = p.x / 2 * from.chromaStep;
  const uint8_t luma = from.luma.at(p.x, p.y);
  const int cb = from.cb.row(p.y / 2)[chroma], cr = from.cr.row(p.y / 2)[chroma];
  store(to, p, rgbOf(luma, cb, cr, k), luma);
}

YuvPlanes planesOf(const Frame& frame) {
  if (frame.layout().format == PixelFormat::I420)
    return {frame.plane(0), frame.plane(1), frame.plane(2), 1};
  ImageView<const uint8_t> cr = frame.plane(1);
  ++cr.data;
  return {frame.plane(0), frame.plane(1), cr, 2};
}

}  // namespace

void loadPlanes(const Frame& frame, const PicturePlanes& to, Stream stream) {
  const FrameLayout& layout = frame.layout();
  const auto pixels = static_cast<double>(layout.size.area());
  const bool isYuv = layout.format == PixelFormat::Nv12 || layout.format == PixelFormat::I420;
  if (layout.format == PixelFormat::Gray8) {
    start(launchOver("copyGrey", layout.size, 1, {2 * pixels, 0}), stream, copyGrey, frame.plane(0),
          to.luma);
  } else if (isYuv) {
    start(launchOver("loadYuv", layout.size, 1, {5.5 * pixels, 24 * pixels}), stream, loadYuv,
          planesOf(frame), yuvToRgb(layout.matrix, layout.range), to);
  } else {
    const PackedOrder order = orderOf(layout.format);
    start(
        launchOver("loadPacked", layout.size, 1, {(order.bytesPerPixel + 4) * pixels, 6 * pixels}),
        stream, loadPacked, frame.plane(0), order, to);
  }
}

}  // namespace rg::gpu
