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

__global__ void markSwaying(const __grid_constant__ Planes picture,
                            const __grid_constant__ ModelView model,
                            rg::background::Tolerance tolerance, BitView mask, BitTarget out) {
  const Point at = wordOfWarp();
  if (at.y >= mask.size.height) return;
  const uint64_t bits = lookedAt(mask.words.at(at.x, at.y), at.y);
  const uint64_t swaying = chooseBits(bits, at, [&](Point p) {
    if (model.unrest.at(p.x, p.y) < rg::background::kRestless) return false;
    const auto now = [&](int c) { return +picture.planes[c].at(p.x, p.y); };
    return rg::background::isKnownNearby(
        p, model.size, model.channels, radiusAt(model, tolerance, now(0), p), now,
        [&](Point place, int sample, int c) { return +*model.sample(place, sample, c); });
  });
  if (threadIdx.x == 0) out.words.at(at.x, at.y) = swaying;
}

/// The area is not needed: it becomes the weight.
__global__ void weighParts(BitView swaying, ComponentsView found) {
  const WordOfThread word = wordOfThread(swaying.words.size);
  if (!word.isInside) return;
  const uint64_t columns = swaying.words.at(word.at.x, word.at.y);
  forRunsIn(found, word, [&](uint32_t run, uint64_t bits) {
    const auto count = [](uint64_t some) { return static_cast<uint32_t>(__popcll(some)); };
    const uint32_t weight =
        rg::background::weightOf(count(lookedAt(bits, word.at.y)), count(columns & bits));
    atomicAdd(&found.list[found.runs[run].component].areaPx, weight - count(bits));
  });
}

struct Sways {
  __device__ bool operator()(const ComponentsView& found, uint32_t part) const {
    return rg::background::sways(found.list[part].areaPx);
  }
};

}  // namespace

void dropSwaying(const Planes& picture, const ModelView& model,
                 const rg::background::Tolerance& tolerance, const SwayView& scratch,
                 const BitTarget& mask, Stream stream) {
  const double words = static_cast<double>(mask.words.size.area());
  start(launchOverWords("markSwaying", mask.size, {24 * words, 16 * words}), stream, markSwaying,
        picture, model, tolerance, BitView(mask), scratch.swaying);
  findComponents(mask, true, Connectivity::Eight, scratch.parts, stream);
  start(overWords("weighParts", mask, 12), stream, weighParts, BitView(scratch.swaying),
        scratch.parts);
  start(overWords("dropSwaying", mask, 8), stream, changeParts<Sways>, mask, false, Sways{},
        scratch.parts);
}

}  // namespace rg::gpu::background
