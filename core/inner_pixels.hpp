// SPDX-License-Identifier: LGPL-2.1-or-later
// Which pixels of a region are matched (part of stage 4).
//
// Along the border of two regions the pixels show the edge between them, and that edge moves with
// the nearer one of the two. So the pixels near another region, or near label 0, are left out, as
// long as enough of the region is left; of a thin region all pixels are matched.
// Determinism: each pixel depends on its neighbourhood and on integer counts.
#pragma once

#include "core/executor.hpp"
#include "core/image.hpp"
#include "core/region_graph.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace rg {

/// A pixel is inner when so many pixels to its left, right, top and bottom, as far as the frame
/// goes, have its label.
inline constexpr int kBorderReach = 3;
/// Matched are the inner pixels where they are at least one in so many, and kLeastInnerPx.
inline constexpr uint32_t kInnerShare = 4;
inline constexpr uint32_t kLeastInnerPx = 16;

class InnerPixels {
 public:
  /// After it, ids() holds the labels of the matched pixels and 0 elsewhere.
  void find(ImageView<const uint16_t> labels, std::span<const Region> regions,
            const Executor& executor);
  [[nodiscard]] ImageView<const uint16_t> ids() const { return ids_; }

 private:
  Image<uint16_t> ids_;
  std::vector<std::vector<uint32_t>> counts_;  ///< By task, then by region.
  std::vector<uint8_t> takesAll_;              ///< By label.
};

}  // namespace rg
