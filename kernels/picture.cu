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

/// How many rows of the picture each row of the frame serves: 2 of an interlaced one.
struct GreyRows {
  ImageView<const uint8_t> from;
  int rowsEach;
};

__global__ void copyGrey(GreyRows grey, ImageView<uint8_t> to) {
  const Point p = pixelOfThread();
  if (isWithin(p, to.size)) to.at(p.x, p.y) = grey.from.at(p.x, p.y / grey.rowsEach);
}

struct ColourSamples {
  ImageView<const uint8_t> red, green, blue;
  int stepBytes, rowsEach;
};

__global__ void loadColours(ColourSamples from, PicturePlanes to) {
  const Point p = pixelOfThread();
  if (!hasPixel(p, to.luma.size)) return;
  const int y = p.y / from.rowsEach, at = p.x * from.stepBytes;
  const Rgb colour{from.red.row(y)[at], from.green.row(y)[at], from.blue.row(y)[at]};
  store(to, p, colour, lumaOf(colour.red, colour.green, colour.blue));
}

struct YuvSamples {
  ImageView<const uint8_t> luma, cb, cr;
  int lumaStep, chromaStep, chromaRowShift, rowsEach;
  bool hasTenBits;
};

__device__ uint8_t sampleAt(const uint8_t* at, bool hasTenBits) {
  return hasTenBits ? upperOfTen(at[0] | at[1] << 8) : at[0];
}

__global__ void loadYuv(YuvSamples from, YuvToRgb k, PicturePlanes to) {
  const Point p = pixelOfThread();
  if (!hasPixel(p, to.luma.size)) return;
  const int y = p.y / from.rowsEach, chromaY = y >> from.chromaRowShift;
  const int at = p.x / 2 * from.chromaStep;
  const uint8_t luma = sampleAt(from.luma.row(y) + p.x * from.lumaStep, from.hasTenBits);
  const int cb = sampleAt(from.cb.row(chromaY) + at, from.hasTenBits);
  const int cr = sampleAt(from.cr.row(chromaY) + at, from.hasTenBits);
  store(to, p, rgbOf(luma, cb, cr, k), luma);
}

/// A plane that begins with a sample.
ImageView<const uint8_t> beginningAt(ImageView<const uint8_t> plane, int offsetBytes) {
  plane.data += offsetBytes;
  return plane;
}

YuvSamples samplesOf(const Frame& frame, const YuvOrder& order, int rowsEach) {
  const auto plane = [&](const SamplePlace& place) {
    return beginningAt(frame.plane(place.plane), place.offsetBytes);
  };
  return {plane(order.luma),  plane(order.cb),      plane(order.cr), order.luma.stepBytes,
          order.cb.stepBytes, order.chromaRowShift, rowsEach,        order.hasTenBits};
}

ColourSamples coloursOf(const Frame& frame, int rowsEach) {
  if (frame.layout().format == PixelFormat::Gbr)
    return {frame.plane(2), frame.plane(0), frame.plane(1), 1, rowsEach};
  const PackedOrder order = orderOf(frame.layout().format);
  const ImageView<const uint8_t> packed = frame.plane(0);
  return {beginningAt(packed, order.red), beginningAt(packed, order.green),
          beginningAt(packed, order.blue), order.bytesPerPixel, rowsEach};
}

}  // namespace

void loadPlanes(const Frame& given, const PicturePlanes& to, Stream stream) {
  const Frame frame = given.ofOneTime();
  const int rowsEach = given.layout().isInterlaced ? 2 : 1;
  const FrameLayout& layout = frame.layout();
  const Size size = given.size();
  const auto pixels = static_cast<double>(size.area());
  if (layout.format == PixelFormat::Gray8) {
    start(launchOver("copyGrey", size, 1, {2 * pixels, 0}), stream, copyGrey,
          GreyRows{frame.plane(0), rowsEach}, to.luma);
  } else if (const auto order = yuvOrderOf(layout.format)) {
    start(launchOver("loadYuv", size, 1, {5.5 * pixels, 24 * pixels}), stream, loadYuv,
          samplesOf(frame, *order, rowsEach), yuvToRgb(layout.matrix, layout.range), to);
  } else {
    const ColourSamples samples = coloursOf(frame, rowsEach);
    start(launchOver("loadColours", size, 1, {(samples.stepBytes + 4) * pixels, 6 * pixels}),
          stream, loadColours, samples, to);
  }
}

}  // namespace rg::gpu
