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
  int frameSides = 0;  ///< Bits: left, top, right, bottom.
};

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
