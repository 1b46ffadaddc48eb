// SPDX-License-Identifier: LGPL-2.1-or-later
#include "kernels/absorber.hpp"
#include "kernels/region_division.hpp"
#include "kernels/start.hpp"
#include "kernels/threads.hpp"

namespace rg::gpu::segmentation {
namespace {

using namespace one_block;

__device__ uint32_t representativeOf(const AbsorptionView& view, uint32_t i) {
  while (view.forest[i] != i) i = view.forest[i];
  return i;
}

/// Numbers follow the components' order; the smallest of too many regions go to label 0.
template <class Sums, class Digits>
__device__ uint32_t numberLabels(const DivisionView& view, uint32_t left, uint32_t maxRegions,
                                 Sums& sums, Digits& digits) {
  constexpr uint32_t kOpen = ~uint32_t{0}, kDropped = kOpen - 1;
  const AbsorptionView& absorption = view.absorption;
  const uint32_t count = *absorption.count;
  forAll(count, [&](uint32_t i) { view.firstOf[i] = kOpen; });
  // First components first: a representative may stand behind others of its region.
  forAll(count, [&](uint32_t i) { atomicMin(view.firstOf + representativeOf(absorption, i), i); });
  if (left > maxRegions) {
    const auto keyOf = [&](uint32_t i) {
      return sizeKey(absorption.regions[i], absorption.regions[i].representative);
    };
    const unsigned long long last = keyOfRank(left, left - maxRegions, digits, keyOf);
    forAll(left, [&](uint32_t i) {
      if (keyOf(i) <= last) view.firstOf[absorption.regions[i].representative] = kDropped;
    });
  }
  struct First {
    uint32_t representative;
    bool isChosen;
  };
  const uint32_t labels = numberChosen(
      count, sums,
      [&](uint32_t i) {
        const uint32_t representative = i < count ? representativeOf(absorption, i) : 0;
        return First{representative, i < count && view.firstOf[representative] == i};
      },
      [&](uint32_t, uint32_t number, const First& first) {
        absorption.numbers[first.representative] = number + 1;
      });
  forAll(count, [&](uint32_t i) {
    const uint32_t representative = representativeOf(absorption, i);
    view.labels[i] =
        view.firstOf[representative] == kDropped ? 0 : absorption.numbers[representative];
  });
  forAll(left, [&](uint32_t i) {
    const AbsorbedRegion& region = absorption.regions[i];
    const uint32_t label = view.labels[region.representative];
    if (label != 0) view.labelled[label] = region;
  });
  return labels;
}

__global__ void __launch_bounds__(kThreads, 1)
    absorbAndNumber(AbsorptionLimits limits, const __grid_constant__ DivisionView view) {
  RG_SHARED(uint32_t, sums, kWarps);
  RG_SHARED(uint32_t, digits, kDigits);
  const uint32_t left = absorbAll(limits, view.absorption, sums, digits);
  const uint32_t labels = numberLabels(view, left, limits.maxRegions, sums, digits);
  if (threadIdx.x == 0) *view.count = labels;
}

__global__ void clearRegions(const uint32_t* components, AbsorptionView view) {
  const uint32_t count = *components, stride = threadsOfGrid();
  for (uint32_t i = blockIdx.x * blockDim.x + threadIdx.x; i < count; i += stride)
    view.regions[i] = {};
  if (blockIdx.x == 0 && threadIdx.x == 0) *view.count = count;
}

__global__ void sumCells(const __grid_constant__ DividedCells cells, const uint32_t* of,
                         AbsorbedRegion* regions) {
  const Size size = cells.colours.size();
  const Point p{static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x),
                static_cast<int>(blockIdx.y * blockDim.y + threadIdx.y)};
  if (p.x >= size.width || p.y >= size.height) return;
  const uint32_t component = of[p.y * size.width + p.x];
  if (component == kNoGroup) return;
  const uint32_t weight = cells.weights.data != nullptr ? cells.weights.at(p.x, p.y) : 1;
  const auto sum = [&](int c) {
    const int channel = c < cells.colours.channels ? c : 0;
    return uint64_t{weight * cells.colours.planes[channel].at(p.x, p.y)};
  };
  AbsorbedRegion& region = regions[component];
  addSum(region.red, sum(0));
  addSum(region.green, sum(1));
  addSum(region.blue, sum(2));
  atomicAdd(&region.areaPx, weight);
}

/// Each part has the mean colour of its label's region.
__global__ void takeColours(const AbsorbedRegion* labelled, ImageView<const uint16_t> ids,
                            GroupsView groups, AbsorptionView view) {
  const uint32_t count = groups.numbers[ids.size.area()], stride = threadsOfGrid();
  for (uint32_t i = blockIdx.x * blockDim.x + threadIdx.x; i < count; i += stride) {
    const uint32_t cell = groups.first[i], area = groups.areas[cell];
    const auto width = static_cast<uint32_t>(ids.size.width);
    const AbsorbedRegion& whole =
        labelled[ids.at(static_cast<int>(cell % width), static_cast<int>(cell / width))];
    const auto share = [&](uint64_t sum) { return sum * area / whole.areaPx; };
    view.regions[i] = {share(whole.red), share(whole.green), share(whole.blue), area, 0};
  }
  if (blockIdx.x == 0 && threadIdx.x == 0) *view.count = count;
}

__global__ void writeLabels(const uint32_t* of, const uint32_t* labels, ImageView<uint16_t> ids) {
  const Point p{static_cast<int>(blockIdx.x * blockDim.x + threadIdx.x),
                static_cast<int>(blockIdx.y * blockDim.y + threadIdx.y)};
  if (p.x >= ids.size.width || p.y >= ids.size.height) return;
  const uint32_t component = of[p.y * ids.size.width + p.x];
  ids.at(p.x, p.y) = static_cast<uint16_t>(component == kNoGroup ? 0 : labels[component]);
}

Launch overComponents(const char* name, Size size) {
  const auto cells = static_cast<double>(size.area());
  return launchInTurns(name, size.area(), {cells, cells});
}

/// cellsOfComponent: for the model.
void label(const AbsorptionLimits& limits, const GroupsView& groups, const DivisionView& view,
           ImageView<uint16_t> ids, double cellsOfComponent, Stream stream) {
  const auto pixels = static_cast<double>(ids.size.area());
  start(launchOf("absorbAndNumber", pixels / cellsOfComponent), stream, absorbAndNumber, limits,
        view);
  start(launchOver("writeLabels", ids.size, 1, {10 * pixels, pixels}), stream, writeLabels,
        static_cast<const uint32_t*>(groups.of), static_cast<const uint32_t*>(view.labels), ids);
}

}  // namespace

void divideRegions(const DividedCells& cells, const GroupsView& groups,
                   const rg::segmentation::RegionDivision::Limits& limits, const DivisionView& view,
                   ImageView<uint16_t> ids, Stream stream) {
  const Size size = cells.colours.size();
  const auto count = static_cast<double>(size.area());
  const auto grainPx = static_cast<uint32_t>(cells.sidePx);
  start(overComponents("clearRegions", size), stream, clearRegions,
        static_cast<const uint32_t*>(groups.numbers + size.area()), view.absorption);
  start(launchOver("sumCells", size, 1, {8 * count, 8 * count}), stream, sumCells, cells,
        static_cast<const uint32_t*>(groups.of), view.absorption.regions);
  label({limits.minAreaPx, limits.maxRegions, grainPx}, groups, view, ids, 8, stream);
}

void divideAgain(const AbsorbedRegion* labelled, const GroupsView& groups,
                 const rg::segmentation::RegionDivision::Limits& limits, const DivisionView& view,
                 ImageView<uint16_t> ids, Stream stream) {
  const ImageView<const uint16_t> before = ids;
  start(overComponents("takeColours", ids.size), stream, takeColours, labelled, before, groups,
        view.absorption);
  label({limits.minAreaPx, limits.maxRegions, 1, rg::segmentation::kPieceGrowth}, groups, view, ids,
        256, stream);
}

}  // namespace rg::gpu::segmentation
