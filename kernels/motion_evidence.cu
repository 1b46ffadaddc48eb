// SPDX-License-Identifier: LGPL-2.1-or-later
#include "kernels/motion_evidence.hpp"
#include "kernels/start.hpp"
#include "kernels/threads.hpp"
#include "kernels/warp_runs.hpp"

namespace rg::gpu::objects {
namespace {

using rg::objects::kEvidenceStep;

/// What the sample of pixel p takes over.
__device__ int16_t carriedTo(Point p, const rg::motion::RegionMotion& m, const KnownView& known) {
  const Point from = rg::objects::cameFrom(p, m);
  if (!boundsOf(known.luma.size).contains(from)) return 0;
  const Point sample = rg::objects::sampleAt(from, known.gains.size);
  const Point nearest = rg::objects::pixelOf(sample);
  const uint8_t shown = known.previous.at(from.x, from.y);
  if (!rg::objects::showsTheSame(known.luma.at(p.x, p.y), shown) ||
      !rg::objects::showsTheSame(shown, known.previous.at(nearest.x, nearest.y)))
    return 0;
  return rg::objects::fadedGain(known.gains.at(sample.x, sample.y), known.left);
}

__global__ void carrySamples(const __grid_constant__ KnownView known,
                             const __grid_constant__ CarriedView carried) {
  const Point at = pixelOfThread();
  const bool isInside = isWithin(at, carried.gains.size);
  const Point p = rg::objects::pixelOf(at);
  const uint32_t label = isInside ? known.labels.at(p.x, p.y) : 0;
  const int16_t gain = label == 0 ? int16_t{0} : carriedTo(p, known.motions[label - 1], known);
  if (isInside) carried.gains.at(at.x, at.y) = gain;
  const LaneRun run = runOfLane(label);
  const uint32_t sum = sumOfRun(run, static_cast<uint32_t>(gain));
  if (label == 0 || !run.isLast) return;
  if (sum != 0) addSum(carried.sums[label - 1], sum);
  atomicAdd(carried.samples + (label - 1), static_cast<uint32_t>(run.before) + 1);
}

__global__ void addGains(ImageView<const uint16_t> labels, const int16_t* density,
                         ImageView<const int16_t> gains, ImageView<int16_t> sum) {
  const Point at = pixelOfThread();
  if (!isWithin(at, sum.size)) return;
  const uint32_t label = labels.at(at.x * kEvidenceStep, at.y * kEvidenceStep);
  const int16_t gain = gains.at(at.x, at.y);
  sum.at(at.x, at.y) = label == 0 ? gain : rg::objects::gainWith(gain, density[label - 1]);
}

}  // namespace

void carryEvidence(const KnownView& known, const CarriedView& carried, Stream stream) {
  const auto samples = static_cast<double>(carried.gains.size.area());
  const auto count = static_cast<size_t>(known.count);
  clear(carried.sums, count * sizeof(int64_t), stream);
  clear(carried.samples, count * sizeof(uint32_t), stream);
  // A sample's byte costs a sector of 32.
  start(launchOver("carrySamples", carried.gains.size, 1, {132 * samples, 70 * samples}), stream,
        carrySamples, known, carried);
}

void addEvidence(ImageView<const uint16_t> labels, const int16_t* density,
                 ImageView<const int16_t> gains, ImageView<int16_t> sum, Stream stream) {
  const auto samples = static_cast<double>(sum.size.area());
  start(launchOver("addGains", sum.size, 1, {12 * samples, 8 * samples}), stream, addGains, labels,
        density, gains, sum);
}

}  // namespace rg::gpu::objects
