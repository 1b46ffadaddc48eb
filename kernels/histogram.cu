// SPDX-License-Identifier: LGPL-2.1-or-later
#include "kernels/histogram.hpp"
#include "kernels/start.hpp"
#include "kernels/threads.hpp"

namespace rg::gpu {
namespace {

constexpr int kLevels = 256;
/// A block counts 256 columns of 64 rows, so that its 256 sums are few beside its pixels.
constexpr int kColumns = 256, kRows = 64;
static_assert(kTile.x * kTile.y == kLevels);  // A thread clears and adds one level.

__global__ void countLevelsOfTiles(ImageView<const uint8_t> image, uint32_t* levels) {
  RG_SHARED(uint32_t, counts, kLevels);
  const int level = threadOfBlock();
  counts[level] = 0;
  __syncthreads();
  const int left = static_cast<int>(blockIdx.x) * kColumns + static_cast<int>(threadIdx.x);
  const int top = static_cast<int>(blockIdx.y) * kRows + static_cast<int>(threadIdx.y);
  const int right = std::min(image.width(), left + kColumns);
  const int bottom = std::min(image.height(), top + kRows);
  for (int y = top; y < bottom; y += static_cast<int>(kTile.y))
    for (int x = left; x < right; x += kWarp) {
      const uint8_t found = image.at(x, y);
      if (isMutated(Mutant::LostAtomic))
        counts[found] = counts[found] + 1;
      else
        atomicAdd(&counts[found], 1u);
    }
  __syncthreads();
  if (counts[level] != 0) atomicAdd(levels + level, static_cast<uint32_t>(counts[level]));
}

}  // namespace

void countLevels(ImageView<const uint8_t> image, uint32_t* levels, Stream stream) {
  const auto pixels = static_cast<double>(image.size.area());
  clear(levels, kLevels * sizeof *levels, stream);
  const Extent grid{blocksFor(image.width(), kColumns), blocksFor(image.height(), kRows), 1};
  start({"countLevels", grid, kTile, {pixels, 2 * pixels}}, stream, countLevelsOfTiles, image,
        levels);
}

}  // namespace rg::gpu
