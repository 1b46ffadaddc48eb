// SPDX-License-Identifier: LGPL-2.1-or-later
// How the picture of what stands still has moved since the previous frame: a homography, which a
// camera that turns, zooms or passes a plane makes of it.
//
// Determinism: integers; each place depends on the nine numbers alone.
#pragma once

#include "core/base/geometry.hpp"
#include "core/base/pixel.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

namespace rg {

/// What a motion does to directions and lengths: (xx x + xy y, yx x + yy y), in 1/kOne.
struct LinearMap {
  static constexpr int64_t kOne = 1 << 16;
  static constexpr int64_t kMost = 16 * kOne;  ///< Of a part, so that products fit.

  int64_t xx = kOne, xy = 0, yx = 0, yy = kOne;

  [[nodiscard]] constexpr Point of(Point p) const {
    const auto along = [&](int64_t byX, int64_t byY) {
      const int64_t value = divideRounded(byX * p.x + byY * p.y, kOne);
      return static_cast<int>(std::clamp<int64_t>(value, INT32_MIN, INT32_MAX));
    };
    return {along(xx, xy), along(yx, yy)};
  }
  /// How much longer things become on average, in 1/kOne.
  [[nodiscard]] constexpr int64_t scale() const {
    return integerSqrt(static_cast<uint64_t>(std::max<int64_t>(xx * yy - xy * yx, 0)));
  }
  /// Itself where it turns the picture over or makes a point of it.
  [[nodiscard]] constexpr LinearMap inverse() const {
    const int64_t area = (xx * yy - xy * yx) / kOne;
    if (area <= 0) return {};
    const auto part = [&](int64_t value) {
      return std::clamp(divideRounded(value * kOne, area), -kMost, kMost);
    };
    return {part(yy), part(-xy), part(-yx), part(xx)};
  }
};

/// From a place in this frame to the one where the same was in the previous frame.
class CameraMotion {
 public:
  static constexpr int kBits = 30;
  static constexpr int64_t kOne = int64_t{1} << kBits;
  static constexpr int kPlaceBits = 8;   ///< Places are told in 1/256 px,
  static constexpr int kMotionBits = 4;  ///< motions in 1/16 px.

  /// previous · w = (m0 x + m1 y + m2, m3 x + m4 y + m5), w = m6 x + m7 y + m8, all in 1/kOne, of
  /// places in pixels from `origin`.
  using Matrix = std::array<int64_t, 9>;

  CameraMotion() = default;
  /// The same everywhere, in 1/16 px.
  explicit constexpr CameraMotion(Point motion)
      : matrix_{kOne, 0,    -(int64_t{motion.x} << (kBits - kMotionBits)),
                0,    kOne, -(int64_t{motion.y} << (kBits - kMotionBits)),
                0,    0,    kOne} {}
  /// w has to be above kOne / 4 all over the frame.
  constexpr CameraMotion(const Matrix& matrix, Point origin) : matrix_(matrix), origin_(origin) {}

  /// Whether all that is computed with it fits.
  [[nodiscard]] constexpr bool isSafe() const {
    const auto isWithin = [](int64_t value, int bits) {
      return value >= -(int64_t{1} << bits) && value <= int64_t{1} << bits;
    };
    const auto rowFits = [&](size_t row) {
      return isWithin(matrix_[row], kBits + 2) && isWithin(matrix_[row + 1], kBits + 2) &&
             isWithin(matrix_[row + 2], kBits + 16);
    };
    return rowFits(0) && rowFits(3) && isWithin(matrix_[6], kBits) && isWithin(matrix_[7], kBits) &&
           matrix_[8] == kOne && isWithin(origin_.x, 14) && isWithin(origin_.y, 14);
  }
  [[nodiscard]] constexpr const Matrix& matrix() const { return matrix_; }
  [[nodiscard]] constexpr Point origin() const { return origin_; }
  /// Whether all places move alike.
  [[nodiscard]] constexpr bool isUniform() const {
    return matrix_[0] == kOne && matrix_[4] == kOne && matrix_[8] == kOne && matrix_[1] == 0 &&
           matrix_[3] == 0 && matrix_[6] == 0 && matrix_[7] == 0;
  }
  /// The same, by whole sixteenths of a pixel.
  [[nodiscard]] constexpr bool isShift() const {
    constexpr int64_t kRest = (int64_t{1} << (kBits - kMotionBits)) - 1;
    return isUniform() && (matrix_[2] & kRest) == 0 && (matrix_[5] & kRest) == 0;
  }
  /// Where pixel (x, y) was, in 1/256 px. Beyond ±2^14 all is as it is there: 2^30 · 2^15 · 2^8
  /// fit.
  [[nodiscard]] constexpr Point before(int x, int y) const {
    const int64_t u = bounded(x) - origin_.x, v = bounded(y) - origin_.y;
    // What lies far outside of the frame may be anywhere.
    const int64_t w = std::max(matrix_[6] * u + matrix_[7] * v + matrix_[8], kOne / 4);
    const auto along = [&](size_t row, int origin) {
      const int64_t at = matrix_[row] * u + matrix_[row + 1] * v + matrix_[row + 2];
      return static_cast<int>((int64_t{origin} << kPlaceBits) +
                              divideRounded(at * (1 << kPlaceBits), w));
    };
    return {along(0, origin_.x), along(3, origin_.y)};
  }
  /// By how much what is at (x, y) has moved, in 1/16 px.
  [[nodiscard]] constexpr Point at(int x, int y) const {
    const Point was = before(x, y);
    constexpr int kUnit = 1 << (kPlaceBits - kMotionBits);
    return {static_cast<int>(divideRounded((bounded(x) << kPlaceBits) - was.x, kUnit)),
            static_cast<int>(divideRounded((bounded(y) << kPlaceBits) - was.y, kUnit))};
  }
  /// By how much what was at `place` in the previous frame has moved; both in 1/16 px.
  [[nodiscard]] constexpr Point since(Point place) const {
    const auto px = [](int64_t v) {
      return static_cast<int>(
          divideRounded(std::clamp<int64_t>(v, INT32_MIN, INT32_MAX), 1 << kMotionBits));
    };
    Point by;
    for (int step = 0; step < 2; ++step)
      by = at(px(int64_t{place.x} + by.x), px(int64_t{place.y} + by.y));
    return by;
  }
  /// How directions and lengths near pixel (x, y) have changed since the previous frame.
  [[nodiscard]] constexpr LinearMap around(int x, int y) const {
    const int64_t u = bounded(x) - origin_.x, v = bounded(y) - origin_.y;
    const int64_t w = std::max(matrix_[6] * u + matrix_[7] * v + matrix_[8], kOne / 4);
    const Point was = before(x, y);
    const auto px = [](int place) {
      return bounded(static_cast<int>(divideRounded(place, 1 << kPlaceBits)));
    };
    const int64_t beforeX = px(was.x) - origin_.x, beforeY = px(was.y) - origin_.y;
    // 2^32 + 2^15 · 2^30, times 2^16, fit.
    const auto slope = [&](size_t at, size_t row, int64_t place) {
      return std::clamp(divideRounded((matrix_[at] - place * matrix_[row]) * LinearMap::kOne, w),
                        -LinearMap::kMost, LinearMap::kMost);
    };
    return LinearMap{slope(0, 6, beforeX), slope(1, 7, beforeX), slope(3, 6, beforeY),
                     slope(4, 7, beforeY)}
        .inverse();
  }
  friend constexpr bool operator==(const CameraMotion&, const CameraMotion&) = default;

 private:
  [[nodiscard]] static constexpr int64_t bounded(int place) {
    return std::clamp(place, -(1 << 14), 1 << 14);
  }

  Matrix matrix_{kOne, 0, 0, 0, kOne, 0, 0, 0, kOne};
  Point origin_;
};

}  // namespace rg
