// SPDX-License-Identifier: LGPL-2.1-or-later
#include "kernels/cell_groups.hpp"
#include "kernels/forest.hpp"
#include "kernels/pair_sums.hpp"
#include "kernels/start.hpp"
#include "kernels/threads.hpp"

namespace rg::gpu::segmentation {
namespace {

using rg::segmentation::AbsorbedBorder;

/// What is grouped: linked cells.
struct LinkedCells {
  ImageView<const uint8_t> links;
  [[nodiscard]] constexpr Size size() const { return links.size; }
  __device__ bool isIn(Point p) const { return has(p, rg::segmentation::kIsPixel); }
  __device__ bool isLinkedLeft(Point p) const { return has(p, rg::segmentation::kLinkedLeft); }
  __device__ bool isLinkedUp(Point p) const { return has(p, rg::segmentation::kLinkedUp); }

 private:
  __device__ bool has(Point p, int bit) const { return (links.at(p.x, p.y) & bit) != 0; }
};

/// Or pixels of equal labels.
struct LabelledPixels {
  ImageView<const uint16_t> labels;
  [[nodiscard]] constexpr Size size() const { return labels.size; }
  __device__ bool isIn(Point p) const { return labels.at(p.x, p.y) != 0; }
  __device__ bool isLinkedLeft(Point p) const {
    return isIn(p) && p.x > 0 && labels.at(p.x - 1, p.y) == labels.at(p.x, p.y);
  }
  __device__ bool isLinkedUp(Point p) const {
    return isIn(p) && p.y > 0 && labels.at(p.x, p.y - 1) == labels.at(p.x, p.y);
  }
};

/// The tiles that large components are cut into.
struct Tiles {
  uint32_t maxArea;
  int side;
  bool cut;
  __device__ bool cutLeft(Point p) const { return cut && p.x % side == 0; }
  __device__ bool cutUp(Point p) const { return cut && p.y % side == 0; }
};

template <class Links>
struct Grouped {
  Links links;
  Tiles tiles;
  GroupsView groups;

  __device__ uint32_t index(Point p) const {
    return static_cast<uint32_t>(p.y * links.size().width + p.x);
  }
  /// Linked within the tile.
  __device__ bool goesOnLeft(Point p) const { return links.isLinkedLeft(p) && !tiles.cutLeft(p); }
  __device__ bool goesOnUp(Point p) const { return links.isLinkedUp(p) && !tiles.cutUp(p); }
  /// The first cell of the component of a cell, when areas are known.
  __device__ uint32_t rootOfCell(uint32_t cell) const {
    const uint32_t part = groups.parents[cell];
    if (!tiles.cut) return part;
    const uint32_t whole = groups.wholes[part];
    return groups.wholeAreas[whole] > tiles.maxArea ? part : whole;
  }
};

/// Each cell begins where its run in the warp does.
template <class Links>
__global__ void startCells(const __grid_constant__ Grouped<Links> cells) {
  const Point p = pixelOfThread();
  const bool isInside = isWithin(p, cells.links.size());
  const auto lane = static_cast<int>(threadIdx.x);
  const bool goesOn = isInside && lane > 0 && cells.goesOnLeft(p);
  const unsigned begins = __ballot_sync(kFullWarp, !goesOn) & ~0u >> (kWarp - 1 - lane);
  if (!isInside) return;
  const GroupsView& groups = cells.groups;
  const uint32_t i = cells.index(p);
  const auto behind = static_cast<uint32_t>(lane - (kWarp - 1 - __clz(begins)));
  groups.parents[i] = cells.links.isIn(p) ? i - behind : kNoGroup;
  groups.areas[i] = 0;
  if (!cells.tiles.cut) return;
  groups.wholes[i] = i;
  groups.wholeAreas[i] = 0;
}

/// Where the cell to the left is joined upwards too, this one need not be.
template <class Links>
__global__ void joinCells(const __grid_constant__ Grouped<Links> cells) {
  const Point p = pixelOfThread();
  if (!isWithin(p, cells.links.size())) return;
  const uint32_t i = cells.index(p);
  const auto width = static_cast<uint32_t>(cells.links.size().width);
  uint32_t* parents = cells.groups.parents;
  const bool goesOnLeft = cells.goesOnLeft(p);
  if (threadIdx.x == 0 && goesOnLeft) join(parents, i, i - 1);
  if (!cells.goesOnUp(p)) return;
  if (goesOnLeft && cells.goesOnUp({p.x - 1, p.y}) && cells.goesOnLeft({p.x, p.y - 1})) return;
  join(parents, i, i - width);
}

/// Each cell's parent is its part from then on; parts' areas are counted by runs of a warp.
template <class Links>
__global__ void flattenCells(const __grid_constant__ Grouped<Links> cells) {
  const Point p = pixelOfThread();
  const GroupsView& groups = cells.groups;
  const auto lane = static_cast<int>(threadIdx.x);
  uint32_t part = kNoGroup;
  if (isWithin(p, cells.links.size()) && cells.links.isIn(p)) {
    const uint32_t i = cells.index(p);
    part = rootOf(groups.parents, i);
    groups.parents[i] = part;
  }
  const uint32_t before = __shfl_up_sync(kFullWarp, part, 1);
  const bool begins = lane == 0 || part != before;
  const uint64_t later = uint64_t{__ballot_sync(kFullWarp, begins)} >> lane >> 1;
  if (!begins || part == kNoGroup) return;
  const int count = later == 0 ? kWarp - lane : __ffsll(static_cast<long long>(later));
  atomicAdd(groups.areas + part, static_cast<uint32_t>(count));
}

/// What is linked across the tiles.
template <class Links>
__global__ void joinTiles(const __grid_constant__ Grouped<Links> cells) {
  const Point p = pixelOfThread();
  if (!isWithin(p, cells.links.size())) return;
  const GroupsView& groups = cells.groups;
  const uint32_t i = cells.index(p);
  const auto joinParts = [&](uint32_t other) {
    join(groups.wholes, groups.parents[i], groups.parents[other]);
  };
  if (cells.tiles.cutLeft(p) && cells.links.isLinkedLeft(p)) joinParts(i - 1);
  if (cells.tiles.cutUp(p) && cells.links.isLinkedUp(p))
    joinParts(i - static_cast<uint32_t>(cells.links.size().width));
}

template <class Links>
__global__ void sumTiles(const __grid_constant__ Grouped<Links> cells) {
  const Point p = pixelOfThread();
  if (!isWithin(p, cells.links.size())) return;
  const GroupsView& groups = cells.groups;
  const uint32_t i = cells.index(p);
  if (groups.parents[i] != i) return;
  const uint32_t whole = rootOf(groups.wholes, i);
  groups.wholes[i] = whole;
  atomicAdd(groups.wholeAreas + whole, groups.areas[i]);
}

template <class Links>
__global__ void markFirst(const __grid_constant__ Grouped<Links> cells) {
  const Point p = pixelOfThread();
  if (!isWithin(p, cells.links.size())) return;
  const uint32_t i = cells.index(p);
  cells.groups.numbers[i] = cells.links.isIn(p) && cells.rootOfCell(i) == i;
}

template <class Links>
__global__ void numberCells(const __grid_constant__ Grouped<Links> cells) {
  const Point p = pixelOfThread();
  if (!isWithin(p, cells.links.size())) return;
  const GroupsView& groups = cells.groups;
  const uint32_t i = cells.index(p);
  groups.of[i] = kNoGroup;
  if (!cells.links.isIn(p)) return;
  const uint32_t root = cells.rootOfCell(i), number = groups.numbers[root];
  groups.of[i] = number;
  if (root == i) groups.first[number] = i;
}

__global__ void clearPairs(int64_t cells, GroupsView groups) {
  const uint32_t slots = slotsOf(cells, groups.numbers[cells]), stride = threadsOfGrid();
  for (auto i = static_cast<uint32_t>(indexInGrid()); i < slots; i += stride)
    clearSlot(groups.pairs, i);
  if (indexInGrid() == 0) *groups.borders.count = 0;
}

/// The pair of a cell and a neighbour before it, 0 where there is no border.
__device__ unsigned long long keyOf(const GroupsView& groups, ImageView<const uint8_t> scope,
                                    Size size, Point p, Point q) {
  if (!isWithin(p, size) || q.x < 0 || q.y < 0) return 0;
  if (scope.data != nullptr && scope.at(p.x, p.y) != scope.at(q.x, q.y)) return 0;
  const uint32_t a = groups.of[p.y * size.width + p.x], b = groups.of[q.y * size.width + q.x];
  return a == kNoGroup || b == kNoGroup || a == b ? 0 : pairKey(a, b);
}

/// Pairs of a row that follow each other are added together.
__global__ void countBorders(ImageView<const uint8_t> scope, Size size, GroupsView groups) {
  const Point p = pixelOfThread();
  const auto lane = static_cast<int>(threadIdx.x);
  const uint32_t slots = slotsOf(size.area(), groups.numbers[size.area()]);
  const unsigned long long side = keyOf(groups, scope, size, p, {p.x - 1, p.y});
  if (side != 0) addPair(groups.pairs, slots, side, 1);
  const unsigned long long up = keyOf(groups, scope, size, p, {p.x, p.y - 1});
  const unsigned long long before = __shfl_up_sync(kFullWarp, up, 1);
  const bool begins = lane == 0 || up != before;
  const uint64_t later = uint64_t{__ballot_sync(kFullWarp, begins)} >> lane >> 1;
  if (!begins || up == 0) return;
  const int count = later == 0 ? kWarp - lane : __ffsll(static_cast<long long>(later));
  addPair(groups.pairs, slots, up, static_cast<uint32_t>(count));
}

__global__ void listBorders(int64_t cells, uint32_t sidePx, GroupsView groups) {
  const uint32_t slots = slotsOf(cells, groups.numbers[cells]), stride = threadsOfGrid();
  // Whole warps: there are 64 slots at least.
  for (auto i = static_cast<uint32_t>(indexInGrid()); i < slots; i += stride) {
    const unsigned long long key = groups.pairs.keys[i];
    const uint32_t place = appendChosen(key != 0, groups.borders.count);
    if (key != 0)
      groups.borders.list[place] = {static_cast<uint32_t>(key >> 32), static_cast<uint32_t>(key),
                                    groups.pairs.sums[i] * sidePx};
  }
}

template <class Links>
void group(const Grouped<Links>& cells, ImageView<const uint8_t> scope, int sidePx, Stream stream) {
  const Size size = cells.links.size();
  const auto count = static_cast<double>(size.area());
  const auto over = [&](const char* name, double bytes, double operations) {
    return launchOver(name, size, 1, {bytes * count, operations * count});
  };
  const GroupsView& groups = cells.groups;
  start(over("startCells", 10, 8), stream, startCells<Links>, cells);
  start(over("joinCells", 6, 10), stream, joinCells<Links>, cells);
  start(over("flattenCells", 10, 10), stream, flattenCells<Links>, cells);
  if (cells.tiles.cut) {
    start(over("joinTiles", 1, 2), stream, joinTiles<Links>, cells);
    start(over("sumTiles", 5, 2), stream, sumTiles<Links>, cells);
  }
  start(over("markFirst", 10, 4), stream, markFirst<Links>, cells);
  scan(groups.numbers, static_cast<int>(size.area()), groups.numbers, groups.scratch, stream);
  start(over("numberCells", 14, 4), stream, numberCells<Links>, cells);
  // Components are few beside cells, and so are their borders.
  const auto overTable = [&](const char* name) {
    return launchInTurns(name, size.area(), {count, count});
  };
  start(overTable("clearPairs"), stream, clearPairs, size.area(), groups);
  start(over("countBorders", 6, 20), stream, countBorders, scope, size, groups);
  start(overTable("listBorders"), stream, listBorders, size.area(), static_cast<uint32_t>(sidePx),
        groups);
}

}  // namespace

void groupLinked(ImageView<const uint8_t> links, ImageView<const uint8_t> scope,
                 const rg::segmentation::RunLimits& limits, int sidePx, const GroupsView& groups,
                 Stream stream) {
  const bool cut = limits.maxAreaPx < links.size.area();
  group(Grouped<LinkedCells>{{links}, {limits.maxAreaPx, limits.tilePx, cut}, groups}, scope,
        sidePx, stream);
}

void groupLabelled(ImageView<const uint16_t> labels, ImageView<const uint8_t> scope,
                   const GroupsView& groups, Stream stream) {
  group(Grouped<LabelledPixels>{{labels}, {~uint32_t{0}, 1, false}, groups}, scope, 1, stream);
}

}  // namespace rg::gpu::segmentation
