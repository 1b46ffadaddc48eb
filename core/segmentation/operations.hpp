// SPDX-License-Identifier: LGPL-2.1-or-later
// What the stage does with pixels, step by step: by the functions of this room, or by a device's
// counterparts of them. Which of the two did a step can't be seen in its result.
#pragma once

#include "core/base/bit_mask.hpp"
#include "core/base/mask_gaps.hpp"
#include "core/base/memory/executor.hpp"
#include "core/base/memory/image.hpp"
#include "core/base/picture.hpp"
#include "core/segmentation/border_pixels.hpp"
#include "core/segmentation/colour_cells.hpp"
#include "core/segmentation/colour_links.hpp"
#include "core/segmentation/hue_decision.hpp"
#include "core/segmentation/pixel_runs.hpp"
#include "core/segmentation/region_division.hpp"

#include <cstdint>
#include <span>

namespace rg::segmentation {

/// A scope plane (core/base/row_spans.hpp); null: all pixels are in scope.
using Scoped = const Image<uint8_t>*;
[[nodiscard]] inline ImageView<const uint8_t> viewOf(Scoped scope) {
  return scope != nullptr ? scope->view() : ImageView<const uint8_t>{};
}

struct GrowthLimits {
  int similarity = 0;
  uint32_t minAreaPx = 1;
  uint32_t maxRegions = 1;
  ColourSpace space = ColourSpace::Rgb;
};

/// How a frame is divided with these limits: from cells of what size, and what is left of them for
/// its pixels.
struct DivisionPlan {
  int sidePx = 1;  ///< The largest cells that at least 16 of make the smallest region.
  int similarity = 0;
  RunLimits runs{};
  RegionDivision::Limits cells;  ///< A few more regions than wanted, for what the pixels change.
  RegionDivision::Limits pixels;
};
[[nodiscard]] DivisionPlan planOf(Size frame, const GrowthLimits& limits);

/// Each does what the function of its name does; this class does it on the CPU.
class Operations {
 public:
  explicit Operations(const Executor& executor) : executor_(executor) {}
  virtual ~Operations() = default;
  Operations(const Operations&) = delete;
  Operations& operator=(const Operations&) = delete;

  /// What is foreground in the mask, without the gaps at whose border no colour ends: in `scope`,
  /// or the mask itself where there are none.
  [[nodiscard]] virtual const Image<uint8_t>& closeGaps(const Picture& picture,
                                                        const Image<uint8_t>& mask,
                                                        Image<uint8_t>& scope);
  virtual void coverAreas(std::span<const Box> areas, uint8_t around, Image<uint8_t>& scope);
  virtual void keepInside(const Image<uint8_t>& interest, Image<uint8_t>& scope);
  virtual void classifyHues(const Picture& picture, const HueRules& rules, Scoped scope,
                            Image<uint8_t>& classes);
  virtual void scopeByHue(const Image<uint8_t>& hue, Scoped evidence, Scoped scope,
                          Image<uint8_t>& out);
  /// Writes the region of each pixel in scope, 1 … count, else 0. Returns count. The frame's band
  /// of hues guards the borders.
  [[nodiscard]] virtual uint32_t divide(const Picture& picture, Scoped scope,
                                        const GrowthLimits& limits, Image<uint16_t>& ids);
  /// Readers of a result look at its planes on the host.
  virtual void publish(Image<uint16_t>&, Image<uint8_t>&) {}

 protected:
  [[nodiscard]] const Executor& executor() const { return executor_; }

 private:
  const Executor& executor_;
  Image<uint8_t> rawHues_;
  BitMask whole_;  ///< The foreground without gaps.
  GapScratch gaps_;
  ColourCells cells_;
  ColourLinks links_;
  PixelRuns cellRuns_, runs_;
  RegionDivision cellDivision_, division_;
  Image<uint16_t> cellIds_;
  BorderPixels borderPixels_;
};

}  // namespace rg::segmentation
