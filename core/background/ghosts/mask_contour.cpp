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

/// Visits the set pixels of a row that have an unset one beside, above or below.
template <class Visit>
void forBorderColumns(const BitMask& mask, int y, Visit&& visit) {
  const int words = mask.wordsPerRow();
  const uint64_t* here = mask.row(y);
  const uint64_t* above = mask.row(std::max(0, y - 1));
  const uint64_t* below = mask.row(std::min(mask.height() - 1, y + 1));
  for (int word = 0; word < words; ++word) {
    if (here[word] == 0) continue;
    const uint64_t left = here[word] << 1 | (word > 0 ? here[word - 1] >> 63 : 0);
    const uint64_t right = here[word] >> 1 | (word + 1 < words ? here[word + 1] << 63 : 0);
    const uint64_t inside = left & right & above[word] & below[word];
    forSetBits(here[word] & ~inside, word * kWordColumns, visit);
  }
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
  const auto modelled = [&](Point p, int c) {
    return modelledLevel([&](int sample) { return +model.sample(p, sample, c); });
  };
  const BorderReader reader{planes.data(), model.channels, before, mask.size(), modelled};
  executor.forRows(mask.height(), [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      const RadiusRow radii = radiusRow(model, evidence.tolerance, y);
      const uint8_t* brightness = evidence.smoothed.planes[0].row(y);
      forBorderColumns(before, y, [&](int x) {
        const int radius = radiusAt(radii, brightness[x], x);
        if (reader.isOn(layer, {x, y}, radius))
          mask.row(y)[x / kWordColumns] &= ~(uint64_t{1} << x % kWordColumns);
      });
    }
  });
}

}  // namespace rg::background
