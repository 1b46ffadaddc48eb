// SPDX-License-Identifier: LGPL-2.1-or-later
// Distances are taken again where they are needed, which costs less than to keep them.
#include "core/base/pixel.hpp"
#include "core/simd/segmentation/link_rows.hpp"
#include "kernels/colour_cells.hpp"
#include "kernels/hue_of.hpp"
#include "kernels/start.hpp"
#include "kernels/threads.hpp"

namespace rg::gpu::segmentation {
namespace {

using namespace rg::segmentation;

struct LinkJob {
  Planes compared;  ///< The picture's colours, or its saturations and values.
  bool hasHues;     ///< There is a picture's hue to guard by, and in HSV to compare.
  bool isByHsv;
  ImageView<const uint8_t> scope;
  const HueBand* band;
  int similarity;
  LinkTargets out;
};

/// Hues with kInBand, as core's findHueRow gives them.
__global__ void findHues(const __grid_constant__ Planes colours,
                         const __grid_constant__ LinkJob job) {
  const Point p = pixelOfThread();
  if (!isWithin(p, colours.size())) return;
  if (job.band->count == 0 && !job.isByHsv) return;
  const int hue = hueAt(colours, p);
  const bool isInBand = hue != kAchromatic && job.band->contains(hue);
  job.out.hues.at(p.x, p.y) = static_cast<int16_t>(isInBand ? hue | simd::kInBand : hue);
}

__global__ void findSaturations(const __grid_constant__ Planes colours,
                                const __grid_constant__ PlaneTargets hsv) {
  const Point p = pixelOfThread();
  if (!isWithin(p, colours.size())) return;
  const auto level = [&](int c) { return int{colours.planes[c].at(p.x, p.y)}; };
  hsv.planes[0].at(p.x, p.y) = static_cast<uint8_t>(saturationOf(level(0), level(1), level(2)));
  hsv.planes[1].at(p.x, p.y) = static_cast<uint8_t>(valueOf(level(0), level(1), level(2)));
}

/// Both have a hue, one of them in the band, and these lie apart.
__device__ bool isGuarded(int a, int b) {
  if (a < 0 || b < 0 || ((a ^ b) & simd::kInBand) == 0) return false;
  return hueDistance(a & (simd::kInBand - 1), b & (simd::kInBand - 1)) > kHueGuard;
}

/// Of hues with kInBand.
__device__ int stepBetween(int a, int b) {
  const auto hueOnly = [](int hue) { return hue < 0 ? hue : hue & (simd::kInBand - 1); };
  return hueStep(hueOnly(a), hueOnly(b));
}

__device__ int distanceOf(const LinkJob& job, Point p, Point q) {
  if (!boundsOf(job.compared.size()).contains(q)) return kNoPair;
  if (job.scope.data != nullptr &&
      (!isInScope(job.scope, p) || job.scope.at(p.x, p.y) != job.scope.at(q.x, q.y)))
    return kNoPair;
  int most = 0;
  for (int c = 0; c < job.compared.channels; ++c) {
    const ImageView<const uint8_t>& plane = job.compared.planes[c];
    most = std::max(most, absDiff(plane.at(p.x, p.y), plane.at(q.x, q.y)));
  }
  if (!job.hasHues || (job.band->count == 0 && !job.isByHsv))
    return most > kFarthest ? int{kFarthest} : most;
  const int a = job.out.hues.at(p.x, p.y), b = job.out.hues.at(q.x, q.y);
  if (job.isByHsv) most = std::max(most, stepBetween(a, b));
  return isGuarded(a, b) || most > kFarthest ? int{kFarthest} : most;
}

/// Of equal ones up, left, right, down.
__global__ void chooseNearest(const __grid_constant__ LinkJob job) {
  const Point p = pixelOfThread();
  if (!isWithin(p, job.compared.size())) return;
  int least = kNoPair;
  uint8_t nearest = simd::kNearestNone;
  const auto consider = [&](Point q, uint8_t name) {
    const int distance = distanceOf(job, p, q);
    if (distance >= least) return;
    least = distance;
    nearest = name;
  };
  consider({p.x, p.y - 1}, simd::kNearestUp);
  consider({p.x - 1, p.y}, simd::kNearestLeft);
  consider({p.x + 1, p.y}, simd::kNearestRight);
  consider({p.x, p.y + 1}, simd::kNearestDown);
  job.out.nearest.at(p.x, p.y) = nearest;
}

__global__ void linkPixels(const __grid_constant__ LinkJob job, bool joinsSingles) {
  const Point p = pixelOfThread();
  if (!isWithin(p, job.compared.size())) return;
  uint8_t& links = job.out.links.at(p.x, p.y);
  links = 0;
  if (!isInScope(job.scope, p)) return;
  const Point left{p.x - 1, p.y}, up{p.x, p.y - 1};
  const auto isLinked = [&](Point q, uint8_t mine, uint8_t its) {
    const int distance = distanceOf(job, p, q);
    if (distance == kNoPair) return false;
    return distance <= job.similarity || (joinsSingles && (job.out.nearest.at(p.x, p.y) == mine ||
                                                           job.out.nearest.at(q.x, q.y) == its));
  };
  int bits = kIsPixel;
  if (isLinked(left, simd::kNearestLeft, simd::kNearestRight)) bits |= kLinkedLeft;
  if (isLinked(up, simd::kNearestUp, simd::kNearestDown)) bits |= kLinkedUp;
  links = static_cast<uint8_t>(bits);
}

}  // namespace

void linkColours(const Planes& colours, ImageView<const uint8_t> scope, const LinkParams& params,
                 const HueBand* band, const LinkTargets& out, Stream stream) {
  const bool hasHues = colours.channels == 3;
  const bool isByHsv = hasHues && params.space == ColourSpace::Hsv;
  const Planes hsv{{out.hsv.planes[0], out.hsv.planes[1]}, 2};
  const int similarity = std::clamp(params.similarity, 0, int{kFarthest});
  const LinkJob job{isByHsv ? hsv : colours, hasHues, isByHsv, scope, band, similarity, out};
  const Size size = colours.size();
  const auto pixels = static_cast<double>(size.area());
  const double bytes = pixels * colours.channels;
  if (hasHues)
    start(launchOver("findHues", size, 1, {bytes + 2 * pixels, 30 * pixels}), stream, findHues,
          colours, job);
  if (isByHsv)
    start(launchOver("findSaturations", size, 1, {bytes + 2 * pixels, 20 * pixels}), stream,
          findSaturations, colours, out.hsv);
  if (params.joinsSingles)
    start(launchOver("chooseNearest", size, 1, {bytes + pixels, 12 * bytes}), stream, chooseNearest,
          job);
  start(launchOver("linkColours", size, 1, {bytes + 2 * pixels, 8 * bytes}), stream, linkPixels,
        job, params.joinsSingles);
}

}  // namespace rg::gpu::segmentation
