// SPDX-License-Identifier: LGPL-2.1-or-later
// Gaps in the foreground that the picture does not know: where an object has the colour of the
// model behind it, the mask has a border and the picture has no edge.
//
// Determinism: integers; sums over components (core/base/components.hpp).
#pragma once

#include "core/base/bit_mask.hpp"
#include "core/base/components.hpp"
#include "core/base/memory/executor.hpp"
#include "core/base/memory/image.hpp"
#include "core/base/pixel.hpp"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace rg {

/// What counts as a gap wherever one is closed.
inline constexpr int kMostGapStep = 14;  ///< Grey levels across a border that is no edge.
[[nodiscard]] constexpr uint32_t mostGapPx(Size frame) {
  return static_cast<uint32_t>(frame.area() / 5);
}

struct GapContour {
  uint32_t edgePixels = 0;  ///< Where the picture has an edge across the border.
  uint32_t pixels = 0;
  unsigned frameSides = 0;  ///< Bits: left, top, right, bottom.
};

/// Where the border is read: how far out, and from which step on it is an edge.
struct EdgeTest {
  ImageView<const uint8_t> picture;
  int reach, mostStep;
};

/// One side of a pixel of the border.
constexpr void addStep(const EdgeTest& test, Point p, Point direction, GapContour& contour) {
  const ImageView<const uint8_t> picture = test.picture;
  const Point outside{p.x + test.reach * direction.x, p.y + test.reach * direction.y};
  const Point inside{p.x - 2 * direction.x, p.y - 2 * direction.y};
  const Box bounds = boundsOf(picture.size);
  if (!bounds.contains(outside) || !bounds.contains(inside)) return;
  contour.edgePixels +=
      absDiff(picture.at(inside.x, inside.y), picture.at(outside.x, outside.y)) > test.mostStep;
  ++contour.pixels;
}

/// Whether an unset part with this contour is a gap.
[[nodiscard]] constexpr bool isGap(uint32_t areaPx, const GapContour& contour, uint32_t mostPx) {
  return areaPx <= mostPx && (contour.frameSides & (contour.frameSides - 1)) == 0 &&
         contour.pixels > 0 && 4 * contour.edgePixels <= contour.pixels;
}

/// How far a mask is grown, so that cracks don't open a gap.
[[nodiscard]] constexpr int gapMargin(Size frame) {
  return std::clamp(frame.height / 40, 1, 4);
}

struct GapScratch {
  BitMask across, thick;  ///< The mask grown by a few pixels, so that cracks don't open a gap.
  Components parts;
  std::vector<GapContour> contours;
  std::vector<uint8_t> isChosen;
};

/// Sets unset parts of at most `mostPx` pixels that touch at most one side of the frame and whose
/// border to the mask is no edge in `picture` for three quarters of its length: a step of at most
/// `mostStep` grey levels. Returns whether there are any. (Where the mask is thin, the border's
/// other side is read beyond it and tells nothing: hence not all of the border.)
bool fillUnedged(ImageView<const uint8_t> picture, int mostStep, uint32_t mostPx,
                 const Executor& executor, GapScratch& scratch, BitMask& mask);

}  // namespace rg
