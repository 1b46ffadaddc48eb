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

__global__ void markPixels(const __grid_constant__ Planes picture,
                           const __grid_constant__ ModelView model,
                           rg::background::Tolerance tolerance, BitView mask, BitTarget restless,
                           BitTarget known) {
  const Point at = wordOfWarp();
  if (at.y >= mask.size.height) return;
  const uint64_t bits = lookedAt(mask.words.at(at.x, at.y), at.y);
  const uint64_t flipped = chooseBits(
      bits, at, [&](Point p) { return model.unrest.at(p.x, p.y) >= rg::background::kRestless; });
  const uint64_t alike = chooseBits(bits, at, [&](Point p) {
    const auto now = [&](int c) { return +picture.planes[c].at(p.x, p.y); };
    const int radius = rg::background::nearbyRadius(radiusAt(model, tolerance, now(0), p));
    return rg::background::isKnownNearby(
        p, model.size, model.channels, radius, now,
        [&](Point place, int sample, int c) { return +*model.sample(place, sample, c); });
  });
  if (threadIdx.x != 0) return;
  restless.words.at(at.x, at.y) = flipped;
  known.words.at(at.x, at.y) = alike;
}

__global__ void countPixels(SwayView scratch) {
  const WordOfThread word = wordOfThread(scratch.known.words.size);
  if (!word.isInside) return;
  const uint64_t restless = scratch.restless.words.at(word.at.x, word.at.y);
  const uint64_t known = scratch.known.words.at(word.at.x, word.at.y);
  forRunsIn(scratch.parts, word, [&](uint32_t run, uint64_t bits) {
    const auto add = [](uint32_t& sum, uint64_t some) {
      if (some != 0) atomicAdd(&sum, static_cast<uint32_t>(__popcll(some)));
    };
    rg::background::PartCount& part = scratch.counts[scratch.parts.runs[run].component];
    add(part.all, lookedAt(bits, word.at.y));
    add(part.restless, restless & bits);
    add(part.known, known & bits);
  });
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
  start(launchOverWords("markPixels", mask.size, {24 * words, 16 * words}), stream, markPixels,
        picture, model, tolerance, BitView(mask), scratch.restless, scratch.known);
  findComponents(mask, true, Connectivity::Eight, scratch.parts, stream);
  start(overWords("forgetParts", mask, 4), stream, forgetParts<rg::background::PartCount>,
        mask.words.size, scratch.parts, scratch.counts);
  start(overWords("countPixels", mask, 20), stream, countPixels, scratch);
  start(overWords("dropSwaying", mask, 8), stream, changeParts<Sways>, mask, false,
        Sways{scratch.counts}, scratch.parts);
}

}  // namespace rg::gpu::background
