// SPDX-License-Identifier: LGPL-2.1-or-later
// What is done in one window, the same on every processor: its contrast, its features' values, its
// way through the stages.
//
// Sums of pixels are whole numbers, and those of a scaled window are brought to the size of the
// trained one and rounded to whole numbers, so that a picture enlarged by a whole factor gives the
// same numbers as the picture itself. With them values are computed as OpenCV does: each operation
// rounds by itself (no fused ones), leaves are added in double precision in the order of the trees.
// So decisions have the same bits everywhere.
#pragma once

#include "core/detection/cascade.hpp"

#include <cmath>
#include <cstdint>

namespace rg::detection {

/// Where the sums stand that give that of a rectangle: upper left, upper right, lower left, lower
/// right, from a window's own place.
struct Corners {
  int32_t at[4] = {};
};

/// A feature in the sums of pixels of one scale: one after the other, the rows that its rectangles
/// are made of. An upright one is a row by itself, and the first two have one at least.
struct Lookup {
  int32_t firstRow = 0;
  int32_t rows[kMostRects] = {};
  float ratios[kMostRects] = {};  ///< Area in the trained window by that in the scaled one.
  float weights[kMostRects] = {};
};

/// The part of the window whose contrast counts: all but its border of a pixel.
struct ContrastLookup {
  Corners corners;
  Corners squareCorners;
  float ratio = 1;
  double squareRatio = 1;
  double area = 0;  ///< In the trained window.
};

/// A cascade as it is applied to windows of one scale.
struct CascadeView {
  const CascadeStage* stages = nullptr;
  const Tree* trees = nullptr;
  const Branch* branches = nullptr;
  const float* leaves = nullptr;
  const Lookup* lookups = nullptr;  ///< Parallel to the branches.
  const Corners* rows = nullptr;    ///< That they point to.
  ContrastLookup contrast;
  int32_t stageCount = 0;
};

/// Windows whose pixels deviate by no more than ten levels from their mean are no objects.
inline constexpr double kLeastInverseDeviation = 1e-1;

/// To the nearest whole number, halves to even, by the rounding of the sum: 1.5 · 2^23 and 1.5 ·
/// 2^52. |value| < 2^22, 2^51.
[[nodiscard]] constexpr float whole(float value) {
  constexpr float kUnit = 12582912.0F;
  return (value + kUnit) - kUnit;
}
[[nodiscard]] constexpr double whole(double value) {
  constexpr double kUnit = 6755399441055744.0;
  return (value + kUnit) - kUnit;
}
static_assert(whole(2.5F) == 2 && whole(-3.75F) == -4 && whole(2097151.25F) == 2097151);
static_assert(whole(3.5) == 4 && whole(1e12 + .25) == 1e12);

/// Sums of pixels go round at 2^32, but that of a window is below 2^31 (kMostWindowPx).
[[nodiscard]] constexpr uint32_t sumWithin(const uint32_t* at, const Corners& corners) {
  const int32_t* c = corners.at;
  return at[c[0]] - at[c[1]] - at[c[2]] + at[c[3]];
}

/// The sum in a rectangle of the scaled window, as it would be in the trained one.
[[nodiscard]] constexpr float trainedSum(uint32_t sum, float ratio) {
  return whole(static_cast<float>(static_cast<int32_t>(sum)) * ratio);
}

/// 1 / (deviation · area), or 0 where the window has too little contrast to be an object.
[[nodiscard]] constexpr float contrastFactor(double sum, double squares, double area) {
  const double spread = area * squares - sum * sum;  // Whole, and below 2^53.
  if (!(spread > 0)) return 0;
  const auto factor = static_cast<float>(1.0 / std::sqrt(spread));
  return area * static_cast<double>(factor) < kLeastInverseDeviation ? factor : 0;
}
[[nodiscard]] constexpr float contrastFactor(const ContrastLookup& lookup, const uint32_t* at,
                                             const double* squaresAt) {
  const int32_t* c = lookup.squareCorners.at;
  const double squares = squaresAt[c[0]] - squaresAt[c[1]] - squaresAt[c[2]] + squaresAt[c[3]];
  const float sum = trainedSum(sumWithin(at, lookup.corners), lookup.ratio);
  return contrastFactor(static_cast<double>(sum), whole(squares * lookup.squareRatio), lookup.area);
}

/// The sum of a feature's rectangle times its weight; `rows` goes on to the next one's.
[[nodiscard]] constexpr float weightedSum(const Lookup& lookup, int rect, const Corners*& rows,
                                          const uint32_t* at) {
  uint32_t sum = sumWithin(at, *rows++);
  for (int32_t r = 1; r < lookup.rows[rect]; ++r) sum += sumWithin(at, *rows++);
  return lookup.weights[rect] * trainedSum(sum, lookup.ratios[rect]);
}

[[nodiscard]] constexpr float valueOf(const CascadeView& cascade, const Lookup& lookup,
                                      const uint32_t* at) {
  const Corners* rows = cascade.rows + lookup.firstRow;
  float value = weightedSum(lookup, 0, rows, at);
  value += weightedSum(lookup, 1, rows, at);
  if (lookup.weights[2] != 0) value += weightedSum(lookup, 2, rows, at);
  return value;
}

[[nodiscard]] constexpr float leafOf(const CascadeView& cascade, const Tree& tree,
                                     const uint32_t* at, float factor) {
  int32_t next = 0;
  while (next >= 0) {
    const int32_t node = tree.firstNode + next;
    const Branch& branch = cascade.branches[node];
    next = valueOf(cascade, cascade.lookups[node], at) * factor < branch.threshold ? branch.less
                                                                                   : branch.other;
  }
  return cascade.leaves[tree.firstLeaf - 1 - next];
}

[[nodiscard]] constexpr double stageSum(const CascadeView& cascade, int32_t stage,
                                        const uint32_t* at, float factor) {
  double sum = 0;
  const CascadeStage& own = cascade.stages[stage];
  for (int32_t t = 0; t < own.trees; ++t)
    sum += static_cast<double>(leafOf(cascade, cascade.trees[own.firstTree + t], at, factor));
  return sum;
}

/// How many stages from `first` on a window passes, `first` included in the count.
[[nodiscard]] constexpr int32_t stagesPassed(const CascadeView& cascade, const uint32_t* at,
                                             float factor, int32_t first) {
  int32_t stage = first;
  while (stage < cascade.stageCount && !(stageSum(cascade, stage, at, factor) <
                                         static_cast<double>(cascade.stages[stage].threshold)))
    ++stage;
  return stage;
}

/// What is told of a window: how many stages it passed, or that it has too little contrast.
inline constexpr uint16_t kFlatWindow = UINT16_MAX;

[[nodiscard]] constexpr uint16_t judgeWindow(const CascadeView& cascade, const uint32_t* at,
                                             const double* squaresAt) {
  const float factor = contrastFactor(cascade.contrast, at, squaresAt);
  if (factor == 0) return kFlatWindow;
  return static_cast<uint16_t>(stagesPassed(cascade, at, factor, 0));
}

}  // namespace rg::detection
