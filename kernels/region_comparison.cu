// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/pixel.hpp"
#include "kernels/region_comparison.hpp"
#include "kernels/start.hpp"
#include "kernels/threads.hpp"
#include "kernels/warp_runs.hpp"

namespace rg::gpu::objects {
namespace {

using Sums = OwnMotionScratch::Sums;

constexpr int kBands = OwnMotionScratch::kBands;
constexpr uint32_t kNoBand = UINT32_MAX;

/// Where movers overlap, the largest label counts.
__global__ void coverPixels(ImageView<const uint16_t> labels, const ComparedRegion* regions,
                            uint32_t* hidden) {
  const Point p = pixelOfThread();
  if (!isWithin(p, labels.size)) return;
  const uint32_t label = labels.at(p.x, p.y);
  if (label == 0 || regions[label - 1].moves == 0) return;
  for (const Point by : rg::objects::coveredBy(regions[label - 1].covered)) {
    const Point from{p.x - by.x, p.y - by.y};
    if (boundsOf(labels.size).contains(from))
      atomicMax(hidden + from.y * labels.width() + from.x, label);
  }
}

/// Whether a region's pixel can be compared.
__device__ bool isCompared(const ComparedPictures& pictures, const ComparedRegion& region,
                           const RegionList& regions, Point p) {
  const int from = p.y - region.shift.y;
  if (region.shift == Point{} || from < 0 || from >= pictures.luma.height()) return false;
  if (!rg::objects::isComparedRow(p.y, region.box, regions.everyRow)) return false;
  const Point back = rg::objects::behind(p, region.shift);
  const auto& labels = pictures.labels;
  if (!boundsOf(labels.size).contains(back) || labels.at(back.x, back.y) != labels.at(p.x, p.y))
    return false;
  const ShownRange columns =
      rg::objects::comparedColumns(pictures.shown[p.y], pictures.shown[from], region.shift.x);
  return p.x >= columns.first && p.x < columns.last;
}

__device__ int bandOf(const ComparedRegion& region, Point p) {
  return rg::objects::hasRowBands(region.shift) ? rg::objects::bandOfRow(p.y, region.box)
                                                : rg::objects::bandOfColumn(p.x, region.box);
}

__global__ void comparePixels(const __grid_constant__ ComparedPictures pictures,
                              const __grid_constant__ RegionList regions, const uint32_t* hidden,
                              Sums* bands) {
  const Point p = pixelOfThread();
  uint32_t band = kNoBand, still = 0, moved = 0;
  const uint32_t label = isWithin(p, pictures.labels.size) ? pictures.labels.at(p.x, p.y) : 0;
  if (label != 0) {
    const ComparedRegion& region = regions.list[label - 1];
    if (isCompared(pictures, region, regions, p) &&
        !(regions.hidesAny &&
          rg::objects::hidesFrom(static_cast<uint16_t>(label),
                                 hidden[p.y * pictures.labels.width() + p.x]))) {
      const uint8_t now = pictures.luma.at(p.x, p.y);
      const Point by = region.shift;
      band = (label - 1) * kBands + static_cast<uint32_t>(bandOf(region, p));
      const auto differenceFrom = [&](int x, int y) {
        return rg::objects::limitedDifference(now, pictures.expected.at(x, y), region.mostLevels);
      };
      still = differenceFrom(p.x, p.y);
      moved = differenceFrom(p.x - by.x, p.y - by.y);
    }
  }
  const LaneRun run = runOfLane(band);
  still = sumOfRun(run, still);
  moved = sumOfRun(run, moved);
  if (band == kNoBand || !run.isLast) return;
  addSum(bands[band].still, still);
  addSum(bands[band].moved, moved);
  addSum(bands[band].pixels, static_cast<uint64_t>(run.before) + 1);
}

/// A kernel, as graphs of launches are made again where other sizes are cleared.
__global__ void clearBands(Sums* bands, int count) {
  const int i = indexInGrid();
  if (i < count) bands[i] = {};
}

__global__ void sumBands(const __grid_constant__ RegionList regions, const Sums* bands,
                         OwnMotionScratch::Trial* trials) {
  const int i = indexInGrid();
  if (i >= regions.count) return;
  const Sums* own = bands + i * kBands;
  const Point shift = regions.list[i].shift;
  trials[i] = {};
  if (shift != Point{})
    trials[i] = {shift, rg::objects::sumWithoutBest(own),
                 rg::objects::sumOfBands(own, kBands).pixels};
}

}  // namespace

void compareRegions(const ComparedPictures& pictures, const RegionList& regions,
                    const ComparisonView& out, Stream stream) {
  if (regions.count == 0) return;
  const Size size = pictures.labels.size;
  const auto pixels = static_cast<double>(size.area()), count = static_cast<double>(regions.count);
  const auto list = static_cast<double>(sizeof(Sums)) * kBands * count;
  const int bands = kBands * regions.count;
  start(launchOverList("clearBands", bands, {list, 4 * static_cast<double>(bands)}), stream,
        clearBands, out.bands, bands);
  if (regions.hidesAny) {
    clear(out.hidden, sizeof(uint32_t) * static_cast<size_t>(size.area()), stream);
    start(launchOver("coverPixels", size, 1, {10 * pixels, 16 * pixels}), stream, coverPixels,
          pictures.labels, regions.list, out.hidden);
  }
  const double hidden = regions.hidesAny ? 4 : 0;
  start(launchOver("comparePixels", size, 1, {(5 + hidden) * pixels + list, 80 * pixels}), stream,
        comparePixels, pictures, regions, static_cast<const uint32_t*>(out.hidden), out.bands);
  start(launchOverList("sumBands", regions.count, {list + 48 * count, 80 * count}), stream,
        sumBands, regions, static_cast<const Sums*>(out.bands), out.trials);
}

}  // namespace rg::gpu::objects
