// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/ghosts/mask_contour.hpp"

#include "core/base/pixel.hpp"

#include <algorithm>

namespace rg::background {
namespace {

constexpr int kReach = 6;      ///< Pixels from a sure part to its faint ones.
constexpr int kMostTint = 14;  ///< Grey levels that a channel may be off the shadow's factor.
constexpr int kLeastDepth = 4;
constexpr int kSide = 3;  ///< Pixels from the border to what stands for a side.

/// Could this pixel be the background in a weak shadow?
bool isDimmed(const FaintEvidence& evidence, int x, int y) {
  const int now = evidence.picture.planes[0].at(x, y), before = evidence.shown[0].at(x, y);
  if (now >= before || 2 * now < before) return false;
  for (size_t c = 1; c < static_cast<size_t>(evidence.picture.channels); ++c) {
    const int off = evidence.picture.planes[c].at(x, y) * before - evidence.shown[c].at(x, y) * now;
    if (absDiff(off, 0) > kMostTint * before) return false;
  }
  return true;
}

/// One border pixel of a mask and the direction that leads out of it.
class BorderReader {
 public:
  BorderReader(const Picture& picture, const BitMask& mask)
      : planes_{picture.green(), picture.red(), picture.blue()},
        channels_(picture.isGrey() ? 1 : 3),
        mask_(mask),
        bounds_(boundsOf(mask.size())) {}

  [[nodiscard]] bool isDrawnIn(Point p, Point out, int radius) const {
    const Point beside{p.x + out.x, p.y + out.y};
    if (!bounds_.contains(beside) || mask_.at(beside.x, beside.y) || !isDeep(p, out)) return false;
    const int toInside = difference(p, {p.x - kSide * out.x, p.y - kSide * out.y});
    const int toOutside = difference(p, {p.x + kSide * out.x, p.y + kSide * out.y});
    return toOutside < toInside && 2 * toInside > 3 * radius;
  }

 private:
  [[nodiscard]] bool isDeep(Point p, Point out) const {
    for (int i = 1; i <= kLeastDepth; ++i) {
      const Point q{p.x - i * out.x, p.y - i * out.y};
      if (bounds_.contains(q) && !mask_.at(q.x, q.y)) return false;
    }
    return true;
  }

  /// Outside the frame its border is repeated.
  [[nodiscard]] int difference(Point p, Point other) const {
    const int x = std::clamp(other.x, 0, bounds_.width - 1);
    const int y = std::clamp(other.y, 0, bounds_.height - 1);
    int most = 0;
    for (size_t c = 0; c < channels_; ++c)
      most = std::max(most, absDiff(planes_[c].at(p.x, p.y), planes_[c].at(x, y)));
    return most;
  }

  std::array<ImageView<const uint8_t>, 3> planes_;
  size_t channels_;
  const BitMask& mask_;
  Box bounds_;
};

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
  thicken(mask, kReach, executor, scratch.across, scratch.near);
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

void trimBorder(const Picture& picture, const SmoothPicture& smoothed,
                const ConsensusBackground& model, const Tolerance& tolerance,
                const Executor& executor, ContourScratch& scratch, BitMask& mask) {
  scratch.candidates.resize(mask.size());
  BitMask& before = scratch.candidates;
  for (int y = 0; y < mask.height(); ++y)
    std::copy_n(mask.row(y), mask.wordsPerRow(), before.row(y));
  const BorderReader reader(picture, before);
  executor.forRows(mask.height(), [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      const RadiusRow radii = radiusRow(model, tolerance, y);
      const uint8_t* brightness = smoothed.planes[0].row(y);
      forBorderColumns(before, y, [&](int x) {
        const int radius = radiusAt(radii, brightness[x], x);
        for (const Point out : {Point{-1, 0}, Point{1, 0}, Point{0, -1}, Point{0, 1}})
          if (reader.isDrawnIn({x, y}, out, radius)) {
            mask.row(y)[x / kWordColumns] &= ~(uint64_t{1} << x % kWordColumns);
            break;
          }
      });
    }
  });
}

}  // namespace rg::background
