// SPDX-License-Identifier: LGPL-2.1-or-later
#include "kernels/bit_mask.hpp"
#include "kernels/mask_gaps.hpp"
#include "kernels/start.hpp"
#include "kernels/word_runs.hpp"

namespace rg::gpu {
namespace {

/// What a word knows of the contour of a run that has `bits` in it.
__device__ GapContour contourIn(const EdgeTest& test, const BitView& thick, const ComponentRun& run,
                                Point at, uint64_t bits) {
  const int begin = at.x * kWordColumns, y = run.y;
  const Size size = thick.size;
  GapContour contour;
  contour.frameSides = (run.begin == 0 ? 1u : 0u) | (y == 0 ? 2u : 0u) |
                       (run.end == size.width ? 4u : 0u) | (y == size.height - 1 ? 8u : 0u);
  if (run.begin >= begin && run.begin > 0) addStep(test, {run.begin, y}, {-1, 0}, contour);
  if (run.end <= begin + kWordColumns && run.end < size.width)
    addStep(test, {run.end - 1, y}, {1, 0}, contour);
  const auto addSteps = [&](int beside, int direction) {
    if (beside < 0 || beside >= size.height) return;
    forBits(bits & thick.words.at(at.x, beside), begin, [&](int x) {
      addStep(test, {x, y}, {0, direction}, contour);
    });
  };
  addSteps(y - 1, -1);
  addSteps(y + 1, 1);
  return contour;
}

__global__ void readContours(EdgeTest test, BitView thick, uint32_t mostPx, ComponentsView parts,
                             GapContour* contours) {
  const WordOfThread word = wordOfThread(thick.words.size);
  if (!word.isInside) return;
  forRunsIn(parts, word, [&](uint32_t i, uint64_t bits) {
    const ComponentRun& run = parts.runs[i];
    if (parts.list[run.component].areaPx > mostPx) return;
    const GapContour own = contourIn(test, thick, run, word.at, bits);
    GapContour& all = contours[run.component];
    if (own.frameSides != 0) atomicOr(&all.frameSides, own.frameSides);
    if (own.pixels == 0) return;
    atomicAdd(&all.pixels, own.pixels);
    atomicAdd(&all.edgePixels, own.edgePixels);
  });
}

struct IsGap {
  const GapContour* contours;
  uint32_t mostPx;
  __device__ bool operator()(const ComponentsView& found, uint32_t part) const {
    return isGap(found.list[part].areaPx, contours[part], mostPx);
  }
};

}  // namespace

void fillUnedged(ImageView<const uint8_t> picture, int mostStep, uint32_t mostPx,
                 const GapView& scratch, const BitTarget& mask, Stream stream) {
  const int margin = gapMargin(mask.size);
  const BitTarget& thick = scratch.thick;
  thicken(mask, margin, thick, stream);
  findComponents(thick, false, Connectivity::Four, scratch.parts, stream);
  start(overWords("forgetParts", mask, 4), stream, forgetParts<GapContour>, mask.words.size,
        scratch.parts, scratch.contours);
  start(overWords("readContours", mask, 40), stream, readContours,
        EdgeTest{picture, margin + 2, mostStep}, BitView(thick), mostPx, scratch.parts,
        scratch.contours);
  start(overWords("markGaps", mask, 12), stream, markParts<IsGap>, scratch.chosen,
        IsGap{scratch.contours, mostPx}, scratch.parts);
  // With the rim that the thickening took from the gap.
  thicken(scratch.chosen, margin, thick, stream);
  add(thick, mask, stream);
}

}  // namespace rg::gpu
