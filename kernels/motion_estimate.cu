// SPDX-License-Identifier: LGPL-2.1-or-later
#include "kernels/matched_blocks.hpp"
#include "kernels/motion_estimate.hpp"
#include "kernels/start.hpp"
#include "kernels/threads.hpp"

namespace rg::gpu::motion {
namespace {

using rg::motion::GradientProducts;
using rg::motion::kBlockWidth;
using rg::motion::RegionMotion;

__global__ void compareRegions(const __grid_constant__ MatchedRegions regions,
                               ImageView<const uint8_t> luma, ImageView<const uint8_t> previous,
                               uint8_t* still) {
  RG_SHARED(uint32_t, values, kReduceWarps);
  uint32_t changed = 0;
  forOwnBlocks(regions, [&](int x, int y) {
    changed += loadQuad(luma.row(y) + x) != loadQuad(previous.row(y) + x);
  });
  changed = reduceBlock(changed, values, Total{});
  const bool isEmpty = regions.starts[blockIdx.x] == regions.starts[blockIdx.x + 1];
  if (threadIdx.x == 0) still[blockIdx.x] = changed == 0 && !isEmpty ? 1 : 0;
}

/// Of pixels at the frame's edge nothing is known.
__global__ void sumProducts(const __grid_constant__ MatchedRegions regions,
                            ImageView<const uint8_t> luma, GradientProducts* sums) {
  RG_SHARED(int32_t, values, kReduceWarps);
  GradientProducts own;
  forOwnBlocks(regions, [&](int left, int y) {
    if (y == 0 || y == luma.height() - 1) return;
    for (int x = std::max(left, 1); x < std::min(left + kBlockWidth, luma.width() - 1); ++x) {
      const int gx = luma.at(x + 1, y) - luma.at(x - 1, y);
      const int gy = luma.at(x, y + 1) - luma.at(x, y - 1);
      own.xx += gx * gx;
      own.xy += gx * gy;
      own.yy += gy * gy;
    }
  });
  const GradientProducts all{reduceBlock(own.xx, values, Total{}),
                             reduceBlock(own.xy, values, Total{}),
                             reduceBlock(own.yy, values, Total{})};
  if (threadIdx.x == 0) sums[blockIdx.x] = all;
}

__global__ void estimateRegions(const __grid_constant__ MatchedRegions regions,
                                const rg::motion::FoundShift* found,
                                const GradientProducts* gradients, RegionMotion* motion) {
  const int region = indexInGrid();
  if (region >= regions.count) return;
  uint64_t pixels = 0;
  for (uint32_t i = regions.starts[region]; i < regions.starts[region + 1]; ++i)
    pixels += static_cast<uint64_t>(__popcll(regions.parts[i].blocks)) * kBlockWidth;
  const GradientProducts& sums = gradients[region];
  motion[region] =
      pixels == 0 ? RegionMotion{}
                  : rg::motion::estimateMotion(found[region], {sums.xx, sums.xy, sums.yy, pixels});
}

}  // namespace

void findStill(const MatchedRegions& regions, ImageView<const uint8_t> luma,
               ImageView<const uint8_t> previous, uint8_t* still, Stream stream) {
  if (regions.count == 0) return;
  start(overRegions("findStill", regions.count, 2, 1), stream, compareRegions, regions, luma,
        previous, still);
}

void sumGradients(const MatchedRegions& regions, ImageView<const uint8_t> luma,
                  GradientProducts* sums, Stream stream) {
  if (regions.count == 0) return;
  start(overRegions("sumGradients", regions.count, 3, 10), stream, sumProducts, regions, luma,
        sums);
}

void estimateMotion(const MatchedRegions& regions, const rg::motion::FoundShift* found,
                    const GradientProducts* gradients, RegionMotion* motion, Stream stream) {
  if (regions.count == 0) return;
  const auto count = static_cast<double>(regions.count);
  start(launchOverList("estimateMotion", regions.count, {500 * count, 1000 * count}), stream,
        estimateRegions, regions, found, gradients, motion);
}

}  // namespace rg::gpu::motion
