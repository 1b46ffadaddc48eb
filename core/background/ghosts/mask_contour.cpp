// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/ghosts/mask_contour.hpp"

#include <algorithm>

namespace rg::background {
namespace {

bool isDimmed(const FaintEvidence& evidence, int x, int y) {
  return background::isDimmed(
      evidence.picture.channels,
      [&](int c) { return +evidence.picture.planes[static_cast<size_t>(c)].at(x, y); },
      [&](int c) { return +evidence.shown[static_cast<size_t>(c)].at(x, y); });
}

BorderSides borderSides(const BitMask& mask, int word, int y) {
  return background::borderSides(mask.row(y)[word], [&](int right, int down) {
    const int x = word + right, row = y + down;
    if (x < 0 || x >= mask.wordsPerRow() || row < 0 || row >= mask.height()) return ~uint64_t{0};
    return mask.row(row)[x] | ~mask.columnsOf(x);
  });
}

}  // namespace

void growFaint(const FaintEvidence& evidence, const Executor& executor, CleaningScratch& cleaning,
               ContourScratch& scratch, BitMask& mask) {
  const Size size = mask.size();
  thicken(mask, kFaintReach, executor, scratch.across, scratch.near);
  BitMask& candidates = scratch.candidates;
  candidates.resize(size);
  for (int y = 0; y < size.height; ++y)
    for (int word = 0; word < mask.wordsPerRow(); ++word)
      candidates.row(y)[word] =
          scratch.near.row(y)[word] & evidence.faint.row(y)[word] & ~mask.row(y)[word];
  paintModelAt(candidates, evidence.model, executor, evidence.shown);
  executor.forRows(size.height, [&](int first, int last) {
    for (int y = first; y < last; ++y)
      for (int word = 0; word < mask.wordsPerRow(); ++word) {
        uint64_t kept = mask.row(y)[word];
        forSetBits(candidates.row(y)[word], word * kWordColumns, [&](int x) {
          if (!isDimmed(evidence, x, y)) kept |= uint64_t{1} << x % kWordColumns;
        });
        candidates.row(y)[word] = kept;
      }
  });
  scratch.across.resize(size);
  keepMajority(candidates, 2, 128, executor, cleaning, scratch.across);
  for (int y = 0; y < size.height; ++y)
    for (int word = 0; word < mask.wordsPerRow(); ++word)
      mask.row(y)[word] |= scratch.across.row(y)[word] & scratch.near.row(y)[word];
}

void trimBorder(const BorderEvidence& evidence, BorderLayer layer, const Executor& executor,
                ContourScratch& scratch, BitMask& mask) {
  const Picture& picture = evidence.picture;
  const ConsensusBackground& model = evidence.model;
  scratch.candidates.resize(mask.size());
  BitMask& before = scratch.candidates;
  for (int y = 0; y < mask.height(); ++y)
    std::copy_n(mask.row(y), mask.wordsPerRow(), before.row(y));
  const std::array planes{picture.green(), picture.red(), picture.blue()};
  const std::array<ImageView<const uint8_t>, 3> shown{evidence.shown[0], evidence.shown[1],
                                                      evidence.shown[2]};
  const BorderReader reader{planes.data(), shown.data(), model.channels, mask.size()};
  executor.forRows(mask.height(), [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      const RadiusRow radii = radiusRow(model, evidence.tolerance, y);
      const uint8_t* brightness = evidence.smoothed.planes[0].row(y);
      for (int word = 0; word < before.wordsPerRow(); ++word) {
        if (before.row(y)[word] == 0) continue;
        const BorderSides sides = borderSides(before, word, y);
        uint64_t gone = 0;
        forSetBits(sides.any(), word * kWordColumns, [&](int x) {
          const uint64_t bit = uint64_t{1} << x % kWordColumns;
          const int radius = radiusAt(radii, brightness[x], x);
          if (reader.isOn(layer, {x, y}, sides, bit, radius)) gone |= bit;
        });
        mask.row(y)[word] &= ~gone;
      }
    }
  });
}

}  // namespace rg::background
