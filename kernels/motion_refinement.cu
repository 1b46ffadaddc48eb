// SPDX-License-Identifier: LGPL-2.1-or-later
#include "kernels/matched_blocks.hpp"
#include "kernels/motion_refinement.hpp"
#include "kernels/start.hpp"
#include "kernels/threads.hpp"
#include "kernels/warp_runs.hpp"

#include <utility>

namespace rg::gpu::motion {
namespace {

using rg::motion::ConsensusSums;
using rg::motion::ConsensusSweep;
using rg::motion::FitMoments;
using rg::motion::FitStep;
using rg::motion::FitSums;
using rg::motion::kBlockWidth;
using rg::motion::kCellSize;
using rg::motion::kMoments;
using rg::motion::MatchedCell;
using rg::motion::MatchedPart;
using rg::motion::MotionBelief;
using rg::motion::MotionFit;
using rg::motion::MotionPrior;
using rg::motion::RefinedRegion;
using rg::motion::RegionMotion;
using rg::motion::SeenMotion;

/// Of a block: few, as the steps of a fit take many registers.
constexpr int kFitThreads = 128, kFitWarps = kFitThreads / kWarp;
static_assert(FitStep::piecesOf(0) <= kFitThreads && FitStep::piecesOf(1) <= kFitThreads);
constexpr int kBlocksInCell = 2 * kCellSize, kCellsInPart = rg::motion::kPartHeight / kCellSize;
/// Of a block of a cell a lane has half.
constexpr int kLanesOfBlock = kWarp / kBlocksInCell;
constexpr int kPixelsOfLane = kBlockWidth / kLanesOfBlock;
/// Moments that a lane sums up: that of its number, and that of 32 more.
static_assert(kMoments > kWarp && kMoments <= 2 * kWarp);
static_assert(sizeof(FitMoments) == kMoments * sizeof(int64_t));
/// A lane has a region's own vector, others those of its neighbours.
static_assert(rg::motion::kMostNeighbours < kWarp);

/// The sums of a lane's pixels of a cell that is displaced by d.
__device__ FitSums sumOwnPixels(const SeenPlane& plane, const MatchedCell& cell, Point d,
                                int limit) {
  FitSums sums;
  const auto lane = static_cast<int>(threadIdx.x % kWarp);
  const int block = lane / kLanesOfBlock, y = cell.y + block / 2;
  const ImageView<const uint8_t>& luma = plane.luma;
  if ((cell.blocks >> block & 1) == 0 || y == 0 || y == luma.height() - 1) return sums;
  const rg::motion::FitSampler sampler(d);
  const uint8_t *row = luma.row(y), *above = luma.row(y - 1), *below = luma.row(y + 1);
  const int reach = plane.previous.reach, upperRow = y + sampler.whole.y + reach;
  const uint8_t* upper = plane.previous.rows.row(upperRow);
  const uint8_t* lower = plane.previous.rows.row(upperRow + 1);
  const int first = cell.x + block % 2 * kBlockWidth + lane % kLanesOfBlock * kPixelsOfLane;
  for (int x = first; x < first + kPixelsOfLane; ++x) {
    if (x == 0 || x >= luma.width() - 1) continue;
    const int from = x + sampler.whole.x + reach;
    rg::motion::addFitPixel(
        row[x + 1] - row[x - 1], below[x] - above[x],
        row[x] * rg::motion::kFine - sampler.between(upper + from, lower + from), limit, sums);
  }
  return sums;
}

/// Of all lanes, in all of them.
__device__ void joinLanes(FitSums& sums) {
  const auto join = [](int32_t& value) { value = sumOfWarp(value); };
  join(sums.seen);
  join(sums.misfit);
  join(sums.pixels);
  join(sums.x);
  join(sums.y);
  join(sums.r);
  join(sums.xx);
  join(sums.xy);
  join(sums.yy);
  join(sums.xr);
  join(sums.yr);
  join(sums.rr);
}

/// rg::motion::sumMoments of the region that the block of threads has. A warp has every fourth cell
/// of it, a lane two of the moments: a thread that had all of them would leave room for few others.
__device__ void sumCells(const MatchedRegions& regions, const RefinedRegion& region,
                         const SeenPlane& plane, const MotionFit& fit, FitMoments& moments) {
  RG_SHARED(int64_t, values, kFitWarps * kMoments);
  const rg::motion::FitField field{fit.at, fit.slopes, region.centroid};
  const auto lane = static_cast<int>(threadIdx.x % kWarp),
             warp = static_cast<int>(threadIdx.x / kWarp);
  const uint32_t first = regions.starts[blockIdx.x];
  const auto count =
      static_cast<int>((regions.starts[blockIdx.x + 1] - first) * uint32_t{kCellsInPart});
  int64_t own = 0, second = 0;
  for (int i = warp; i < count; i += kFitWarps) {
    const MatchedPart& part = regions.parts[first + static_cast<uint32_t>(i / kCellsInPart)];
    const int row = i % kCellsInPart;
    const MatchedCell cell{part.x(), part.y() + row * kCellSize,
                           static_cast<uint16_t>(part.blocks >> (row * kBlocksInCell))};
    const Point offset = rg::motion::offsetOf(cell, field.centroid);
    const Point d = rg::motion::displacementAt(field, offset, plane.previous.reach);
    // The whole warp.
    if (cell.blocks == 0 || !rg::motion::isVisible(cell, d, plane.luma.size)) continue;
    FitSums sums = sumOwnPixels(plane, cell, d, region.limit);
    joinLanes(sums);
    own += rg::motion::momentOf(sums, offset, lane);
    if (lane + kWarp < kMoments) second += rg::motion::momentOf(sums, offset, lane + kWarp);
  }
  values[warp * kMoments + lane] = own;
  if (lane + kWarp < kMoments) values[warp * kMoments + lane + kWarp] = second;
  __syncthreads();
  static_assert(kMoments <= kFitThreads);
  const auto moment = static_cast<int>(threadIdx.x);
  if (moment >= kMoments) return;
  int64_t sum = 0;
  for (int i = 0; i < kFitWarps; ++i) sum += values[i * kMoments + moment];
  rg::motion::momentOf(moments, static_cast<size_t>(moment)) = sum;
}

/// What a block of threads fits.
struct OwnFit {
  const MatchedRegions& regions;
  const RefinedRegion& region;
  FitState& s;

  /// rg::motion::fitMotion from s.fit, which thread 0 has written, into s.fit. All threads must
  /// call.
  __device__ void run(const SeenPlane& plane, const MotionPrior& prior, int steps) const {
    if (threadIdx.x == 0) s.start = s.fit.at;
    __syncthreads();
    for (int i = 0; i < steps; ++i) {
      sumCells(regions, region, plane, s.fit, s.moments);
      __syncthreads();
      const FitStep step{s.moments, {s.start, plane.previous.reach}, prior, s.equations, s.fit};
      for (int part = 0; part < FitStep::kParts; ++part) {
        if (threadIdx.x < FitStep::piecesOf(part)) step.run(part, threadIdx.x);
        __syncthreads();
      }
      if (step.isSettled()) break;
    }
  }
  /// For thread 0.
  __device__ void beginAt(Point at) const {
    MotionFit start;
    start.at = at;
    s.fit = start;
  }
};

/// For thread 0.
__device__ void say(const SeenMotion& seen, const SeenMotions& out) {
  const int32_t trust = rg::motion::ownTrustOf(seen);
  out.own[blockIdx.x] = seen;
  out.ownTrust[blockIdx.x] = trust;
  out.beliefs[blockIdx.x] = {seen.at, trust};
  out.priors[blockIdx.x] = {};
}

/// A block of threads has a region.
__global__ void fitRegionsAlone(const __grid_constant__ RefinedRegions in,
                                const __grid_constant__ SeenPlanes planes,
                                const __grid_constant__ SeenMotions out) {
  const RefinedRegion& region = in.regions[blockIdx.x];
  const bool isFirst = threadIdx.x == 0;
  if (region.isFound == 0) {
    if (isFirst) say({}, out);
    return;
  }
  FitState& s = in.states[blockIdx.x];
  const OwnFit own{in.parts, region, s};
  if (isFirst) {
    own.beginAt(region.at);
    s.own = s.fit;
    s.known = -1;
    s.isSmooth = 0;
  }
  for (int smooth = 0; smooth < 2 && region.pixels > 0; ++smooth) {
    if (isFirst) own.beginAt(region.at);
    own.run(smooth == 0 ? planes.plain : planes.smooth, {}, rg::motion::kTrialSteps);
    if (!isFirst) continue;
    const int64_t least = rg::motion::leastInformation(s.fit.information);
    if (least <= s.known) continue;
    s.known = least;
    s.own = s.fit;
    s.isSmooth = static_cast<uint8_t>(smooth);
  }
  if (isFirst) say(rg::motion::seenMotion(s.own, region.reliability), out);
}

/// A warp has a region, a lane one of the vectors that it may come to: the one that is least at
/// odds with all, of equal ones the first.
__global__ void sweepRegions(const __grid_constant__ ConsensusSweep s, int count) {
  const int index = indexInGrid() / kWarp;
  if (index >= count) return;
  const auto region = static_cast<size_t>(index);
  const auto lane = threadIdx.x % kWarp;
  const uint32_t neighbours = s.counts[region];
  Point at = s.before[region].at;
  if (lane > 0 && lane <= neighbours) at = s.before[s.neighbour(region, lane - 1).region].at;
  int64_t least = lane <= neighbours ? rg::motion::disagreement(s, region, at) : INT64_MAX;
  auto best = static_cast<int>(lane);
  for (int i = kWarp / 2; i > 0; i /= 2) {
    const int64_t other = __shfl_xor_sync(kFullWarp, least, i);
    const int from = __shfl_xor_sync(kFullWarp, best, i);
    if (other > least || (other == least && from > best)) continue;
    least = other;
    best = from;
  }
  const Point centre{__shfl_sync(kFullWarp, at.x, best), __shfl_sync(kFullWarp, at.y, best)};
  ConsensusSums sums;
  if (lane < neighbours) rg::motion::addNeighbour(s, s.neighbour(region, lane), centre, sums);
  sums = {sumOfWarp(sums.weight), sumOfWarp(sums.x), sumOfWarp(sums.y)};
  if (lane == 0) rg::motion::conclude(s, region, centre, sums);
}

/// A block of threads has a region.
__global__ void fitRegionsTogether(const __grid_constant__ RefinedRegions in,
                                   const __grid_constant__ SeenPlanes planes,
                                   const MotionPrior* priors, RegionMotion* motion) {
  const RefinedRegion& region = in.regions[blockIdx.x];
  if (region.isFound == 0) return;
  FitState& s = in.states[blockIdx.x];
  const MotionPrior& prior = priors[blockIdx.x];
  const SeenPlane& plane = s.isSmooth == 0 ? planes.plain : planes.smooth;
  const OwnFit own{in.parts, region, s};
  const bool isFirst = threadIdx.x == 0;
  if (isFirst) s.fit = s.own;
  if (region.pixels > 0) {
    own.run(plane, prior, rg::motion::kOwnSteps);
    if (rg::motion::asksForFit(s.own, prior)) {
      if (isFirst) {
        s.mine = s.fit;
        own.beginAt(prior.at);
      }
      own.run(plane, prior, rg::motion::kPriorSteps);
      if (isFirst && !rg::motion::isTheirsBetter(s.own, s.mine, s.fit, prior, region.reliability))
        s.fit = s.mine;
    }
  }
  if (isFirst) rg::motion::takeOver(region, s.fit, prior, motion[blockIdx.x]);
}

constexpr double kBytesOfPixel = 2, kOperationsOfPixel = 60;

Launch overFits(const char* name, int count, int steps) {
  Launch launch = overRegions(name, count, kBytesOfPixel * steps, kOperationsOfPixel * steps);
  launch.block.x = kFitThreads;
  return launch;
}

}  // namespace

void fitAlone(const RefinedRegions& regions, const SeenPlanes& planes, const SeenMotions& out,
              Stream stream) {
  if (regions.parts.count == 0) return;
  start(overFits("fitAlone", regions.parts.count, 2 * rg::motion::kTrialSteps), stream,
        fitRegionsAlone, regions, planes, out);
}

void findConsensus(const NeighboursView& neighbours, const SeenMotions& seen, MotionBelief* scratch,
                   int regions, Stream stream) {
  constexpr double kBytes = 16 * rg::motion::kMostNeighbours, kOperations = 30;
  constexpr double kVisits = double{rg::motion::kMostNeighbours} * rg::motion::kMostNeighbours;
  if (regions == 0) return;
  const Launch launch = launchOverList("findConsensus", int64_t{regions} * kWarp,
                                       {kBytes * regions, kOperations * kVisits * regions});
  MotionBelief *before = seen.beliefs, *after = scratch;
  for (size_t i = 0; i < rg::motion::sweepsFor(static_cast<size_t>(regions)); ++i) {
    start(launch, stream, sweepRegions,
          ConsensusSweep{neighbours.starts, neighbours.counts, neighbours.list, seen.own,
                         seen.ownTrust, before, after, seen.priors},
          regions);
    std::swap(before, after);
  }
}

void fitTogether(const RefinedRegions& regions, const SeenPlanes& planes, const MotionPrior* priors,
                 RegionMotion* motion, Stream stream) {
  if (regions.parts.count == 0) return;
  start(
      overFits("fitTogether", regions.parts.count, rg::motion::kOwnSteps + rg::motion::kPriorSteps),
      stream, fitRegionsTogether, regions, planes, priors, motion);
}

}  // namespace rg::gpu::motion
