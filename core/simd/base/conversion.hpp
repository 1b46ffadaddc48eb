// SPDX-License-Identifier: LGPL-2.1-or-later
// From stored samples to red, green, blue and luma of 8 bits: the arithmetic that every backend
// shares.
#pragma once

#include "core/base/frame.hpp"
#include "core/base/pixel.hpp"

#include <algorithm>
#include <cstdint>

namespace rg {

/// Where red, green and blue lie within a packed pixel.
struct PackedOrder {
  int red, green, blue;
  int bytesPerPixel;  ///< 3 or 4.
};

[[nodiscard]] constexpr PackedOrder orderOf(PixelFormat format) {
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

[[nodiscard]] constexpr uint8_t lumaOf(int red, int green, int blue) {
  return static_cast<uint8_t>((77 * red + 150 * green + 29 * blue + 128) >> 8);
}
static_assert(lumaOf(255, 255, 255) == 255 && lumaOf(0, 0, 0) == 0 && lumaOf(255, 0, 0) == 77);

/// Inverse of Y'CbCr in Q14. Below 2^16 each, so that sums of three products fit 32 bits.
struct YuvToRgb {
  int offset;  ///< Luma of black.
  int luma;    ///< Gain of luma.
  int redByCr, greenByCb, greenByCr, blueByCb;
};

/// From the luma weights of red and blue in units of 1/10000.
[[nodiscard]] constexpr YuvToRgb yuvToRgb(YuvMatrix matrix, YuvRange range) {
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

struct Rgb {
  uint8_t red, green, blue;
};

/// luma, cb, cr: as they are stored.
[[nodiscard]] constexpr Rgb rgbOf(int luma, int cb, int cr, const YuvToRgb& k) {
  const auto fromQ14 = [](int value) {
    return static_cast<uint8_t>(std::clamp(roundShift(value, 14), 0, 255));
  };
  const int y = (luma - k.offset) * k.luma, u = cb - 128, v = cr - 128;
  return {fromQ14(y + v * k.redByCr), fromQ14(y - u * k.greenByCb - v * k.greenByCr),
          fromQ14(y + u * k.blueByCb)};
}

}  // namespace rg
