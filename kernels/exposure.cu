// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/scene_watch.hpp"
#include "kernels/exposure.hpp"
#include "kernels/model_pixels.hpp"
#include "kernels/start.hpp"
#include "kernels/threads.hpp"

namespace rg::gpu::background {
namespace {

using rg::background::GainSums;
using rg::background::LevelMap;
using rg::background::PointGrid;

constexpr int kPointThreads = 256;
constexpr int kLevels = 256;

__global__ void weighGains(const __grid_constant__ Planes picture,
                           const __grid_constant__ ModelView model, PointGrid grid,
                           GainSums* sums) {
  const int i = indexInGrid();
  if (i >= grid.count()) return;
  const Point p = grid.point(i);
  const int modelled = modelledLevel(model, p, 0), shown = picture.planes[0].at(p.x, p.y);
  if (GainSums::tells(shown, modelled))
    atomicAdd(sums->weight + GainSums::gainOf(shown, modelled), static_cast<uint32_t>(modelled));
}

__global__ void mapPixels(const __grid_constant__ LevelMap map,
                          const __grid_constant__ PlaneTargets picture) {
  RG_SHARED(uint8_t, levels, kLevels);
  static_assert(kTile.x * kTile.y == kLevels);
  const int level = threadOfBlock();
  levels[level] = map[static_cast<size_t>(level)];
  __syncthreads();
  const Point p = pixelOfThread();
  if (!isWithin(p, picture.size())) return;
  uint8_t& pixel = picture.planes[blockIdx.z].at(p.x, p.y);
  pixel = levels[pixel];
}

}  // namespace

void sumGains(const Planes& picture, const ModelView& model, GainSums* sums, Stream stream) {
  const PointGrid grid = PointGrid::over(picture.size(), 0);
  const double points = grid.count();
  clear(sums, sizeof *sums, stream);
  start({"sumGains",
         {blocksFor(grid.count(), kPointThreads), 1, 1},
         {kPointThreads, 1, 1},
         {9 * points, 16 * points}},
        stream, weighGains, picture, model, grid, sums);
}

void mapLevels(const LevelMap& map, const PlaneTargets& picture, Stream stream) {
  const double bytes = static_cast<double>(picture.size().area()) * picture.channels;
  start(launchOver("mapLevels", picture.size(), static_cast<unsigned>(picture.channels),
                   {2 * bytes, bytes}),
        stream, mapPixels, map, picture);
}

}  // namespace rg::gpu::background
