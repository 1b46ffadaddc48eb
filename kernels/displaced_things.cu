// SPDX-License-Identifier: LGPL-2.1-or-later
#include "kernels/block_reduce.hpp"
#include "kernels/displaced_things.hpp"
#include "kernels/start.hpp"
#include "kernels/word_runs.hpp"

namespace rg::gpu::background {
namespace {

using rg::background::kColours;
using rg::background::kMostDisplaced;

constexpr uint32_t kNotLookedAt = ~uint32_t{0};

__global__ void countStill(BitView foreground, ImageView<const uint16_t> ages, int leastAge,
                           ComponentsView parts, uint32_t* stillPx) {
  const WordOfThread word = wordOfThread(foreground.words.size);
  if (!word.isInside) return;
  forRunsIn(parts, word, [&](uint32_t run, uint64_t bits) {
    uint32_t count = 0;
    forBits(bits, word.at.x * kWordColumns,
            [&](int x) { count += ages.at(x, word.at.y) >= leastAge; });
    if (count != 0) atomicAdd(stillPx + parts.runs[run].component, count);
  });
}

/// One block: the first parts in raster order that are still get places.
__global__ void choosePlaces(Size frame, int words, DisplacedView scratch) {
  RG_SHARED(uint32_t, sums, kReduceWarps);
  const auto count = static_cast<int>(scratch.parts.firstRoot[words]);
  uint32_t chosen = 0;
  for (int first = 0; first < count; first += kReduceThreads) {
    const int i = first + static_cast<int>(threadIdx.x);
    const bool isStill = i < count && rg::background::isStillPart(
                                          scratch.stillPx[i], scratch.parts.list[i].areaPx, frame);
    uint32_t total = 0;
    const uint32_t place = chosen + sumBefore(isStill ? 1 : 0, sums, total);
    const bool isLookedAt = isStill && place < kMostDisplaced;
    if (i < count) scratch.stillPx[i] = isLookedAt ? place : kNotLookedAt;
    chosen += total;
  }
}

__device__ void count(int colour, uint32_t* histogram) {
  if (colour >= 0) atomicAdd(histogram + colour, 1u);
}

__global__ void countColours(const __grid_constant__ Planes picture,
                             const __grid_constant__ ModelView model, DisplacedView scratch) {
  const WordOfThread word = wordOfThread({wordsOf(model.size.width), model.size.height});
  if (!word.isInside) return;
  forRunsIn(scratch.parts, word, [&](uint32_t run, uint64_t bits) {
    const uint32_t place = scratch.stillPx[scratch.parts.runs[run].component];
    if (place == kNotLookedAt) return;
    uint32_t* const before = scratch.colours + 2 * kColours * place;
    forBits(bits, word.at.x * kWordColumns, [&](int x) {
      const Point p{x, word.at.y};
      const auto now = [&](int c) { return +picture.planes[c].at(p.x, p.y); };
      const auto then = [&](int c) { return +*model.sample(p, 0, c); };
      count(rg::background::vividColour(then(0), then(1), then(2)), before);
      count(rg::background::vividColour(now(0), now(1), now(2)), before + kColours);
    });
  });
}

/// A block for each place.
__global__ void sumShared(DisplacedView scratch) {
  RG_SHARED(uint32_t, values, kReduceWarps);
  const uint32_t* before = scratch.colours + 2 * kColours * blockIdx.x;
  uint32_t shared = 0;
  for (int i = static_cast<int>(threadIdx.x); i < kColours; i += kReduceThreads)
    shared += std::min(before[i], before[i + kColours]);
  shared = reduceBlock(shared, values, [](uint32_t a, uint32_t b) { return a + b; });
  if (threadIdx.x == 0) scratch.shared[blockIdx.x] = shared;
}

struct IsDisplaced {
  const uint32_t *places, *shared;
  __device__ bool operator()(const ComponentsView& found, uint32_t part) const {
    const uint32_t place = places[part];
    return place != kNotLookedAt &&
           rg::background::isDisplaced(shared[place], found.list[part].areaPx);
  }
};

}  // namespace

void addDisplaced(const Planes& picture, const ModelView& model, const BitView& foreground,
                  const StillView& still, int leastAge, const DisplacedView& scratch,
                  const BitTarget& moved, Stream stream) {
  if (picture.channels == 1) return;
  const Size words = foreground.words.size;
  constexpr size_t kHistograms = 2 * size_t{kMostDisplaced} * kColours;
  const ImageView<const uint16_t> ages = still.ages;
  findComponents(foreground, true, Connectivity::Eight, scratch.parts, stream);
  clear(scratch.colours, kHistograms * sizeof *scratch.colours, stream);
  start(overWords("forgetParts", foreground, 4), stream, forgetParts<uint32_t>, words,
        scratch.parts, scratch.stillPx);
  start(overWords("countStill", foreground, 16), stream, countStill, foreground, ages, leastAge,
        scratch.parts, scratch.stillPx);
  start({"choosePlaces", {1, 1, 1}, {kReduceThreads, 1, 1}, {1024, 1024}}, stream, choosePlaces,
        foreground.size, static_cast<int>(words.area()), scratch);
  start(overWords("countColours", foreground, 12), stream, countColours, picture, model, scratch);
  start({"sumShared",
         {kMostDisplaced, 1, 1},
         {kReduceThreads, 1, 1},
         {4.0 * kHistograms, 1.0 * kHistograms}},
        stream, sumShared, scratch);
  start(overWords("addDisplaced", foreground, 8), stream, changeParts<IsDisplaced>, moved, true,
        IsDisplaced{scratch.stillPx, scratch.shared}, scratch.parts);
}

}  // namespace rg::gpu::background
