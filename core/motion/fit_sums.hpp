// SPDX-License-Identifier: LGPL-2.1-or-later
// What the pixels of a cell say of a displacement (part of stage 4): the sums from which least
// squares take a step.
//
// A pixel's residual is I_t(x) − I_t−1(x − d), the latter sampled bilinearly, in 1/256 grey levels;
// its gradient is the difference of I_t over 2 pixels. Pixels at the frame's edge have no gradient
// and are left out.
// Determinism: integers; the previous picture is sampled at 1/256 px, rounded down.
#pragma once

#include "core/base/geometry.hpp"
#include "core/motion/matched_part.hpp"
#include "core/motion/padded_luma.hpp"

#include <cstdint>
#include <span>

namespace rg::motion {

inline constexpr int kFineBits = 8;  ///< Displacements while fitting: 1/256 px.
inline constexpr int kFine = 1 << kFineBits;
inline constexpr int kCellSize = 8;

/// The matched blocks of a region in 8x8 pixels: bit 2 row + half, as in MatchedPart.
struct MatchedCell {
  int x = 0;
  int y = 0;
  uint16_t blocks = 0;
};

/// Calls visit(cell) for the cells of a part that have blocks.
template <class Visit>
void forCells(const MatchedPart& part, Visit&& visit) {
  constexpr int kBlocksInCell = 2 * kCellSize;
  for (int i = 0; i < kPartHeight / kCellSize; ++i) {
    const auto blocks = static_cast<uint16_t>(part.blocks >> (i * kBlocksInCell));
    if (blocks != 0) visit(MatchedCell{part.x(), part.y() + i * kCellSize, blocks});
  }
}

/// Of the pixels whose residual r is at most `limit`, but for `misfit` and `seen`, which are of
/// all. 64 · 255 · (255 · 256) < 2^30.
struct FitSums {
  int32_t seen = 0;
  int32_t misfit = 0;  ///< Sum of min(|r|, limit).
  int32_t pixels = 0;
  int32_t x = 0, y = 0, r = 0;     ///< Sums of gradient and residual.
  int32_t xx = 0, xy = 0, yy = 0;  ///< Of products of gradients.
  int32_t xr = 0, yr = 0;          ///< Of gradient times residual.
  int32_t rr = 0;                  ///< Of squares of the residual in 1/16 grey levels.

  friend bool operator==(const FitSums&, const FitSums&) = default;
};

/// A pixel of the gradient (gx, gy).
constexpr void addFitPixel(int gx, int gy, int residual, int limit, FitSums& sums) {
  const int size = residual < 0 ? -residual : residual;
  ++sums.seen;
  sums.misfit += size < limit ? size : limit;
  if (size > limit) return;
  const int coarse = residual >> 4;
  ++sums.pixels;
  sums.x += gx;
  sums.y += gy;
  sums.r += residual;
  sums.xx += gx * gx;
  sums.xy += gx * gy;
  sums.yy += gy * gy;
  sums.xr += gx * residual;
  sums.yr += gy * residual;
  sums.rr += coarse * coarse;
}

/// Where a picture is looked at that is displaced by d, in 1/256 px.
struct FitSampler {
  Point whole;  ///< Pixel (0, 0), rounded down,
  Point part;   ///< and 1/256 px beyond it.

  explicit constexpr FitSampler(Point d)
      : whole{-d.x >> kFineBits, -d.y >> kFineBits}, part{-d.x & (kFine - 1), -d.y & (kFine - 1)} {}

  /// In 1/256 grey levels; both rows begin with the pixel that is left of the place.
  [[nodiscard]] constexpr int between(const uint8_t* upper, const uint8_t* lower) const {
    const int top = upper[0] * (kFine - part.x) + upper[1] * part.x;
    const int bottom = lower[0] * (kFine - part.x) + lower[1] * part.x;
    return (top * (kFine - part.y) + bottom * part.y) >> kFineBits;
  }
};

/// The largest limit of a residual: half of the range never fits.
inline constexpr int kMostLimit = 127 * kFine;

/// d: in 1/256 px, less than the reach of `previous`. limit: in 1/256 grey levels, at most
/// kMostLimit. On the best instructions that the machine has; the same bits as sumFitPlainly on
/// all.
[[nodiscard]] FitSums sumFit(const MatchedCell& cell, ImageView<const uint8_t> luma,
                             const PaddedLuma& previous, Point d, int limit);

/// The same pixel by pixel: what it means.
[[nodiscard]] FitSums sumFitPlainly(const MatchedCell& cell, ImageView<const uint8_t> luma,
                                    const PaddedLuma& previous, Point d, int limit);

/// Sums of products of gradients over all pixels that have one, at most 2^15: 2^15 · 255² < 2^31.
struct GradientProducts {
  int32_t xx = 0, xy = 0, yy = 0;
  GradientProducts& operator+=(const GradientProducts& other) {
    xx += other.xx;
    xy += other.xy;
    yy += other.yy;
    return *this;
  }
  friend bool operator==(const GradientProducts&, const GradientProducts&) = default;
};
[[nodiscard]] GradientProducts sumGradients(std::span<const MatchedPart> parts,
                                            ImageView<const uint8_t> luma);
[[nodiscard]] GradientProducts sumGradientsPlainly(std::span<const MatchedPart> parts,
                                                   ImageView<const uint8_t> luma);

}  // namespace rg::motion
