// SPDX-License-Identifier: LGPL-2.1-or-later
#include "kernels/fit_moments.hpp"
#include "kernels/matched_blocks.hpp"
#include "kernels/start.hpp"

namespace rg::gpu::motion {
namespace {

using rg::motion::FitMoments;
using rg::motion::FitSums;
using rg::motion::kBlockWidth;
using rg::motion::kCellSize;
using rg::motion::MatchedCell;
using rg::motion::MatchedPart;

/// The sums of one block of a cell that is displaced by d.
__device__ FitSums sumBlock(ImageView<const uint8_t> luma, const PaddedView& previous, Point block,
                            Point d, int limit) {
  FitSums sums;
  const int y = block.y;
  if (y == 0 || y == luma.height() - 1) return sums;
  const rg::motion::FitSampler sampler(d);
  const uint8_t *row = luma.row(y), *above = luma.row(y - 1), *below = luma.row(y + 1);
  const int upperRow = y + sampler.whole.y + previous.reach;
  const uint8_t *upper = previous.rows.row(upperRow), *lower = previous.rows.row(upperRow + 1);
  for (int i = 0; i < kBlockWidth; ++i) {
    const int x = block.x + i, from = x + sampler.whole.x + previous.reach;
    if (x == 0 || x >= luma.width() - 1) continue;
    rg::motion::addFitPixel(
        row[x + 1] - row[x - 1], below[x] - above[x],
        row[x] * rg::motion::kFine - sampler.between(upper + from, lower + from), limit, sums);
  }
  return sums;
}

__global__ void sumOverBlocks(const __grid_constant__ MatchedRegions regions,
                              const FittedRegion* fitted, ImageView<const uint8_t> luma,
                              const __grid_constant__ PaddedView previous, FitMoments* moments) {
  RG_SHARED(int64_t, values, kReduceWarps);
  const FittedRegion& region = fitted[blockIdx.x];
  FitMoments own;
  forOwnBits(regions, [&](const MatchedPart& part, int bit) {
    const int row = bit / 2;
    const MatchedCell cell{part.x(), part.y() + row / kCellSize * kCellSize, 0};
    const Point offset = rg::motion::offsetOf(cell, region.field.centroid);
    const Point d = rg::motion::displacementAt(region.field, offset, previous.reach);
    if (!rg::motion::isVisible(cell, d, luma.size)) return;
    const Point block{part.x() + bit % 2 * kBlockWidth, part.y() + row};
    rg::motion::addCell(sumBlock(luma, previous, block, d, region.limit), offset, own);
  });
  const auto join = [&](int64_t& value) { value = reduceBlock(value, values, Total{}); };
  rg::motion::forSums(own, join);
  if (threadIdx.x == 0) moments[blockIdx.x] = own;
}

}  // namespace

void sumMoments(const MatchedRegions& regions, const FittedRegion* fitted,
                ImageView<const uint8_t> luma, const PaddedView& previous, FitMoments* moments,
                Stream stream) {
  if (regions.count == 0) return;
  start(overRegions("sumMoments", regions.count, 2, 100), stream, sumOverBlocks, regions, fitted,
        luma, previous, moments);
}

}  // namespace rg::gpu::motion
