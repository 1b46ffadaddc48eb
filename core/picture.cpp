// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/picture.hpp"

#include "core/pixel.hpp"

#include <algorithm>

namespace rg {
namespace {

/// Where red, green and blue lie within a packed pixel.
struct PackedOrder {
  int red, green, blue, bytesPerPixel;
};

constexpr PackedOrder orderOf(PixelFormat format) {
  switch (format) {
    case PixelFormat::Bgrx:
    case PixelFormat::Bgra:
      return {2, 1, 0, 4};
    case PixelFormat::Rgbx:
    case PixelFormat::Rgba:
      return {0, 1, 2, 4};
    case PixelFormat::Bgr:
      return {2, 1, 0, 3};
    default:
      return {0, 1, 2, 3};
  }
}

constexpr uint8_t lumaOf(int red, int green, int blue) {
  return static_cast<uint8_t>((77 * red + 150 * green + 29 * blue + 128) >> 8);
}
static_assert(lumaOf(255, 255, 255) == 255 && lumaOf(0, 0, 0) == 0 && lumaOf(255, 0, 0) == 77);

struct ColourRows {
  uint8_t *red, *green, *blue, *luma;
};

template <PackedOrder order>
void loadPackedRow(const uint8_t* from, int width, const ColourRows& to) {
  for (int x = 0; x < width; ++x, from += order.bytesPerPixel) {
    const int red = from[order.red], green = from[order.green], blue = from[order.blue];
    to.red[x] = static_cast<uint8_t>(red);
    to.green[x] = static_cast<uint8_t>(green);
    to.blue[x] = static_cast<uint8_t>(blue);
    to.luma[x] = lumaOf(red, green, blue);
  }
}

void loadPackedRow(PixelFormat format, const uint8_t* from, int width, const ColourRows& to) {
  switch (format) {
    case PixelFormat::Bgrx:
    case PixelFormat::Bgra:
      return loadPackedRow<orderOf(PixelFormat::Bgrx)>(from, width, to);
    case PixelFormat::Rgbx:
    case PixelFormat::Rgba:
      return loadPackedRow<orderOf(PixelFormat::Rgbx)>(from, width, to);
    case PixelFormat::Bgr:
      return loadPackedRow<orderOf(PixelFormat::Bgr)>(from, width, to);
    default:
      return loadPackedRow<orderOf(PixelFormat::Rgb)>(from, width, to);
  }
}

/// Inverse of Y'CbCr in Q14, from the luma weights of red and blue in units of 1/10000.
struct YuvToRgb {
  int offset;  ///< Luma of black.
  int luma;    ///< Gain of luma.
  int redByCr, greenByCb, greenByCr, blueByCb;
};

constexpr YuvToRgb yuvToRgb(YuvMatrix matrix, YuvRange range) {
  constexpr int kWeights[][2] = {{2990, 1140}, {2126, 722}, {2627, 593}, {2120, 870}, {3000, 1100}};
  const int64_t kr = kWeights[static_cast<int>(matrix)][0];
  const int64_t kb = kWeights[static_cast<int>(matrix)][1];
  const int64_t kg = 10000 - kr - kb;
  const bool isFull = range == YuvRange::Full;
  const int64_t lumaSpan = isFull ? 255 : 219;
  const int64_t chromaSpan = isFull ? 255 : 224;
  const auto q14 = [](int64_t numerator, int64_t denominator) {
    return static_cast<int>(divideRounded(numerator << 14, denominator));
  };
  return {isFull ? 0 : 16,
          q14(255, lumaSpan),
          q14(2 * (10000 - kr) * 255, 10000 * chromaSpan),
          q14(2 * (10000 - kb) * kb * 255, 10000 * kg * chromaSpan),
          q14(2 * (10000 - kr) * kr * 255, 10000 * kg * chromaSpan),
          q14(2 * (10000 - kb) * 255, 10000 * chromaSpan)};
}
static_assert(yuvToRgb(YuvMatrix::Bt601, YuvRange::Limited).redByCr == 26149);

uint8_t fromQ14(int value) {
  return static_cast<uint8_t>(std::clamp(roundShift(value, 14), 0, 255));
}

struct YuvRows {
  const uint8_t *luma, *cb, *cr;
  int chromaStep;  ///< 1 for planes of their own, 2 where Cb and Cr take turns.
};

void loadYuvRow(const YuvRows& from, int width, const YuvToRgb& k, const ColourRows& to) {
  for (int x = 0; x < width; ++x) {
    const int y = (from.luma[x] - k.offset) * k.luma;
    const int u = from.cb[(x >> 1) * from.chromaStep] - 128;
    const int v = from.cr[(x >> 1) * from.chromaStep] - 128;
    to.red[x] = fromQ14(y + v * k.redByCr);
    to.green[x] = fromQ14(y - u * k.greenByCb - v * k.greenByCr);
    to.blue[x] = fromQ14(y + u * k.blueByCb);
    to.luma[x] = from.luma[x];
  }
}

}  // namespace

void Picture::load(const Frame& frame, const Executor& executor) {
  const FrameLayout& layout = frame.layout();
  const Size size = layout.size;
  isGrey_ = layout.format == PixelFormat::Gray8;
  luma_.resize(size);
  if (!isGrey_)
    for (Image<uint8_t>* plane : {&red_, &green_, &blue_}) plane->resize(size);
  const YuvToRgb k = yuvToRgb(layout.matrix, layout.range);

  executor.forRows(size.height, [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      const uint8_t* from = frame.plane(0).row(y);
      if (isGrey_) {
        std::copy_n(from, size.width, luma_.row(y));
        continue;
      }
      const ColourRows to{red_.row(y), green_.row(y), blue_.row(y), luma_.row(y)};
      if (layout.format == PixelFormat::Nv12) {
        const uint8_t* chroma = frame.plane(1).row(y / 2);
        loadYuvRow({from, chroma, chroma + 1, 2}, size.width, k, to);
      } else if (layout.format == PixelFormat::I420) {
        loadYuvRow({from, frame.plane(1).row(y / 2), frame.plane(2).row(y / 2), 1}, size.width, k,
                   to);
      } else {
        loadPackedRow(layout.format, from, size.width, to);
      }
    }
  });
}

}  // namespace rg
