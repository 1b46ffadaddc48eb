// SPDX-License-Identifier: LGPL-2.1-or-later
#include "kernels/block_reduce.hpp"
#include "kernels/fit_moments.hpp"
#include "kernels/matched_blocks.hpp"
#include "kernels/start.hpp"

namespace rg::gpu::motion {
namespace {

using rg::motion::FitMoments;
using rg::motion::FitSums;
using rg::motion::kBlockWidth;
using rg::motion::kCellSize;
using rg::motion::kMoments;
using rg::motion::MatchedCell;
using rg::motion::MatchedPart;

constexpr int kBlocksInCell = 2 * kCellSize, kCellsInPart = rg::motion::kPartHeight / kCellSize;
/// Of a block of a cell a lane has half.
constexpr int kLanesOfBlock = kWarp / kBlocksInCell;
constexpr int kPixelsOfLane = kBlockWidth / kLanesOfBlock;
/// Moments that a lane sums up: that of its number, and that of 32 more.
static_assert(kMoments > kWarp && kMoments <= 2 * kWarp);
static_assert(sizeof(FitMoments) == kMoments * sizeof(int64_t));

struct SeenPlanes {
  ImageView<const uint8_t> luma;
  PaddedView previous;
};

/// The sums of a lane's pixels of a cell that is displaced by d.
__device__ FitSums sumOwnPixels(const SeenPlanes& planes, const MatchedCell& cell, Point d,
                                int limit) {
  FitSums sums;
  const auto lane = static_cast<int>(threadIdx.x % kWarp);
  const int block = lane / kLanesOfBlock, y = cell.y + block / 2;
  const ImageView<const uint8_t>& luma = planes.luma;
  if ((cell.blocks >> block & 1) == 0 || y == 0 || y == luma.height() - 1) return sums;
  const rg::motion::FitSampler sampler(d);
  const uint8_t *row = luma.row(y), *above = luma.row(y - 1), *below = luma.row(y + 1);
  const int reach = planes.previous.reach, upperRow = y + sampler.whole.y + reach;
  const uint8_t* upper = planes.previous.rows.row(upperRow);
  const uint8_t* lower = planes.previous.rows.row(upperRow + 1);
  const int first = cell.x + block % 2 * kBlockWidth + lane % kLanesOfBlock * kPixelsOfLane;
  for (int x = first; x < first + kPixelsOfLane; ++x) {
    if (x == 0 || x >= luma.width() - 1) continue;
    const int from = x + sampler.whole.x + reach;
    rg::motion::addFitPixel(
        row[x + 1] - row[x - 1], below[x] - above[x],
        row[x] * rg::motion::kFine - sampler.between(upper + from, lower + from), limit, sums);
  }
  return sums;
}

/// Of all lanes, in all of them.
__device__ void sumOfWarp(FitSums& sums) {
  const auto join = [](int32_t& value) {
    for (int i = kWarp / 2; i > 0; i /= 2) value += __shfl_xor_sync(kFullWarp, value, i);
  };
  join(sums.seen);
  join(sums.misfit);
  join(sums.pixels);
  join(sums.x);
  join(sums.y);
  join(sums.r);
  join(sums.xx);
  join(sums.xy);
  join(sums.yy);
  join(sums.xr);
  join(sums.yr);
  join(sums.rr);
}

/// A block of threads has a region, a warp every eighth cell of it, a lane two of the moments: a
/// thread that had all of them would leave room for few others.
__global__ void sumOverCells(const __grid_constant__ MatchedRegions regions,
                             const FittedRegion* fitted, const __grid_constant__ SeenPlanes planes,
                             FitMoments* moments) {
  RG_SHARED(int64_t, values, kReduceWarps * kMoments);
  const FittedRegion& region = fitted[blockIdx.x];
  const auto lane = static_cast<int>(threadIdx.x % kWarp),
             warp = static_cast<int>(threadIdx.x / kWarp);
  const uint32_t first = regions.starts[blockIdx.x];
  const auto count =
      static_cast<int>((regions.starts[blockIdx.x + 1] - first) * uint32_t{kCellsInPart});
  int64_t own = 0, second = 0;
  for (int i = warp; i < count; i += kReduceWarps) {
    const MatchedPart& part = regions.parts[first + static_cast<uint32_t>(i / kCellsInPart)];
    const int row = i % kCellsInPart;
    const MatchedCell cell{part.x(), part.y() + row * kCellSize,
                           static_cast<uint16_t>(part.blocks >> (row * kBlocksInCell))};
    const Point offset = rg::motion::offsetOf(cell, region.field.centroid);
    const Point d = rg::motion::displacementAt(region.field, offset, planes.previous.reach);
    // The whole warp.
    if (cell.blocks == 0 || !rg::motion::isVisible(cell, d, planes.luma.size)) continue;
    FitSums sums = sumOwnPixels(planes, cell, d, region.limit);
    sumOfWarp(sums);
    own += rg::motion::momentOf(sums, offset, lane);
    if (lane + kWarp < kMoments) second += rg::motion::momentOf(sums, offset, lane + kWarp);
  }
  values[warp * kMoments + lane] = own;
  if (lane + kWarp < kMoments) values[warp * kMoments + lane + kWarp] = second;
  __syncthreads();
  const auto moment = static_cast<int>(threadIdx.x);
  if (moment >= kMoments) return;
  int64_t sum = 0;
  for (int i = 0; i < kReduceWarps; ++i) sum += values[i * kMoments + moment];
  reinterpret_cast<int64_t*>(moments + blockIdx.x)[moment] = sum;
}

}  // namespace

void sumMoments(const MatchedRegions& regions, const FittedRegion* fitted,
                ImageView<const uint8_t> luma, const PaddedView& previous, FitMoments* moments,
                Stream stream) {
  if (regions.count == 0) return;
  start(overRegions("sumMoments", regions.count, 2, 60), stream, sumOverCells, regions, fitted,
        SeenPlanes{luma, previous}, moments);
}

}  // namespace rg::gpu::motion
