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
        [&](int c) { return paintedLevel(model, p, c); });
  });
  if (threadIdx.x == 0) out.words.at(at.x, at.y) = sure | kept;
}

__global__ void addGrown(BitView grown, BitView near, BitTarget mask) {
  const Point at = pixelOfThread();
  if (isWithin(at, mask.words.size))
    mask.words.at(at.x, at.y) |= grown.words.at(at.x, at.y) & near.words.at(at.x, at.y);
}

struct MaskPixels {
  BitView mask;
  constexpr bool at(int x, int y) const { return isSet(mask, x, y); }
};

/// The set pixels of a word that have an unset one beside, above or below.
__device__ uint64_t borderOf(const BitView& mask, Point at) {
  const auto word = [&](int x, int y) {
    return x < 0 || x >= mask.words.width() ? 0 : mask.words.at(x, y);
  };
  const uint64_t here = word(at.x, at.y);
  const uint64_t left = here << 1 | word(at.x - 1, at.y) >> (kWordColumns - 1);
  const uint64_t right = here >> 1 | word(at.x + 1, at.y) << (kWordColumns - 1);
  const uint64_t above = word(at.x, std::max(0, at.y - 1));
  const uint64_t below = word(at.x, std::min(mask.size.height - 1, at.y + 1));
  return here & ~(left & right & above & below);
}

__global__ void trimWords(const __grid_constant__ BorderView seen,
                          rg::background::BorderLayer layer, BitView mask, BitTarget out) {
  const Point at = wordOfWarp();
  if (at.y >= mask.size.height) return;
  const MaskPixels pixels{mask};
  const auto modelled = [&](Point p, int c) { return modelledLevel(seen.model, p, c); };
  const rg::background::BorderReader reader{seen.picture.planes, seen.picture.channels, pixels,
                                            mask.size, modelled};
  const uint64_t drawn = chooseBits(borderOf(mask, at), at, [&](Point p) {
    return reader.isOn(layer, p,
                       radiusAt(seen.model, seen.tolerance, seen.brightness.at(p.x, p.y), p));
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
