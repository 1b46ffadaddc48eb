// SPDX-License-Identifier: LGPL-2.1-or-later
// Sums over the matched pixels of a region that its sub-pixel motion is solved from (part of stage
// 4).
//
// Gradients are central differences of the luma, in grey levels per 2 px; pixels on the frame's
// border have none and count nowhere. Residuals are the luma minus a bilinear sample of the
// previous one, positions in 1/128 px, levels in 1/128. Determinism: integer sums.
#pragma once

#include "core/block_matching.hpp"

#include <cstdint>
#include <span>

namespace rg {

inline constexpr int kFineBits = 7;
inline constexpr int kFine = 1 << kFineBits;  ///< A pixel, and a grey level.
inline constexpr int kNoLimit = INT16_MAX;

/// Of the pixels whose residual is within the limit.
struct NormalSums {
  int64_t xx = 0, xy = 0, yy = 0;  ///< Of products of gradients.
  int64_t xr = 0, yr = 0;          ///< Of gradients with the residual.
  int64_t pixels = 0;

  friend bool operator==(const NormalSums&, const NormalSums&) = default;
};

/// For motion d, in 1/128 px, less than the padding's reach; limit at least 0. On the best
/// instructions that the machine has; the same bits as sumNormalsPlainly on all.
[[nodiscard]] NormalSums sumNormals(std::span<const MatchedPart> parts,
                                    ImageView<const uint8_t> luma, const PaddedLuma& previous,
                                    Point d, int limit);

/// The same pixel by pixel: what it means.
[[nodiscard]] NormalSums sumNormalsPlainly(std::span<const MatchedPart> parts,
                                           ImageView<const uint8_t> luma,
                                           const PaddedLuma& previous, Point d, int limit);

namespace detail {
/// Where pixels are looked at in the previous picture, relative to themselves.
struct FinePlace {
  Point whole;
  int fractionX = 0;  ///< 1/128 px beyond it.
  int fractionY = 0;

  explicit constexpr FinePlace(Point d)
      : whole{(-d.x) >> kFineBits, (-d.y) >> kFineBits},
        fractionX((-d.x) & (kFine - 1)),
        fractionY((-d.y) & (kFine - 1)) {}
};
}  // namespace detail

}  // namespace rg
