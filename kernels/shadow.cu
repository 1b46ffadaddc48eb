// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/shadows/shadow_window.hpp"
#include "kernels/shadow.hpp"
#include "kernels/start.hpp"
#include "kernels/threads.hpp"

namespace rg::gpu::background {
namespace {

using rg::background::ColourPlanes;
using rg::background::kShadowRadius;
using rg::background::WindowSums;

/// A window that the picture's border cuts off counts fewer pixels.
__device__ WindowSums sumsAround(ImageView<const uint8_t> picture,
                                 ImageView<const uint8_t> background, Point p) {
  const int left = std::max(0, p.x - kShadowRadius), top = std::max(0, p.y - kShadowRadius);
  const int right = std::min(picture.width(), p.x + kShadowRadius + 1);
  const int bottom = std::min(picture.height(), p.y + kShadowRadius + 1);
  int sumI = 0, sumB = 0, ii = 0, ib = 0, bb = 0;  // 25 · 255² < 2²¹.
  for (int y = top; y < bottom; ++y)
    for (int x = left; x < right; ++x) {
      const int i = picture.at(x, y), b = background.at(x, y);
      sumI += i;
      sumB += b;
      ii += i * i;
      ib += i * b;
      bb += b * b;
    }
  return {int64_t{right - left} * (bottom - top), sumI, sumB, ii, ib, bb};
}

/// Green stands for brightness, as in core.
__device__ bool isShadow(const ColourPlanes& picture, const ColourPlanes& background, Point p) {
  const WindowSums sums = sumsAround(picture.green, background.green, p);
  const auto isNear = [&](ImageView<const uint8_t> now, ImageView<const uint8_t> before) {
    return rg::background::keepsColour(now.at(p.x, p.y), before.at(p.x, p.y), sums);
  };
  return rg::background::isInRange(sums) && isNear(picture.red, background.red) &&
         isNear(picture.green, background.green) && isNear(picture.blue, background.blue) &&
         rg::background::isDarkened(sums);
}

__global__ void findInWords(const __grid_constant__ ColourPlanes picture,
                            const __grid_constant__ ColourPlanes background, BitView mask,
                            BitTarget shadow) {
  const Point at = wordOfWarp();
  if (at.y >= mask.size.height) return;  // The whole warp.
  const uint64_t columns = mask.words.at(at.x, at.y);
  const int lane = static_cast<int>(threadIdx.x);
  const auto isFound = [&](int column) {
    return (columns >> column & 1) != 0 &&
           isShadow(picture, background, {at.x * kWordColumns + column, at.y});
  };
  const uint64_t word = columns == 0 ? 0 : packWord(isFound(lane), isFound(lane + kWarp));
  if (lane == 0) shadow.words.at(at.x, at.y) = word;
}

}  // namespace

void findShadows(const ColourPlanes& picture, const ColourPlanes& background, const BitView& mask,
                 const BitTarget& shadow, Stream stream) {
  // A twentieth of the pixels is foreground in usual scenes.
  const auto pixels = static_cast<double>(mask.size.area());
  start(
      launchOverWords("findShadows", mask.size, {pixels * (0.25 + 6 * 0.05), pixels * 150 * 0.05}),
      stream, findInWords, picture, background, mask, shadow);
}

}  // namespace rg::gpu::background
