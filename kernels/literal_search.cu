// SPDX-License-Identifier: LGPL-2.1-or-later
#include "kernels/block_reduce.hpp"
#include "kernels/literal_search.hpp"
#include "kernels/start.hpp"
#include "kernels/threads.hpp"
#include "kernels/warp_runs.hpp"

namespace rg::gpu::motion {
namespace {

using rg::motion::FoundShift;
using rg::motion::GradientSums;
using rg::motion::RegionMotion;
using rg::motion::ShiftRange;

constexpr int kChunkPx = 2048;

/// |a − b| of the pixels of a run, four at a time.
__device__ uint32_t differenceOf(const uint8_t* a, const uint8_t* b, int count) {
  uint32_t sum = 0;
  int i = 0;
  for (; i + 4 <= count; i += 4) sum += __vsadu4(loadQuadAnywhere(a + i), loadQuadAnywhere(b + i));
  if (i == count) return sum;
  const unsigned rest = (1u << (8 * (count - i))) - 1;
  return sum + __vsadu4(loadQuadAnywhere(a + i) & rest, loadQuadAnywhere(b + i) & rest);
}

/// A thread has a shift, a block 256 of them, of one chunk.
__global__ void sumChunks(const Run* runs, const LiteralChunk* chunks, int firstRegion,
                          ImageView<const uint8_t> luma,
                          const __grid_constant__ PaddedView previous, int reach,
                          unsigned long long* sums) {
  const LiteralChunk chunk = chunks[blockIdx.x];
  const int side = 2 * reach + 1;
  const int shift = static_cast<int>(blockIdx.y * blockDim.x + threadIdx.x);
  if (shift >= side * side) return;
  const int toX = shift % side - reach + previous.reach,
            toY = shift / side - reach + previous.reach;
  unsigned long long sum = 0;
  for (uint32_t i = chunk.firstRun; i < chunk.lastRun; ++i) {
    const Run run = runs[i];
    sum += differenceOf(luma.row(run.y) + run.begin,
                        previous.rows.row(run.y + toY) + run.begin + toX, run.end - run.begin);
  }
  const auto region = static_cast<ptrdiff_t>(chunk.region) - firstRegion;
  atomicAdd(sums + region * side * side + shift, sum);
}

/// A block has a chunk, a warp every eighth run of it. Pixels at the frame's edge have no gradient.
__global__ void sumGradientsOfChunks(const Run* runs, const LiteralChunk* chunks,
                                     ImageView<const uint8_t> luma, GradientSums* sums) {
  RG_SHARED(int64_t, values, kReduceWarps);
  const LiteralChunk chunk = chunks[blockIdx.x];
  const auto lane = static_cast<int>(threadIdx.x % kWarp);
  int64_t xx = 0, xy = 0, yy = 0, pixels = 0;
  for (uint32_t i = chunk.firstRun + threadIdx.x / kWarp; i < chunk.lastRun; i += kReduceWarps) {
    const Run run = runs[i];
    if (lane == 0) pixels += run.end - run.begin;
    if (run.y == 0 || run.y + 1 == luma.height()) continue;
    const uint8_t *above = luma.row(run.y - 1), *row = luma.row(run.y),
                  *below = luma.row(run.y + 1);
    const int first = run.begin > 1 ? run.begin : 1;
    const int end = run.end < luma.width() - 1 ? run.end : luma.width() - 1;
    for (int x = first + lane; x < end; x += kWarp) {
      const int dx = row[x + 1] - row[x - 1], dy = below[x] - above[x];
      xx += dx * dx;
      xy += dx * dy;
      yy += dy * dy;
    }
  }
  xx = reduceBlock(xx, values, Total{});
  xy = reduceBlock(xy, values, Total{});
  yy = reduceBlock(yy, values, Total{});
  pixels = reduceBlock(pixels, values, Total{});
  if (threadIdx.x != 0) return;
  GradientSums& to = sums[chunk.region];
  addSum(to.xx, static_cast<uint64_t>(xx));
  addSum(to.xy, static_cast<uint64_t>(xy));
  addSum(to.yy, static_cast<uint64_t>(yy));
  addSum(to.pixels, static_cast<uint64_t>(pixels));
}

/// Smallest (sum, |d|², d.y, d.x): the sum of 2^26 pixels is below 2^34, |d|² below 2^14, and the
/// rest fits a byte each.
__device__ unsigned long long keyOf(unsigned long long sum, Point d) {
  constexpr int kMost = rg::motion::kMostReach;
  const auto length = static_cast<uint32_t>(d.x * d.x + d.y * d.y);
  const uint32_t rank =
      length << 16 | static_cast<uint32_t>(d.y + kMost) << 8 | static_cast<uint32_t>(d.x + kMost);
  return sum << 30 | rank;
}

/// A block for each region: the shift, what is round it, and what that says.
__global__ void judgeShifts(const unsigned long long* allSums, int firstRegion, ShiftRange range,
                            const GradientSums* gradients, RegionMotion* motion) {
  RG_SHARED(unsigned long long, values, kReduceWarps);
  RG_SHARED(uint32_t, around, 9);
  const int side = 2 * range.reach + 1, count = side * side;
  const unsigned long long* sums = allSums + static_cast<ptrdiff_t>(blockIdx.x) * count;
  const auto first = static_cast<int>(threadIdx.x);
  const auto shiftOf = [&](int i) { return Point{range.reach - i % side, range.reach - i / side}; };
  unsigned long long key = ~0ull, total = 0;
  for (int i = first; i < count; i += kReduceThreads) {
    const Point d = shiftOf(i);
    if (range.allows(d)) key = Least{}(key, keyOf(sums[i], d));
    total += sums[i];
  }
  key = reduceBlock(key, values, Least{});
  total = reduceBlock(total, values, Total{});
  constexpr int kMost = rg::motion::kMostReach;
  const Point best{static_cast<int>(key & 255) - kMost, static_cast<int>(key >> 8 & 255) - kMost};
  const unsigned long long bestSum = key >> 30;
  const GradientSums own = gradients[firstRegion + static_cast<int>(blockIdx.x)];
  const int scale = rg::motion::literalScale(own.pixels);
  unsigned long long rival = UINT32_MAX, beaten = 0;
  for (int i = first; i < count; i += kReduceThreads) {
    const Point d = shiftOf(i);
    const int x = d.x - best.x + 1, y = d.y - best.y + 1;
    const auto told = static_cast<uint32_t>(sums[i] >> scale);
    beaten += sums[i] < bestSum;
    if (x < 0 || x > 2 || y < 0 || y > 2)
      rival = Least{}(rival, static_cast<unsigned long long>(told));
    else
      around[3 * y + x] = told;
  }
  rival = reduceBlock(rival, values, Least{});
  beaten = reduceBlock(beaten, values, Total{});
  if (first != 0) return;
  FoundShift found;
  found.d = best;
  for (int i = 0; i < 9; ++i) found.sums[static_cast<size_t>(i)] = around[i];
  found.rival = static_cast<uint32_t>(rival);
  found.mean = static_cast<uint32_t>(total / static_cast<unsigned long long>(count) >> scale);
  found.isBeaten = beaten != 0;
  RegionMotion estimate = rg::motion::estimateMotion(found, rg::motion::scaled(own, scale));
  estimate.sad = bestSum;
  motion[firstRegion + static_cast<int>(blockIdx.x)] = estimate;
}

}  // namespace

void LiteralList::build(std::span<const Run> runs, std::span<const uint32_t> runStarts) {
  chunks.clear();
  starts.assign(1, 0);
  for (uint32_t region = 0; region + 1 < runStarts.size(); ++region) {
    int pixels = kChunkPx;  // The first run begins a chunk.
    for (uint32_t i = runStarts[region]; i < runStarts[region + 1]; ++i) {
      if (pixels >= kChunkPx) {
        chunks.push_back({region, i, i});
        pixels = 0;
      }
      chunks.back().lastRun = i + 1;
      pixels += runs[i].end - runs[i].begin;
    }
    starts.push_back(static_cast<uint32_t>(chunks.size()));
  }
}

void sumAllShifts(const LiteralRegions& regions, RegionSpan of, ImageView<const uint8_t> luma,
                  const PaddedView& previous, int reach, unsigned long long* sums, Stream stream) {
  const int shifts = shiftsOf({reach, reach});
  const uint32_t first = regions.list.starts[static_cast<size_t>(of.first)];
  const uint32_t last = regions.list.starts[static_cast<size_t>(of.first + of.count)];
  clear(sums, static_cast<size_t>(of.count) * static_cast<size_t>(shifts) * sizeof *sums, stream);
  if (first == last) return;
  const double pixels = static_cast<double>(last - first) * kChunkPx;
  start({"sumAllShifts",
         {last - first, blocksFor(shifts, kReduceThreads), 1},
         {kReduceThreads, 1, 1},
         {2 * pixels + 8.0 * shifts * of.count, 2.5 * pixels * shifts}},
        stream, sumChunks, regions.runs, regions.chunks + first, of.first, luma, previous, reach,
        sums);
}

void matchAllPixels(const LiteralRegions& regions, ImageView<const uint8_t> luma,
                    const PaddedView& previous, const ShiftRange& range, const LiteralSums& scratch,
                    RegionMotion* motion, Stream stream) {
  const auto chunks = static_cast<unsigned>(regions.list.chunks.size());
  clear(scratch.gradients, static_cast<size_t>(regions.count()) * sizeof *scratch.gradients,
        stream);
  if (chunks > 0)
    start({"sumRunGradients",
           {chunks, 1, 1},
           {kReduceThreads, 1, 1},
           {3.0 * kChunkPx * chunks, 12.0 * kChunkPx * chunks}},
          stream, sumGradientsOfChunks, regions.runs, regions.chunks, luma, scratch.gradients);
  for (int first = 0; first < regions.count(); first += scratch.regions) {
    const int count = std::min(scratch.regions, regions.count() - first);
    const double each = 12.0 * shiftsOf(range) * count;
    sumAllShifts(regions, {first, count}, luma, previous, range.reach, scratch.sums, stream);
    start({"matchAllPixels",
           {static_cast<unsigned>(count), 1, 1},
           {kReduceThreads, 1, 1},
           {each, each}},
          stream, judgeShifts, scratch.sums, first, range, scratch.gradients, motion);
  }
}

}  // namespace rg::gpu::motion
