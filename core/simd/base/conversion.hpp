// SPDX-License-Identifier: LGPL-2.1-or-later
// From stored samples to red, green, blue and luma of 8 bits: the arithmetic that every backend
// shares.
#pragma once

#include "core/base/frame.hpp"
#include "core/base/pixel.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>

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

/// Where the samples of a kind lie: in which plane, the first one's byte in a row, and how many
/// bytes from one to the next.
struct SamplePlace {
  int plane, offsetBytes, stepBytes;
};

/// Where a Y'CbCr format has its samples. Chroma has half the columns, rounded up.
struct YuvOrder {
  SamplePlace luma, cb, cr;
  int chromaRowShift = 0;   ///< A row of chroma serves so many rows, as a power of 2.
  bool hasTenBits = false;  ///< A sample is a word's lower ten bits, of which the upper 8 count.

  [[nodiscard]] constexpr bool isPlanar() const { return cb.plane != cr.plane; }
};

[[nodiscard]] constexpr std::optional<YuvOrder> yuvOrderOf(PixelFormat format) {
  switch (format) {
    case PixelFormat::Nv12:
      return YuvOrder{{0, 0, 1}, {1, 0, 2}, {1, 1, 2}, 1};
    case PixelFormat::Nv21:
      return YuvOrder{{0, 0, 1}, {1, 1, 2}, {1, 0, 2}, 1};
    case PixelFormat::I420:
      return YuvOrder{{0, 0, 1}, {1, 0, 1}, {2, 0, 1}, 1};
    case PixelFormat::Y42b:
      return YuvOrder{{0, 0, 1}, {1, 0, 1}, {2, 0, 1}};
    case PixelFormat::Yuy2:
      return YuvOrder{{0, 0, 2}, {0, 1, 4}, {0, 3, 4}};
    case PixelFormat::Uyvy:
      return YuvOrder{{0, 1, 2}, {0, 0, 4}, {0, 2, 4}};
    case PixelFormat::I420Ten:
      return YuvOrder{{0, 0, 2}, {1, 0, 2}, {2, 0, 2}, 1, true};
    case PixelFormat::P010:  // The upper byte of a word is all that counts.
      return YuvOrder{{0, 1, 2}, {1, 1, 4}, {1, 3, 4}, 1};
    default:
      return std::nullopt;
  }
}

/// The upper 8 bits of a word's lower ten.
[[nodiscard]] constexpr uint8_t upperOfTen(int word) {
  return static_cast<uint8_t>(word >> 2);
}
static_assert(upperOfTen(1023) == 255 && upperOfTen(3) == 0 && upperOfTen(0xFC00) == 0);

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
