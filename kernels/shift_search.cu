// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/pixel.hpp"
#include "core/motion/fit_sums.hpp"
#include "core/motion/textured_cells.hpp"
#include "core/simd/base/motion_rows.hpp"
#include "kernels/block_reduce.hpp"
#include "kernels/shift_search.hpp"
#include "kernels/start.hpp"
#include "kernels/threads.hpp"

namespace rg::gpu::motion {
namespace {

using rg::motion::FoundShift;
using rg::motion::kBlockWidth;
using rg::motion::kBoxSide;
using rg::motion::kPartHeight;
using rg::motion::MatchedPart;
using rg::motion::ShiftRange;

__global__ void padRows(ImageView<const uint8_t> luma, PaddedView to) {
  const Point p = pixelOfThread();
  if (!isWithin(p, to.rows.size)) return;
  to.rows.at(p.x, p.y) = luma.at(std::clamp(p.x - to.reach, 0, luma.width() - 1),
                                 std::clamp(p.y - to.reach, 0, luma.height() - 1));
}

__global__ void padSmoothRows(ImageView<const uint8_t> luma, PaddedView to) {
  const Point p = pixelOfThread();
  if (!isWithin(p, to.rows.size)) return;
  const auto within = [](int at, int count) { return at < 0 ? 0 : at < count ? at : count - 1; };
  const int x = within(p.x - to.reach, luma.width()), y = within(p.y - to.reach, luma.height());
  const int left = within(x - 1, luma.width()), right = within(x + 1, luma.width());
  const auto across = [&](int row) {
    const uint8_t* levels = luma.row(within(row, luma.height()));
    return rg::simd::binomialMean(levels[left], levels[x], levels[right]);
  };
  to.rows.at(p.x, p.y) =
      static_cast<uint8_t>(rg::simd::binomialMean(across(y - 1), across(y), across(y + 1)));
}

__global__ void sumBoxesOfPixels(PaddedView luma, BoxesView to) {
  const Point p = pixelOfThread();
  const Size size = luma.rows.size;
  if (!isWithin(p, size)) return;
  int sum = 0;
  if (p.x + kBoxSide <= size.width && p.y + kBoxSide <= size.height)
    for (int y = p.y; y < p.y + kBoxSide; ++y)
      for (int x = p.x; x < p.x + kBoxSide; ++x) sum += luma.rows.at(x, y);
  to.rows.at(p.x, p.y) = static_cast<uint16_t>(sum);
}

/// What a thread sums up: one shift of one region.
struct ShiftedPart {
  const SearchedPlanes& planes;
  Point e;

  __device__ const uint8_t* before(int x, int y) const {
    const PaddedView& previous = planes.previous;
    return previous.rows.row(y + e.y + previous.reach) + x + e.x + previous.reach;
  }
  /// Of a block of 4x1 pixels, which lies on a boundary of four.
  __device__ uint32_t difference(int x, int y) const {
    return __vsadu4(loadQuad(planes.luma.row(y) + x), loadQuadAnywhere(before(x, y)));
  }
  /// Of the sums of a box of 4x4 pixels.
  __device__ uint32_t boxDifference(int x, int y) const {
    unsigned now = 0;
    for (int row = 0; row < kBoxSide; ++row)
      now += __vsadu4(loadQuad(planes.luma.row(y + row) + x), 0);
    const int reach = planes.previous.reach;
    const int then = planes.boxes.rows.at(x + e.x + reach, y + e.y + reach);
    return static_cast<uint32_t>(absDiff(static_cast<int>(now), then));
  }
};

struct Sums {
  uint32_t sum = 0, bound = 0;
};

/// Boxes are as many as fit below each other into each run of blocks, as rg::motion::forBoxes has
/// them.
__device__ void addHalf(const MatchedPart& part, int half, const ShiftedPart& shifted, Sums& sums) {
  const int x = part.x() + half * kBlockWidth;
  for (int row = 0, run = 0; row < kPartHeight; ++row) {
    const bool isMatched = (part.blocks >> (2 * row + half) & 1) != 0;
    run = isMatched ? run + 1 : 0;
    if (!isMatched) continue;
    sums.sum += shifted.difference(x, part.y() + row);
    if (run < kBoxSide) continue;
    sums.bound += shifted.boxDifference(x, part.y() + row - kBoxSide + 1);
    run = 0;
  }
}

__device__ ShiftRange rangeOf(const MatchedRegions& regions, int region, const ShiftRange& most) {
  const bool isStill = regions.still != nullptr && regions.still[region] != 0;
  return isStill ? ShiftRange{rg::motion::kStillRange.maxShift, rg::motion::kStillRange.reach}
                 : most;
}

/// A thread for each shift; neighbours in a warp see neighbouring pixels.
__global__ void sumShifts(const __grid_constant__ MatchedRegions regions, int firstRegion,
                          const __grid_constant__ SearchedPlanes planes, ShiftRange most,
                          ShiftSums out) {
  const int region = firstRegion + static_cast<int>(blockIdx.y);
  const int reach = rangeOf(regions, region, most).reach;
  const int side = 2 * reach + 1, shift = indexInGrid();
  if (shift >= side * side) return;
  const ShiftedPart shifted{planes, {reach - shift % side, reach - shift / side}};
  Sums sums;
  for (uint32_t i = regions.starts[region]; i < regions.starts[region + 1]; ++i)
    for (int half = 0; half < 2; ++half) addHalf(regions.parts[i], half, shifted, sums);
  const int at = static_cast<int>(blockIdx.y) * shiftsOf(most) + shift;
  out.sums[at] = sums.sum;
  out.bounds[at] = sums.bound;
}

/// Smallest (sum, |d|², d.y, d.x): |d|² < 2^14, and the rest fits a byte each.
__device__ unsigned long long keyOf(uint32_t sum, Point d) {
  constexpr int kMost = rg::motion::kMostReach;
  const auto length = static_cast<uint32_t>(d.x * d.x + d.y * d.y);
  const uint32_t rank =
      length << 16 | static_cast<uint32_t>(d.y + kMost) << 8 | static_cast<uint32_t>(d.x + kMost);
  return static_cast<unsigned long long>(sum) << 32 | rank;
}

/// A block for each region.
__global__ void chooseShifts(const __grid_constant__ MatchedRegions regions, int firstRegion,
                             ShiftRange most, ShiftSums from, FoundShift* found) {
  RG_SHARED(unsigned long long, values, kReduceWarps);
  const ShiftRange range = rangeOf(regions, firstRegion + static_cast<int>(blockIdx.x), most);
  const int side = 2 * range.reach + 1, count = side * side;
  const ptrdiff_t begin = static_cast<ptrdiff_t>(blockIdx.x) * shiftsOf(most);
  const uint32_t *sums = from.sums + begin, *bounds = from.bounds + begin;
  const auto shiftOf = [&](int i) { return Point{i % side - range.reach, i / side - range.reach}; };
  const int first = static_cast<int>(threadIdx.x);
  unsigned long long key = ~0ull, bound = 0;
  for (int i = first; i < count; i += kReduceThreads) {
    const Point d = shiftOf(i);
    if (range.allows(d)) key = Least{}(key, keyOf(sums[i], d));
    bound += bounds[i];
  }
  key = reduceBlock(key, values, Least{});
  bound = reduceBlock(bound, values, Total{});
  constexpr int kMost = rg::motion::kMostReach;
  const Point best{static_cast<int>(key & 255) - kMost, static_cast<int>(key >> 8 & 255) - kMost};
  const auto bestSum = static_cast<uint32_t>(key >> 32);
  FoundShift& out = found[blockIdx.x];
  unsigned long long rival = UINT32_MAX, beaten = 0;
  for (int i = first; i < count; i += kReduceThreads) {
    const Point d = shiftOf(i);
    const int x = d.x - best.x + 1, y = d.y - best.y + 1;
    beaten += sums[i] < bestSum;
    if (x < 0 || x > 2 || y < 0 || y > 2)
      rival = Least{}(rival, static_cast<unsigned long long>(sums[i]));
    else
      out.sums[static_cast<size_t>(3 * y + x)] = sums[i];
  }
  rival = reduceBlock(rival, values, Least{});
  beaten = reduceBlock(beaten, values, Total{});
  if (first != 0) return;
  out.d = best;
  out.rival = static_cast<uint32_t>(rival);
  out.mean = static_cast<uint32_t>(bound / static_cast<unsigned long long>(count));
  out.isBeaten = beaten != 0;
}

}  // namespace

void padLuma(ImageView<const uint8_t> luma, const PaddedView& to, Stream stream) {
  const auto pixels = static_cast<double>(to.rows.size.area());
  start(launchOver("padLuma", to.rows.size, 1, {2 * pixels, 0}), stream, padRows, luma, to);
}

void padSmooth(ImageView<const uint8_t> luma, const PaddedView& to, Stream stream) {
  const auto pixels = static_cast<double>(to.rows.size.area());
  start(launchOver("padSmooth", to.rows.size, 1, {2 * pixels, 20 * pixels}), stream, padSmoothRows,
        luma, to);
}

void sumBoxes(const PaddedView& luma, const BoxesView& to, Stream stream) {
  const auto pixels = static_cast<double>(luma.rows.size.area());
  start(launchOver("sumBoxes", luma.rows.size, 1, {3 * pixels, 16 * pixels}), stream,
        sumBoxesOfPixels, luma, to);
}

void searchShifts(const MatchedRegions& regions, const SearchedPlanes& planes,
                  const ShiftRange& range, const ShiftSums& scratch, FoundShift* found,
                  Stream stream) {
  const int shifts = shiftsOf(range);
  // Of a region no more are matched than are enough, and a cell. Of four pixels: two loads, a
  // shift, a sum of differences, and as much for the loop; a quarter of it for the box.
  constexpr double kMostOfRegion =
      rg::motion::kEnoughPx + rg::motion::kCellSize * rg::motion::kCellSize;
  const double share = 1.0 / std::max(1, regions.count);
  const double pixels =
      std::min(kMostOfRegion, static_cast<double>(planes.luma.size.area()) * share);
  for (int first = 0; first < regions.count; first += scratch.regions) {
    const int count = std::min(scratch.regions, regions.count - first);
    const auto each = static_cast<double>(count);
    start({"sumShifts",
           {blocksFor(shifts, kReduceThreads), static_cast<unsigned>(count), 1},
           {kReduceThreads, 1, 1},
           {each * (4 * pixels + 8.0 * shifts), each * 2.5 * pixels * shifts}},
          stream, sumShifts, regions, first, planes, range, scratch);
    start({"chooseShifts",
           {static_cast<unsigned>(count), 1, 1},
           {kReduceThreads, 1, 1},
           {each * 12.0 * shifts, each * 12.0 * shifts}},
          stream, chooseShifts, regions, first, range, scratch, found + first);
  }
}

}  // namespace rg::gpu::motion
