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

/// Neighbouring columns of one row of shifts: their pixels lie in two words.
constexpr int kShiftsOfThread = 4;

struct Sums {
  uint32_t sums[kShiftsOfThread] = {}, bounds[kShiftsOfThread] = {};
};

/// How many columns before a range's first one the padded row's last boundary of four lies.
[[nodiscard]] constexpr int columnsAhead(int rowsReach, int reach) {
  return (rowsReach - reach) % kShiftsOfThread;
}
[[nodiscard]] constexpr int groupsInRow(int rowsReach, int reach) {
  return (2 * reach + columnsAhead(rowsReach, reach) + kShiftsOfThread) / kShiftsOfThread;
}
static_assert(groupsInRow(4, 4) == 3 && groupsInRow(6, 4) == 3 && groupsInRow(8, 5) == 4);

/// What a thread sums up: four shifts of one region. `by`: from a pixel to that of the first of
/// them in the padded rows.
struct ShiftedParts {
  const SearchedPlanes& planes;
  Point by;

  /// Adds a block of 4x1 pixels, which lies on a boundary of four, as the shifts do.
  __device__ void addBlock(unsigned now, int x, int y, Sums& to) const {
    const uint8_t* before = planes.previous.rows.row(y + by.y) + x + by.x;
    const unsigned low = loadQuad(before), high = loadQuad(before + 4);
    for (unsigned i = 0; i < kShiftsOfThread; ++i)
      to.sums[i] += __vsadu4(now, __funnelshift_r(low, high, 8 * i));
  }
  /// Adds a box of 4x4 pixels, of which the sum is `now`.
  __device__ void addBox(unsigned now, int x, int y, Sums& to) const {
    const auto* before =
        reinterpret_cast<const uint8_t*>(planes.boxes.rows.row(y + by.y) + x + by.x);
    const unsigned pairs[] = {loadQuad(before), loadQuad(before + 4)};
    for (unsigned i = 0; i < kShiftsOfThread; ++i)
      to.bounds[i] += static_cast<uint32_t>(absDiff(
          static_cast<int>(now), static_cast<int>(pairs[i / 2] >> (16 * (i % 2)) & 0xFFFF)));
  }
};

/// Boxes are as many as fit below each other into each run of blocks, as rg::motion::forBoxes has
/// them.
__device__ void addHalf(const MatchedPart& part, int half, const ShiftedParts& shifted,
                        Sums& sums) {
  const int x = part.x() + half * kBlockWidth;
  unsigned box = 0;
  for (int row = 0, run = 0; row < kPartHeight; ++row) {
    if ((part.blocks >> (2 * row + half) & 1) == 0) {
      run = 0;
      continue;
    }
    const int y = part.y() + row;
    const unsigned now = loadQuad(shifted.planes.luma.row(y) + x);
    shifted.addBlock(now, x, y, sums);
    box = (run == 0 ? 0 : box) + __vsadu4(now, 0);
    if (++run < kBoxSide) continue;
    shifted.addBox(box, x, y - kBoxSide + 1, sums);
    run = 0;
  }
}

__device__ ShiftRange rangeOf(const MatchedRegions& regions, int region, const ShiftRange& most) {
  const bool isStill = regions.still != nullptr && regions.still[region] != 0;
  return isStill ? ShiftRange{rg::motion::kStillRange.maxShift, rg::motion::kStillRange.reach}
                 : most;
}

/// A thread for four shifts; neighbours in a warp see neighbouring words.
__global__ void sumShifts(const __grid_constant__ MatchedRegions regions, int firstRegion,
                          const __grid_constant__ SearchedPlanes planes, ShiftRange most,
                          ShiftSums out) {
  const int region = firstRegion + static_cast<int>(blockIdx.y);
  const int reach = rangeOf(regions, region, most).reach, rowsReach = planes.previous.reach;
  const int side = 2 * reach + 1, groups = groupsInRow(rowsReach, reach);
  const int group = indexInGrid() % groups, row = indexInGrid() / groups;
  if (row >= side) return;
  const int column = group * kShiftsOfThread - columnsAhead(rowsReach, reach);
  const ShiftedParts shifted{planes,
                             {rowsReach - reach + column, rowsReach - reach + side - 1 - row}};
  Sums sums;
  for (uint32_t i = regions.starts[region]; i < regions.starts[region + 1]; ++i)
    for (int half = 0; half < 2; ++half) addHalf(regions.parts[i], half, shifted, sums);
  // To the right in the previous picture is a shift further to the left.
  const int first = static_cast<int>(blockIdx.y) * shiftsOf(most) + row * side + side - 1 - column;
  for (int i = 0; i < kShiftsOfThread; ++i) {
    if (column + i < 0 || column + i >= side) continue;
    out.sums[first - i] = sums.sums[i];
    out.bounds[first - i] = sums.bounds[i];
  }
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
  const int reach = range.reach, rowsReach = planes.previous.reach;
  // Of a region no more are matched than are enough, and a cell. Of four pixels and four shifts:
  // three loads, three shifts, four sums of differences, and as much for the loop and the box.
  constexpr double kMostOfRegion =
      rg::motion::kEnoughPx + rg::motion::kCellSize * rg::motion::kCellSize;
  const double share = 1.0 / std::max(1, regions.count);
  const double pixels =
      std::min(kMostOfRegion, static_cast<double>(planes.luma.size.area()) * share);
  for (int first = 0; first < regions.count; first += scratch.regions) {
    const int count = std::min(scratch.regions, regions.count - first);
    const auto each = static_cast<double>(count);
    start({"sumShifts",
           {blocksFor(int64_t{2 * reach + 1} * groupsInRow(rowsReach, reach), kReduceThreads),
            static_cast<unsigned>(count), 1},
           {kReduceThreads, 1, 1},
           {each * (4 * pixels + 8.0 * shifts), each * 1.25 * pixels * shifts}},
          stream, sumShifts, regions, first, planes, range, scratch);
    start({"chooseShifts",
           {static_cast<unsigned>(count), 1, 1},
           {kReduceThreads, 1, 1},
           {each * 12.0 * shifts, each * 12.0 * shifts}},
          stream, chooseShifts, regions, first, range, scratch, found + first);
  }
}

}  // namespace rg::gpu::motion
