// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/pixel.hpp"
#include "kernels/pair_sums.hpp"
#include "kernels/region_graph.hpp"
#include "kernels/start.hpp"
#include "kernels/threads.hpp"
#include "kernels/warp_runs.hpp"

namespace rg::gpu::graph {
namespace {

using rg::graph::RegionSums;
using rg::segmentation::RegionLabel;

__device__ uint32_t slotsOf(const LabelledPicture& labelled) {
  return slotsFor(mostArcs(labelled.labels.size.area(), *labelled.count));
}

__global__ void clearGraph(const __grid_constant__ LabelledPicture labelled,
                           const __grid_constant__ GraphView graph) {
  const auto first = static_cast<uint32_t>(indexInGrid());
  const uint32_t stride = gridDim.x * blockDim.x, slots = slotsOf(labelled);
  for (uint32_t i = first; i < *labelled.count; i += stride) graph.sums[i] = {};
  for (uint32_t i = first; i < slots; i += stride) {
    clearSlot(graph.pairs, i);
    graph.contrasts[i] = 0;
  }
  if (first == 0) *graph.arcCount = 0;
}

/// runs are not counted.
__device__ void addSums(const RegionSums& own, RegionSums& to) {
  addSum(to.x, own.x);
  addSum(to.y, own.y);
  addSum(to.red, own.red);
  addSum(to.green, own.green);
  addSum(to.blue, own.blue);
  atomicAdd(&to.areaPx, own.areaPx);
  // Bounds only move outwards: where one need not move now, it never will.
  if (own.left < to.left) atomicMin(&to.left, own.left);
  if (own.right > to.right) atomicMax(&to.right, own.right);
  if (own.top < to.top) atomicMin(&to.top, own.top);
  if (own.bottom > to.bottom) atomicMax(&to.bottom, own.bottom);
}

/// A warp has pixels of one row, of which each run of a region is added once.
__global__ void sumRegions(const __grid_constant__ LabelledPicture labelled, RegionSums* sums) {
  const Point p = pixelOfThread();
  const bool isInside = isWithin(p, labelled.labels.size);
  const uint32_t label = isInside ? labelled.labels.at(p.x, p.y) : 0;
  const auto level = [&](int c) {
    const int channel = c < labelled.picture.channels ? c : 0;
    return label == 0 ? 0u : uint32_t{labelled.picture.planes[channel].at(p.x, p.y)};
  };
  const LaneRun run = runOfLane(label);
  const uint32_t redGreen = sumOfRun(run, level(0) | level(1) << 16);  // 32 levels: 13 bits.
  const uint32_t blue = sumOfRun(run, level(2));
  if (!run.isLast || label == 0) return;
  const int first = p.x - run.before;
  const auto pixels = static_cast<uint32_t>(run.before + 1);
  addSums({uint64_t{pixels} * static_cast<uint64_t>(first + p.x) / 2,
           uint64_t{pixels} * static_cast<uint64_t>(p.y), redGreen & 0xFFFF, redGreen >> 16, blue,
           pixels, first, p.x + 1, p.y, p.y + 1},
          sums[label - 1]);
}

__global__ void describeRegions(const uint32_t* count, const __grid_constant__ GraphView graph) {
  const uint32_t stride = gridDim.x * blockDim.x;
  for (auto i = static_cast<uint32_t>(indexInGrid()); i < *count; i += stride)
    graph.regions[i] = rg::graph::describe(graph.sums[i]);
}

/// A pair of neighbours.
__device__ void addNeighbours(const LabelledPicture& labelled, const GraphView& graph,
                              uint32_t slots, Point p, Point q) {
  if (q.x < 0 || q.x >= labelled.labels.width() || q.y < 0) return;
  const uint16_t a = labelled.labels.at(p.x, p.y), b = labelled.labels.at(q.x, q.y);
  if (a == b || a == 0 || b == 0) return;
  int contrast = 0;
  for (int c = 0; c < labelled.picture.channels; ++c)
    contrast = std::max(contrast, absDiff(labelled.picture.planes[c].at(p.x, p.y),
                                          labelled.picture.planes[c].at(q.x, q.y)));
  const uint32_t slot = addPair(graph.pairs, slots, pairKey(a, b), 1);
  if (contrast != 0) atomicAdd(graph.contrasts + slot, static_cast<uint32_t>(contrast));
}

__global__ void countArcs(const __grid_constant__ LabelledPicture labelled, bool isEight,
                          const __grid_constant__ GraphView graph) {
  const Point p = pixelOfThread();
  if (!isWithin(p, labelled.labels.size)) return;
  const uint32_t slots = slotsOf(labelled);
  addNeighbours(labelled, graph, slots, p, {p.x - 1, p.y});
  addNeighbours(labelled, graph, slots, p, {p.x, p.y - 1});
  if (!isEight) return;
  addNeighbours(labelled, graph, slots, p, {p.x - 1, p.y - 1});
  addNeighbours(labelled, graph, slots, p, {p.x + 1, p.y - 1});
}

/// Labels are of 16 bits, so a pair is a key of 32.
__global__ void listArcs(const __grid_constant__ LabelledPicture labelled,
                         const __grid_constant__ GraphView graph) {
  const uint32_t slots = slotsOf(labelled), stride = gridDim.x * blockDim.x;
  // Whole warps: there are 64 slots at least.
  for (auto i = static_cast<uint32_t>(indexInGrid()); i < slots; i += stride) {
    const unsigned long long key = graph.pairs.keys[i];
    const uint32_t place = appendChosen(key != 0, graph.arcCount);
    if (key == 0) continue;
    graph.order.keys[place] = static_cast<uint32_t>(key >> 32 << 16 | (key & 0xFFFF));
    graph.order.values[place] = i;
  }
}

__global__ void writeArcs(const __grid_constant__ GraphView graph) {
  const uint32_t stride = gridDim.x * blockDim.x;
  for (auto i = static_cast<uint32_t>(indexInGrid()); i < *graph.arcCount; i += stride) {
    const uint32_t key = graph.order.keys[i], slot = graph.order.values[i];
    graph.arcs[i] = {RegionLabel::ofNumber(static_cast<uint16_t>(key >> 16)),
                     RegionLabel::ofNumber(static_cast<uint16_t>(key & 0xFFFF)),
                     graph.pairs.sums[slot], graph.contrasts[slot]};
  }
}

}  // namespace

void buildGraph(const LabelledPicture& labelled, Connectivity connectivity, const GraphView& graph,
                Stream stream) {
  const Size size = labelled.labels.size;
  const auto pixels = static_cast<double>(size.area());
  const auto most = static_cast<int64_t>(mostArcs(size.area(), graph.mostLabels));
  const double bytes = pixels * (2 + labelled.picture.channels);
  const uint32_t* count = labelled.count;
  start(launchInTurns("clearGraph", most, {32.0 * graph.mostLabels, 1.0 * graph.mostLabels}),
        stream, clearGraph, labelled, graph);
  start(launchOver("sumRegions", size, 1, {bytes, 30 * pixels}), stream, sumRegions, labelled,
        graph.sums);
  start(launchInTurns("describeRegions", graph.mostLabels,
                      {100.0 * graph.mostLabels, 400.0 * graph.mostLabels}),
        stream, describeRegions, count, graph);
  start(launchOver("countArcs", size, 1, {bytes, 8 * pixels}), stream, countArcs, labelled,
        connectivity == Connectivity::Eight, graph);
  start(launchInTurns("listArcs", most, {32.0 * graph.mostLabels, 8.0 * graph.mostLabels}), stream,
        listArcs, labelled, graph);
  sortPairs(graph.order, static_cast<int>(most), graph.arcCount, stream);
  start(launchInTurns("writeArcs", most, {96.0 * graph.mostLabels, 8.0 * graph.mostLabels}), stream,
        writeArcs, graph);
}

}  // namespace rg::gpu::graph
