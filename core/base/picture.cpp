// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/picture.hpp"

#include "core/base/pixel.hpp"
#include "core/simd/base/picture_rows.hpp"

#include <algorithm>

namespace rg {
namespace {

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

/// From the luma weights of red and blue in units of 1/10000.
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
        simd::loadYuvRow({from, chroma, chroma + 1, 2}, size.width, k, to);
      } else if (layout.format == PixelFormat::I420) {
        simd::loadYuvRow({from, frame.plane(1).row(y / 2), frame.plane(2).row(y / 2), 1},
                         size.width, k, to);
      } else {
        simd::loadPackedRow(from, size.width, orderOf(layout.format), to);
      }
    }
  });
}

}  // namespace rg
