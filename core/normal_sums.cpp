// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/normal_sums.hpp"

#include "core/pixel.hpp"

#include <cstdlib>

namespace rg {
namespace {

/// Rounded as the SIMD instruction for it does: the distance of the rows weighs at Q15.
int sample(const uint8_t* upper, const uint8_t* lower, const detail::FinePlace& place) {
  const int top = upper[0] * kFine + (upper[1] - upper[0]) * place.fractionX;
  const int bottom = lower[0] * kFine + (lower[1] - lower[0]) * place.fractionX;
  return top + roundShift((bottom - top) * (place.fractionY << (15 - kFineBits)), 15);
}

}  // namespace

NormalSums sumNormalsPlainly(std::span<const MatchedPart> parts, ImageView<const uint8_t> luma,
                             const PaddedLuma& previous, Point d, int limit) {
  const detail::FinePlace place(d);
  NormalSums sums;
  const auto addPixel = [&](int x, int y) {
    if (x == 0 || x == luma.width() - 1 || y == 0 || y == luma.height() - 1) return;
    const int before = sample(previous.along(x + place.whole.x, y + place.whole.y),
                              previous.along(x + place.whole.x, y + place.whole.y + 1), place);
    const int residual = luma.row(y)[x] * kFine - before;
    if (std::abs(residual) > limit) return;
    const int gx = luma.row(y)[x + 1] - luma.row(y)[x - 1];
    const int gy = luma.row(y + 1)[x] - luma.row(y - 1)[x];
    sums.xx += gx * gx;
    sums.xy += gx * gy;
    sums.yy += gy * gy;
    sums.xr += gx * residual;
    sums.yr += gy * residual;
    ++sums.pixels;
  };
  for (const MatchedPart& part : parts)
    forBlocks(part, [&](int x, int y) {
      for (int i = 0; i < kBlockWidth; ++i) addPixel(x + i, y);
    });
  return sums;
}

}  // namespace rg
