// SPDX-License-Identifier: LGPL-2.1-or-later
// What has happened to a scene of which much differs from its model: no light, no colour, a camera
// that was pushed. All but isEverywhere() look at a grid of at most 4096 points.
//
// Determinism: integer sums over fixed points, one after the other.
#pragma once

#include "core/background/models/consensus_background.hpp"
#include "core/base/bit_mask.hpp"
#include "core/base/geometry.hpp"
#include "core/base/memory/executor.hpp"

#include <algorithm>
#include <cstdint>

namespace rg::background {

/// The points of a grid: every step-th column and row from `margin` on to as far from the end.
struct PointGrid {
  Size size;
  int margin = 0, step = 1;

  [[nodiscard]] static constexpr PointGrid over(Size size, int margin) {
    constexpr int64_t kMostPoints = 4096;
    int step = 1;
    while (size.area() > kMostPoints * step * step) ++step;
    return {size, margin, step};
  }
  [[nodiscard]] constexpr int columns() const { return along(size.width); }
  [[nodiscard]] constexpr int rows() const { return along(size.height); }
  [[nodiscard]] constexpr int count() const { return columns() * rows(); }
  /// In raster order.
  [[nodiscard]] constexpr Point point(int i) const {
    return {margin + i % columns() * step, margin + i / columns() * step};
  }

 private:
  [[nodiscard]] constexpr int along(int length) const {
    const int inner = length - 2 * margin;
    return inner > 0 ? (inner + step - 1) / step : 0;
  }
};

/// How bright the points of a grid are.
struct LitPoints {
  uint32_t all = 0;     ///< Points.
  uint32_t bright = 0;  ///< Brighter than the level.
  uint32_t lit = 0;     ///< Something shines.
  uint32_t dim = 0;     ///< Neither black nor brighter than the level.

  constexpr void add(int brightness, int level) {
    constexpr int kBlack = 2;  // Grey levels up to which nothing shines and nothing is noise.
    constexpr int kLit = 64;   // And from which something shines.
    ++all;
    bright += brightness > level;
    lit += brightness >= kLit;
    dim += brightness > kBlack && brightness <= level;
  }
};
[[nodiscard]] LitPoints countLit(const SmoothPicture& picture, int level);
[[nodiscard]] constexpr bool isDark(const LitPoints& points) {
  const bool isOnBlack = 500 * points.lit >= points.all && points.dim <= points.lit;
  return 50 * points.bright <= points.all && !isOnBlack;
}

/// Points of a grid that have a colour, in the picture and in the model.
struct VividPoints {
  uint32_t all = 0, now = 0, before = 0;
};
[[nodiscard]] constexpr bool isVivid(int a, int b, int c) {
  constexpr int kLeastChroma = 20;
  const int most = std::max(std::max(a, b), c), least = std::min(std::min(a, b), c);
  return most - least >= kLeastChroma;
}
[[nodiscard]] VividPoints countVivid(const SmoothPicture& picture,
                                     const ConsensusBackground& model);
/// Of a colour picture.
[[nodiscard]] bool hasSwitchedColour(const VividPoints& points);

/// By how much the picture is off the model at the points of a grid, for each of its shifts round
/// one of them, and without any.
struct ShiftedSums {
  static constexpr int kReach = 3, kSide = 2 * kReach + 1, kShifts = kSide * kSide;
  static constexpr int kMostOff = 32;  ///< Grey levels that a point counts at most: it may be an
                                       ///< object's.
  uint32_t off[kShifts] = {};          ///< Of up to 2^16 points.
  uint32_t unmoved = 0;

  [[nodiscard]] static constexpr Point shift(int i) {
    return {i % kSide - kReach, i / kSide - kReach};
  }
};
/// The most that a shaken camera is looked for, each way.
[[nodiscard]] constexpr int mostShiftPx(Size size) {
  return std::max(ShiftedSums::kReach, std::min(size.width, size.height) / 12);
}
/// centre: of the shifts that are tried, within centreWithin().
[[nodiscard]] ShiftedSums sumShifted(const SmoothPicture& picture, const ConsensusBackground& model,
                                     Point centre);
[[nodiscard]] Point centreWithin(Point shift, Size size);

/// Nothing to be seen: no more than one point in 50 is brighter than `level`. Something lit before
/// pure black is seen all the same: there is no noise to be taken for it, as in drawn pictures.
[[nodiscard]] bool isDarkerThan(const SmoothPicture& picture, int level);

/// The picture has lost its colour against the model, or has got some: a camera that switched
/// between day and night (infra-red) view. Never in a grey picture.
[[nodiscard]] bool hasSwitchedColour(const SmoothPicture& picture,
                                     const ConsensusBackground& model);

/// How far the model's content is from where the picture shows it: model(p + shift) = picture(p).
struct Shift {
  Point by;
  uint32_t off = 0, unmoved = 0;  ///< By how much the two differ then, and without a shift.

  /// Whether it explains so much of the difference; share: of 256.
  [[nodiscard]] constexpr bool explains(uint32_t share) const {
    return 256 * uint64_t{off} <= (256 - share) * uint64_t{unmoved};
  }
};
/// The best of those looked at, the smallest of equal ones.
[[nodiscard]] Shift bestShift(const ShiftedSums& sums, Point centre);

/// Moves the picture's content by `shift`; its border is repeated. `spare` is scratch.
void shiftPicture(Point shift, const Executor& executor, SmoothPicture& spare,
                  SmoothPicture& picture);

/// How many of 8x8 fields of the frame have at least an eighth of their pixels set.
inline constexpr int kFieldsAlong = 8;
[[nodiscard]] constexpr Box fieldOf(Size frame, int column, int row) {
  const int left = frame.width * column / kFieldsAlong, top = frame.height * row / kFieldsAlong;
  return {left, top, frame.width * (column + 1) / kFieldsAlong - left,
          frame.height * (row + 1) / kFieldsAlong - top};
}
[[nodiscard]] constexpr bool isFull(const Box& field, int64_t setPx) {
  return 8 * setPx >= int64_t{field.height} * field.width;
}
[[nodiscard]] int countFullFields(const BitMask& raw);
[[nodiscard]] constexpr bool isEverywhere(int fullFields) {
  return 4 * fullFields >= 3 * kFieldsAlong * kFieldsAlong;
}

/// Of 8x8 fields of the frame three quarters have at least an eighth of their pixels set: no object
/// looks like that.
[[nodiscard]] bool isEverywhere(const BitMask& raw);

}  // namespace rg::background
