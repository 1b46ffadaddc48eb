// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/ghosts/sway.hpp"
#include "kernels/model_pixels.hpp"
#include "kernels/start.hpp"
#include "kernels/swaying_parts.hpp"
#include "kernels/threads.hpp"
#include "kernels/word_runs.hpp"

namespace rg::gpu::background {
namespace {

/// The pixels that are looked at.
constexpr uint64_t lookedAt(uint64_t columns, int row) {
  return rg::background::isLookedAt(row) ? columns & rg::background::kLookedAtColumns : 0;
}

__global__ void markRestless(const __grid_constant__ ModelView model, BitView mask,
                             BitTarget restless) {
  const Point at = wordOfWarp();
  if (at.y >= mask.size.height) return;
  const uint64_t bits = lookedAt(mask.words.at(at.x, at.y), at.y);
  const uint64_t flipped = chooseBits(
      bits, at, [&](Point p) { return model.unrest.at(p.x, p.y) >= rg::background::kRestless; });
  if (threadIdx.x == 0) restless.words.at(at.x, at.y) = flipped;
}

__device__ void addPixels(uint32_t& sum, uint64_t bits) {
  if (bits != 0) atomicAdd(&sum, static_cast<uint32_t>(__popcll(bits)));
}

__global__ void countRestless(SwayView scratch) {
  const WordOfThread word = wordOfThread(scratch.restless.words.size);
  if (!word.isInside) return;
  const uint64_t restless = scratch.restless.words.at(word.at.x, word.at.y);
  forRunsIn(scratch.parts, word, [&](uint32_t run, uint64_t bits) {
    rg::background::PartCount& part = scratch.counts[scratch.parts.runs[run].component];
    addPixels(part.all, lookedAt(bits, word.at.y));
    addPixels(part.restless, restless & bits);
  });
}

/// Only of parts that are restless: few pixels are looked at closely. A warp has a word.
__global__ void countKnown(const __grid_constant__ Planes picture,
                           const __grid_constant__ ModelView model,
                           rg::background::Tolerance tolerance, SwayView scratch) {
  const Point at = wordOfWarp();
  const Size words = scratch.restless.words.size;
  if (at.y >= words.height) return;
  const WordOfThread word{at.y * words.width + at.x, at, true};
  const auto partOf = [&](uint32_t run) -> rg::background::PartCount& {
    return scratch.counts[scratch.parts.runs[run].component];
  };
  uint64_t asked = 0;
  forRunsIn(scratch.parts, word, [&](uint32_t run, uint64_t bits) {
    if (rg::background::isRestless(partOf(run))) asked |= lookedAt(bits, at.y);
  });
  if (asked == 0) return;
  const uint64_t known = chooseBits(asked, at, [&](Point p) {
    const auto now = [&](int c) { return +picture.planes[c].at(p.x, p.y); };
    const int radius = rg::background::nearbyRadius(radiusAt(model, tolerance, now(0), p));
    return rg::background::isKnownNearby(
        p, model.size, model.channels, radius, now,
        [&](Point place, int sample, int c) { return +*model.sample(place, sample, c); });
  });
  if (threadIdx.x != 0) return;
  forRunsIn(scratch.parts, word,
            [&](uint32_t run, uint64_t bits) { addPixels(partOf(run).known, known & bits); });
}

struct Sways {
  const rg::background::PartCount* counts;
  __device__ bool operator()(const ComponentsView&, uint32_t part) const {
    return rg::background::sways(counts[part]);
  }
};

}  // namespace

void dropSwaying(const Planes& picture, const ModelView& model,
                 const rg::background::Tolerance& tolerance, const SwayView& scratch,
                 const BitTarget& mask, Stream stream) {
  const double words = static_cast<double>(mask.words.size.area());
  start(launchOverWords("markRestless", mask.size, {16 * words, 8 * words}), stream, markRestless,
        model, BitView(mask), scratch.restless);
  findComponents(mask, true, Connectivity::Eight, scratch.parts, stream);
  start(overWords("forgetParts", mask, 4), stream, forgetParts<rg::background::PartCount>,
        mask.words.size, scratch.parts, scratch.counts);
  start(overWords("countRestless", mask, 12), stream, countRestless, scratch);
  start(launchOverWords("countKnown", mask.size, {12 * words, 8 * words}), stream, countKnown,
        picture, model, tolerance, scratch);
  start(overWords("dropSwaying", mask, 8), stream, changeParts<Sways>, mask, false,
        Sways{scratch.counts}, scratch.parts);
}

}  // namespace rg::gpu::background
