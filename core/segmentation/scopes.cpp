// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/segmentation/scopes.hpp"

#include "core/base/row_spans.hpp"
#include "core/segmentation/hue_decision.hpp"
#include "core/segmentation/segmentation.hpp"

#include <algorithm>

namespace rg::segmentation {

void coverAreas(std::span<const Box> areas, uint8_t around, ImageView<uint8_t> scope) {
  for (int y = 0; y < scope.height(); ++y) std::fill_n(scope.row(y), scope.width(), around);
  for (const Box& area : areas) {
    const Box box = coverOf(area, scope.size);
    for (int y = box.y; y < box.bottom(); ++y)
      std::fill_n(scope.row(y) + box.x, box.width, kInScope);
  }
}

void scopeByHue(ImageView<const uint8_t> hue, ImageView<const uint8_t> evidence,
                ImageView<const uint8_t> scope, ImageView<uint8_t> out) {
  for (int y = 0; y < out.height(); ++y) {
    const uint8_t* hues = hue.row(y);
    const uint8_t* seen = evidence.data ? evidence.row(y) : nullptr;
    const uint8_t* own = scope.data ? scope.row(y) : nullptr;
    uint8_t* row = out.row(y);
    for (int x = 0; x < out.width(); ++x)
      row[x] = isWanted(hues[x], seen != nullptr && seen[x] == background::kForegroundPixel)
                   ? (own ? own[x] : kInScope)
                   : background::kBackgroundPixel;
  }
}

}  // namespace rg::segmentation
