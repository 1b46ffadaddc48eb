// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/motion/fit_sums.hpp"

#include "core/motion/fit_moments.hpp"

#include <algorithm>
#include <bit>
#include <cstdlib>

namespace rg::motion {
namespace {

struct Sampler {
  Point whole;        ///< Where pixel (0, 0) is looked at in the previous picture.
  int fractionX = 0;  ///< 1/256 px beyond it.
  int fractionY = 0;

  explicit Sampler(Point d)
      : whole{(-d.x) >> kFineBits, (-d.y) >> kFineBits},
        fractionX((-d.x) & (kFine - 1)),
        fractionY((-d.y) & (kFine - 1)) {}

  /// In 1/256 grey levels.
  [[nodiscard]] int at(const PaddedLuma& previous, int x, int y) const {
    const uint8_t* upper = previous.along(x + whole.x, y + whole.y);
    const uint8_t* lower = previous.along(x + whole.x, y + whole.y + 1);
    const int top = upper[0] * (kFine - fractionX) + upper[1] * fractionX;
    const int bottom = lower[0] * (kFine - fractionX) + lower[1] * fractionX;
    return (top * (kFine - fractionY) + bottom * fractionY) >> kFineBits;
  }
};

void addPixel(int gx, int gy, int residual, int limit, FitSums& sums) {
  ++sums.seen;
  sums.misfit += std::min(std::abs(residual), limit);
  if (std::abs(residual) > limit) return;
  const int coarse = residual >> 4;
  ++sums.pixels;
  sums.x += gx;
  sums.y += gy;
  sums.r += residual;
  sums.xx += gx * gx;
  sums.xy += gx * gy;
  sums.yy += gy * gy;
  sums.xr += gx * residual;
  sums.yr += gy * residual;
  sums.rr += coarse * coarse;
}

}  // namespace

FitSums sumFitPlainly(const MatchedCell& cell, ImageView<const uint8_t> luma,
                      const PaddedLuma& previous, Point d, int limit) {
  FitSums sums;
  const Sampler sampler(d);
  for (unsigned left = cell.blocks; left != 0; left &= left - 1) {
    const int bit = std::countr_zero(left);
    const int y = cell.y + bit / 2, x0 = cell.x + bit % 2 * kBlockWidth;
    if (y == 0 || y == luma.height() - 1) continue;
    const uint8_t *row = luma.row(y), *above = luma.row(y - 1), *below = luma.row(y + 1);
    const int xEnd = std::min(x0 + kBlockWidth, luma.width() - 1);
    for (int x = std::max(x0, 1); x < xEnd; ++x)
      addPixel(row[x + 1] - row[x - 1], below[x] - above[x],
               row[x] * kFine - sampler.at(previous, x, y), limit, sums);
  }
  return sums;
}

FitMoments sumMomentsPlainly(std::span<const MatchedPart> parts, const FitPlane& plane,
                             const FitField& field, int limit) {
  FitMoments moments;
  for (const MatchedPart& part : parts)
    forCells(part, [&](const MatchedCell& cell) {
      const Point offset = offsetOf(cell, field.centroid);
      const Point d = displacementAt(field, offset, plane.previous->reach());
      if (!isVisible(cell, d, plane.current.size)) return;
      addCell(sumFitPlainly(cell, plane.current, *plane.previous, d, limit), offset, moments);
    });
  return moments;
}

GradientProducts sumGradientsPlainly(std::span<const MatchedPart> parts,
                                     ImageView<const uint8_t> luma) {
  GradientProducts sums;
  for (const MatchedPart& part : parts)
    forBlocks(part, [&](int x0, int y) {
      if (y == 0 || y == luma.height() - 1) return;
      for (int x = std::max(x0, 1); x < std::min(x0 + kBlockWidth, luma.width() - 1); ++x) {
        const int gx = luma.row(y)[x + 1] - luma.row(y)[x - 1];
        const int gy = luma.row(y + 1)[x] - luma.row(y - 1)[x];
        sums.xx += gx * gx;
        sums.xy += gx * gy;
        sums.yy += gy * gy;
      }
    });
  return sums;
}

}  // namespace rg::motion
