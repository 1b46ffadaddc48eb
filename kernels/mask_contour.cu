// SPDX-License-Identifier: LGPL-2.1-or-later
#include "kernels/bit_mask.hpp"
#include "kernels/mask_cleaning.hpp"
#include "kernels/mask_contour.hpp"
#include "kernels/model_pixels.hpp"
#include "kernels/start.hpp"
#include "kernels/threads.hpp"

namespace rg::gpu::background {
namespace {

/// The mask and the faint pixels near it that no weak shadow explains.
__global__ void addCandidates(const __grid_constant__ Planes picture,
                              const __grid_constant__ ModelView model, BitView faint, BitView mask,
                              BitView near, BitTarget out) {
  const Point at = wordOfWarp();
  if (at.y >= mask.size.height) return;
  const uint64_t sure = mask.words.at(at.x, at.y);
  const uint64_t bits = near.words.at(at.x, at.y) & faint.words.at(at.x, at.y) & ~sure;
  const uint64_t kept = chooseBits(bits, at, [&](Point p) {
    return !rg::background::isDimmed(
        model.channels, [&](int c) { return +picture.planes[c].at(p.x, p.y); },
        [&](int c) { return modelledLevel(model, p, c); });
  });
  if (threadIdx.x == 0) out.words.at(at.x, at.y) = sure | kept;
}

__global__ void addGrown(BitView grown, BitView near, BitTarget mask) {
  const Point at = pixelOfThread();
  if (isWithin(at, mask.words.size))
    mask.words.at(at.x, at.y) |= grown.words.at(at.x, at.y) & near.words.at(at.x, at.y);
}

__device__ rg::background::BorderSides borderSides(const BitView& mask, Point at) {
  return rg::background::borderSides(mask.words.at(at.x, at.y), [&](int right, int down) {
    const Point word{at.x + right, at.y + down};
    if (!boundsOf(mask.words.size).contains(word)) return ~uint64_t{0};
    return mask.words.at(word.x, word.y) | ~columnsOf(mask.size.width, word.x);
  });
}

__global__ void trimWords(const __grid_constant__ BorderView seen,
                          rg::background::BorderLayer layer, BitView mask, BitTarget out) {
  const Point at = wordOfWarp();
  if (at.y >= mask.size.height) return;
  const rg::background::BorderReader reader{seen.picture.planes, seen.shown.planes,
                                            seen.picture.channels, mask.size};
  const rg::background::BorderSides sides = borderSides(mask, at);
  const uint64_t drawn = chooseBits(sides.any(), at, [&](Point p) {
    const int radius = radiusAt(seen.model, seen.tolerance, seen.brightness.at(p.x, p.y), p);
    return reader.isOn(layer, p, sides, uint64_t{1} << p.x % kWordColumns, radius);
  });
  if (threadIdx.x == 0) out.words.at(at.x, at.y) = mask.words.at(at.x, at.y) & ~drawn;
}

}  // namespace

void growFaint(const Planes& smoothed, const ModelView& model, const BitView& faint,
               const ContourView& scratch, const BitTarget& mask, Stream stream) {
  const double words = static_cast<double>(mask.words.size.area());
  thicken(mask, rg::background::kFaintReach, scratch.near, stream);
  // Candidates are few: most warps read words only.
  start(launchOverWords("addCandidates", mask.size, {32 * words, 8 * words}), stream, addCandidates,
        smoothed, model, faint, BitView(mask), BitView(scratch.near), scratch.candidates);
  keepMajority(scratch.candidates, 2, 128, scratch.across, stream);
  start(launchOver("addGrown", mask.words.size, 1, {32 * words, 2 * words}), stream, addGrown,
        BitView(scratch.across), BitView(scratch.near), mask);
}

void trimBorder(const BorderView& seen, rg::background::BorderLayer layer, const BitView& mask,
                const BitTarget& out, Stream stream) {
  const double words = static_cast<double>(mask.words.size.area());
  start(launchOverWords("trimBorder", mask.size, {24 * words, 16 * words}), stream, trimWords, seen,
        layer, mask, out);
}

}  // namespace rg::gpu::background
