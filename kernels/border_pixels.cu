// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/row_spans.hpp"
#include "core/segmentation/side_colours.hpp"
#include "kernels/border_pixels.hpp"
#include "kernels/start.hpp"
#include "kernels/threads.hpp"

namespace rg::gpu::segmentation {
namespace {

using rg::segmentation::kAlikeColours;
using rg::segmentation::simd::kMostColours;

constexpr int kThreads = 64;

struct Colour {
  int red, green, blue;
  __device__ int operator[](int c) const { return c == 0 ? red : c == 1 ? green : blue; }
};

/// A cell's colour and a 1 to count it, packed.
__device__ uint64_t packed(const RefinedCells& cells, Point p) {
  const auto level = [&](int c) {
    return uint64_t{cells.colours.planes[c < cells.colours.channels ? c : 0].at(p.x, p.y)};
  };
  return uint64_t{1} << 48 | level(2) << 32 | level(1) << 16 | level(0);
}
__device__ bool isPure(const RefinedCells& cells, Point p) {
  return cells.ranges.at(p.x, p.y) <= rg::segmentation::kOneColour;
}
__device__ bool isApart(const RefinedCells& cells, Point p) {
  return cells.scope.data != nullptr && cells.scope.at(p.x, p.y) != kInScope;
}

/// What a thread finds round its cell: regions, and packed sums of their cells there, of all and of
/// those of one colour. In shared memory, for they are looked up by number.
template <class Sums, class Ids>
struct Found {
  Sums &all, &pure;
  Ids& ids;
  int count = 0;

  __device__ Found(Sums& ofAll, Sums& ofPure, Ids& ofRegions)
      : all(ofAll), pure(ofPure), ids(ofRegions) {}

  __device__ static int at(int k) { return k * kThreads + static_cast<int>(threadIdx.x); }
  __device__ bool isSure(int k) const { return pure[at(k)] != 0; }

  __device__ void take(uint16_t id, uint64_t colour, bool isOneColour) {
    int k = 0;
    while (k < count && ids[at(k)] != id) ++k;
    if (k == count) {
      ids[at(k)] = id;
      all[at(k)] = pure[at(k)] = uint64_t{0};
      ++count;
    }
    all[at(k)] = all[at(k)] + colour;
    if (isOneColour) pure[at(k)] = pure[at(k)] + colour;
  }

  __device__ Colour colour(int k) const {
    const uint64_t sum = isSure(k) ? pure[at(k)] : all[at(k)];
    const uint32_t reciprocal = rg::segmentation::reciprocal(rg::segmentation::packedCount(sum));
    const auto mean = [&](int c) { return rg::segmentation::packedMean(sum, c, reciprocal); };
    return {mean(0), mean(1), mean(2)};
  }

  __device__ bool isBetween(int k) const {
    const Colour own = colour(k);
    for (int i = 0; i < count; ++i)
      for (int j = 0; j < count && isSure(i); ++j)
        if (j != k && rg::segmentation::lies(own, colour(i), colour(j))) return true;
    return false;
  }
};

/// A cell of several colours says nothing of its own region, unless no other does.
template <class Sums, class Ids>
__device__ void collect(const RefinedCells& cells, Point cell, Found<Sums, Ids>& found) {
  const uint64_t own = packed(cells, cell);
  const bool isOneColour = isPure(cells, cell), isOwnApart = isApart(cells, cell);
  found.take(cells.ids.at(cell.x, cell.y), isOneColour ? own : 0, isOneColour);
  for (int y = cell.y - 1; y <= cell.y + 1; ++y)
    for (int x = cell.x - 1; x <= cell.x + 1; ++x) {
      const Point p{x, y};
      if (p == cell || !boundsOf(cells.ids.size).contains(p)) continue;
      const uint16_t id = cells.ids.at(x, y);
      if (id == 0 || isApart(cells, p) != isOwnApart) continue;
      found.take(id, packed(cells, p), isPure(cells, p));
    }
  if (found.all[Found<Sums, Ids>::at(0)] == 0) found.all[Found<Sums, Ids>::at(0)] = own;
}

template <class Sums, class Ids>
__device__ void choose(const Found<Sums, Ids>& found, SideChoice& choice) {
  Colour first{};
  int count = 0;
  for (int k = 0; k < found.count; ++k) {
    if (!found.isSure(k) && found.count > 2 && found.isBetween(k)) continue;
    const Colour colour = found.colour(k);
    if (count > 0 && rg::segmentation::farthestOf(colour, first) <= kAlikeColours) continue;
    if (count == 0) first = colour;
    for (int c = 0; c < 3; ++c) choice.colours[count][c] = static_cast<uint8_t>(colour[c]);
    choice.ids[count++] = found.ids[found.at(k)];
  }
  choice.count = static_cast<uint8_t>(count);
}

__global__ void findSides(const __grid_constant__ RefinedCells cells, SideChoice* choices) {
  RG_SHARED(uint64_t, all, kMostColours * kThreads);
  RG_SHARED(uint64_t, pure, kMostColours * kThreads);
  RG_SHARED(uint16_t, ids, kMostColours * kThreads);
  const int i = indexInGrid(), width = cells.ids.width();
  if (i >= cells.ids.size.area()) return;
  const Point cell{i % width, i / width};
  if (cells.ids.at(cell.x, cell.y) == 0) {
    choices[i].ids[0] = 0;
    choices[i].count = 1;
    return;
  }
  Found found(all, pure, ids);
  collect(cells, cell, found);
  choose(found, choices[i]);
}

__device__ int distanceTo(const uint8_t* colour, const Planes& pixels, Point p, int margin) {
  int sum = margin;
  for (int c = 0; c < 3; ++c)
    sum += absDiff(pixels.planes[c < pixels.channels ? c : 0].at(p.x, p.y), colour[c]);
  return sum < 255 ? sum : 255;
}

__global__ void choosePixels(const __grid_constant__ RefinedCells cells, const SideChoice* choices,
                             ImageView<uint16_t> ids) {
  const Point p = pixelOfThread();
  if (!isWithin(p, ids.size)) return;
  const SideChoice& choice = choices[p.y / cells.sidePx * cells.ids.width() + p.x / cells.sidePx];
  const bool isIn =
      cells.pixelScope.data == nullptr || rg::isInScope(cells.pixelScope.at(p.x, p.y));
  uint16_t id = isIn ? choice.ids[0] : uint16_t{0};
  if (isIn && choice.count > 1) {
    int least = distanceTo(choice.colours[0], cells.pixels, p, 0);
    for (int k = 1; k < choice.count; ++k) {
      const int distance =
          distanceTo(choice.colours[k], cells.pixels, p, rg::segmentation::kSideMargin);
      if (distance >= least) continue;
      least = distance;
      id = choice.ids[k];
    }
  }
  ids.at(p.x, p.y) = id;
}

}  // namespace

void refineBorders(const RefinedCells& cells, SideChoice* choices, ImageView<uint16_t> ids,
                   Stream stream) {
  const auto count = static_cast<double>(cells.ids.size.area());
  const auto pixels = static_cast<double>(ids.size.area());
  start({"findSides",
         {blocksFor(cells.ids.size.area(), kThreads), 1, 1},
         {kThreads, 1, 1},
         {52 * count, 200 * count}},
        stream, findSides, cells, choices);
  // Of cells at a border the pixels are read, too: a quarter of all, say.
  start(launchOver("choosePixels", ids.size, 1, {3.5 * pixels, 20 * pixels}), stream, choosePixels,
        cells, static_cast<const SideChoice*>(choices), ids);
}

}  // namespace rg::gpu::segmentation
