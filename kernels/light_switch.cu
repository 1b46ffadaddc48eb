// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/pixel.hpp"
#include "kernels/block_reduce.hpp"
#include "kernels/light_switch.hpp"
#include "kernels/model_pixels.hpp"
#include "kernels/start.hpp"
#include "kernels/threads.hpp"

namespace rg::gpu::background {
namespace {

using rg::background::LevelMaps;

constexpr int kLevels = 256;

/// Brings the maps into a block's array; all of its threads must call.
template <class Array>
__device__ void loadMaps(const LevelMaps& maps, int threads, Array& levels) {
  for (int i = threadOfBlock(); i < 3 * kLevels; i += threads)
    levels[i] = maps[static_cast<size_t>(i / kLevels)][static_cast<size_t>(i % kLevels)];
  __syncthreads();
}

__global__ void countPixelsApart(const __grid_constant__ LitPictures pictures,
                                 const __grid_constant__ LevelMaps maps,
                                 const __grid_constant__ ModelView model,
                                 rg::background::Tolerance tolerance, uint32_t* count) {
  RG_SHARED(uint8_t, levels, 3 * kLevels);
  RG_SHARED(uint32_t, values, kReduceWarps);
  loadMaps(maps, kReduceThreads, levels);
  const auto pixels = static_cast<int>(model.size.area());
  const auto stride = static_cast<int>(gridDim.x) * kReduceThreads;
  uint32_t own = 0;
  for (int i = indexInGrid(); i < pixels; i += stride) {
    const Point p{i % model.size.width, i / model.size.width};
    int off = 0;
    for (int c = 0; c < model.channels; ++c) {
      const int shown = levels[c * kLevels + pictures.shown.planes[c].at(p.x, p.y)];
      off = std::max(off, absDiff(shown, pictures.picture.planes[c].at(p.x, p.y)));
    }
    own += off > radiusAt(model, tolerance, pictures.picture.planes[0].at(p.x, p.y), p);
  }
  own = reduceBlock(own, values, [](uint32_t a, uint32_t b) { return a + b; });
  if (threadIdx.x == 0) atomicAdd(count, own);
}

__global__ void relightSamples(const __grid_constant__ LevelMaps maps,
                               const __grid_constant__ ModelView model) {
  RG_SHARED(uint8_t, levels, 3 * kLevels);
  loadMaps(maps, kTile.x * kTile.y, levels);
  const Point p = pixelOfThread();
  if (!isWithin(p, model.samples.size)) return;
  uint8_t& sample = model.samples.at(p.x, p.y);
  sample = levels[p.x / kWordColumns % model.channels * kLevels + sample];
}

}  // namespace

void countApart(const LitPictures& pictures, const LevelMaps& maps, const ModelView& model,
                const rg::background::Tolerance& tolerance, uint32_t* pixels, Stream stream) {
  constexpr unsigned kPixelsOfThread = 16;
  const auto area = static_cast<double>(model.size.area());
  clear(pixels, sizeof *pixels, stream);
  start({"countApart",
         {blocksFor(model.size.area(), kReduceThreads * kPixelsOfThread), 1, 1},
         {kReduceThreads, 1, 1},
         {area * (2 * model.channels + 2), area * (3 * model.channels + 5)}},
        stream, countPixelsApart, pictures, maps, model, tolerance, pixels);
}

void relight(const LevelMaps& maps, const ModelView& model, Stream stream) {
  const auto samples = static_cast<double>(model.samples.size.area());
  start(launchOver("relight", model.samples.size, 1, {2 * samples, samples}), stream,
        relightSamples, maps, model);
}

}  // namespace rg::gpu::background
