// SPDX-License-Identifier: LGPL-2.1-or-later
// Regions against an earlier frame, with the camera's motion alone and with a shift beyond it (part
// of core/objects/merge/own_motion.hpp, which tells what is left out and why).
#pragma once

#include "core/base/pixel.hpp"
#include "core/objects/merge/own_motion.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace rg::objects {

/// Fills in the sums of the trials that have a shift, over pixels that can be compared with and
/// without it; reads s.expected, s.shown, s.mostLevels, s.everyRow and s.moves, and leaves s.hidden
/// as it was. own: of each region what is known, of those that move the shift. Cost: follows the
/// pixels and runs of those regions, and of the movers.
void compareRegions(const motion::Motion& motion, std::span<const OwnMotion> own,
                    const Executor& executor, OwnMotionScratch& s);

/// Bands lie along the shift: where it goes sideways they are rows of the region's box, else
/// columns.
[[nodiscard]] constexpr bool hasRowBands(Point shift) {
  const auto length = [](int v) { return v < 0 ? -v : v; };
  return length(shift.x) >= length(shift.y);
}
[[nodiscard]] constexpr int bandOfRow(int y, const Box& box) {
  return OwnMotionScratch::kBands * (y - box.y) / box.height;
}
/// Of columns a band's first one, and the band of one.
[[nodiscard]] constexpr int bandBegin(int band, const Box& box) {
  return box.x + band * box.width / OwnMotionScratch::kBands;
}
[[nodiscard]] constexpr int bandOfColumn(int x, const Box& box) {
  return (OwnMotionScratch::kBands * (x - box.x + 1) - 1) / box.width;
}
static_assert([] {
  for (int width = 1; width < 40; ++width)
    for (int x = 0; x < width; ++x) {
      const Box box{3, 0, width, 1};
      const int band = bandOfColumn(3 + x, box);
      if (bandBegin(band, box) > 3 + x || bandBegin(band + 1, box) <= 3 + x) return false;
    }
  return true;
}());

/// The pixel behind another one that moves by the shift.
[[nodiscard]] constexpr Point behind(Point p, Point shift) {
  const auto sign = [](int v) { return (v > 0) - (v < 0); };
  return {p.x - sign(shift.x), p.y - sign(shift.y)};
}
/// By how much a pixel differs; of two that don't show the same it says nothing more.
[[nodiscard]] constexpr uint32_t limitedDifference(uint8_t a, uint8_t b, uint8_t most) {
  return static_cast<uint32_t>(std::min<int>(absDiff(a, b), most));
}
/// By how much earlier lies what a mover that has moved by the shift covered: all of its own, and
/// the pixel behind, of which half was its.
[[nodiscard]] constexpr std::array<Point, 2> coveredBy(Point shift) {
  const Point back = behind({}, shift);
  return {shift, {shift.x - back.x, shift.y - back.y}};
}
/// Whether a region's row is one of those that stand for all.
[[nodiscard]] constexpr bool isComparedRow(int y, const Box& box, int everyRow) {
  return (y - box.y) % everyRow == 0;
}
/// The columns that the earlier frame shows both with and without the shift.
[[nodiscard]] constexpr ShownRange comparedColumns(const ShownRange& still, const ShownRange& moved,
                                                   int shiftX) {
  const int first = moved.first + shiftX, last = moved.last + shiftX;
  return {still.first > first ? still.first : first, still.last < last ? still.last : last};
}
/// Whether what covered a pixel in the earlier frame hides it from a region.
[[nodiscard]] constexpr bool hidesFrom(uint16_t region, uint32_t by) {
  return by != segmentation::kNoRegion && by != region;
}

[[nodiscard]] constexpr OwnMotionScratch::Sums sumOfBands(const OwnMotionScratch::Sums* bands,
                                                          int count) {
  OwnMotionScratch::Sums sum;
  for (int i = 0; i < count; ++i) {
    sum.still += bands[i].still;
    sum.moved += bands[i].moved;
    sum.pixels += bands[i].pixels;
  }
  return sum;
}
/// Adds up the kBands bands of a region but for the neighbours that gain most.
[[nodiscard]] constexpr OwnMotionScratch::Sums sumWithoutBest(const OwnMotionScratch::Sums* bands) {
  constexpr int kLeftOut = 2;
  OwnMotionScratch::Sums best;
  int64_t most = INT64_MIN;
  for (int band = 0; band + kLeftOut <= OwnMotionScratch::kBands; ++band) {
    const OwnMotionScratch::Sums sum = sumOfBands(bands + band, kLeftOut);
    const auto gain = static_cast<int64_t>(sum.still - sum.moved);
    if (gain <= most) continue;
    best = sum;
    most = gain;
  }
  const OwnMotionScratch::Sums all = sumOfBands(bands, OwnMotionScratch::kBands);
  if (best.pixels == all.pixels) return all;
  return {all.still - best.still, all.moved - best.moved, all.pixels - best.pixels};
}

}  // namespace rg::objects
