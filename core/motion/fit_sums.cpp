// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/motion/fit_sums.hpp"

#include "core/motion/fit_moments.hpp"

#include <algorithm>
#include <bit>

namespace rg::motion {
namespace {

/// In 1/256 grey levels.
int levelAt(const PaddedLuma& previous, const FitSampler& sampler, int x, int y) {
  const int left = x + sampler.whole.x, upper = y + sampler.whole.y;
  return sampler.between(previous.along(left, upper), previous.along(left, upper + 1));
}

}  // namespace

FitSums sumFitPlainly(const MatchedCell& cell, ImageView<const uint8_t> luma,
                      const PaddedLuma& previous, Point d, int limit) {
  FitSums sums;
  const FitSampler sampler(d);
  for (unsigned left = cell.blocks; left != 0; left &= left - 1) {
    const int bit = std::countr_zero(left);
    const int y = cell.y + bit / 2, x0 = cell.x + bit % 2 * kBlockWidth;
    if (y == 0 || y == luma.height() - 1) continue;
    const uint8_t *row = luma.row(y), *above = luma.row(y - 1), *below = luma.row(y + 1);
    const int xEnd = std::min(x0 + kBlockWidth, luma.width() - 1);
    for (int x = std::max(x0, 1); x < xEnd; ++x)
      addFitPixel(row[x + 1] - row[x - 1], below[x] - above[x],
                  row[x] * kFine - levelAt(previous, sampler, x, y), limit, sums);
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
