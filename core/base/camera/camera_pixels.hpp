// SPDX-License-Identifier: LGPL-2.1-or-later
// The arithmetic of picture_blocks.hpp and camera_warp.hpp that every backend shares.
#pragma once

#include "core/base/camera/camera_motion.hpp"
#include "core/base/camera/camera_warp.hpp"
#include "core/base/camera/picture_blocks.hpp"
#include "core/base/memory/image.hpp"
#include "core/base/pixel.hpp"

#include <algorithm>
#include <cstdint>

namespace rg {

inline constexpr int kCameraPlace = 1 << CameraMotion::kPlaceBits;    ///< A pixel, in places,
inline constexpr int kCameraMotion = 1 << CameraMotion::kMotionBits;  ///< and in motions.

/// The i-th of `count` places from `first` on, of which the one after the last is `last`.
[[nodiscard]] constexpr Point placeBetween(Point first, Point last, int i, int count) {
  const auto along = [&](int a, int b) {
    return a + static_cast<int>((int64_t{b} - a) * i / count);
  };
  return {along(first.x, last.x), along(first.y, last.y)};
}

/// Whether a picture shows what lies at a place.
[[nodiscard]] constexpr bool showsPlace(Size size, Point place) {
  return place.x >= 0 && place.x <= (size.width - 1) * kCameraPlace && place.y >= 0 &&
         place.y <= (size.height - 1) * kCameraPlace;
}

/// The mean of the four pixels round a place within the picture, weighed by 1 / (unit · unit); the
/// border repeats. What it is called with tells how finely: `right` and `low` of `unit`.
struct BetweenPixels {
  int column, row, right, low, unit;
  [[nodiscard]] constexpr int sumOf(ImageView<const uint8_t> picture) const {
    const uint8_t* upper = picture.row(row) + column;
    const uint8_t* lower = picture.row(std::min(row + 1, picture.height() - 1)) + column;
    const int next = column + 1 < picture.width() ? 1 : 0;
    const int above = upper[0] * (unit - right) + upper[next] * right;
    const int below = lower[0] * (unit - right) + lower[next] * right;
    return above * (unit - low) + below * low;
  }
};

// ---- camera_warp.hpp

inline constexpr int kWarpSpan = 16;  ///< Columns between exact places; a power of two.

/// The level at any place, which is taken in sixteenths.
[[nodiscard]] constexpr uint8_t warpedLevel(ImageView<const uint8_t> previous, Point place) {
  constexpr int kRest = CameraMotion::kPlaceBits - CameraMotion::kMotionBits;
  constexpr int kHalf = 1 << (kRest - 1);
  const int x = std::clamp(place.x + kHalf, 0, (previous.width() - 1) * kCameraPlace);
  const int y = std::clamp(place.y + kHalf, 0, (previous.height() - 1) * kCameraPlace);
  const BetweenPixels at{x >> CameraMotion::kPlaceBits, y >> CameraMotion::kPlaceBits,
                         (x & (kCameraPlace - 1)) >> kRest, (y & (kCameraPlace - 1)) >> kRest,
                         kCameraMotion};
  return static_cast<uint8_t>(roundShift(at.sumOf(previous), 2 * CameraMotion::kMotionBits));
}

/// Rows or columns that the previous frame shows as well when all moves by `shift` sixteenths.
[[nodiscard]] constexpr ShownRange shownAfterShift(int length, int shift) {
  const int whole = shift >> CameraMotion::kMotionBits;
  const bool isWhole = shift % kCameraMotion == 0;
  return {std::clamp(whole + (isWhole ? 0 : 1), 0, length), std::clamp(length + whole, 0, length)};
}
static_assert(shownAfterShift(9, 17).first == 2 && shownAfterShift(9, 17).last == 9 &&
              shownAfterShift(9, -17).first == 0 && shownAfterShift(9, -17).last == 7);

// ---- picture_blocks.hpp

[[nodiscard]] constexpr uint8_t meanOfSum(uint32_t sum, uint32_t pixels) {
  return static_cast<uint8_t>((sum + pixels / 2) / pixels);
}

/// The mean of the box that is number `box` in its row and column, rounded.
[[nodiscard]] constexpr uint8_t meanOfBox(ImageView<const uint8_t> from, int side, Point box) {
  uint32_t sum = 0;
  for (int y = 0; y < side; ++y) {
    const uint8_t* pixel = from.row(box.y * side + y) + box.x * side;
    for (int x = 0; x < side; ++x) sum += pixel[x];
  }
  return meanOfSum(sum, static_cast<uint32_t>(side * side));
}

/// Shifts along x or y; none where `last` is below `first`.
struct ShiftSpan {
  int first, last;
  [[nodiscard]] constexpr int count() const { return last < first ? 0 : last - first + 1; }
  /// Those up to `reach` from `middle` by which a block that begins at `at` has moved from within
  /// `length` pixels.
  [[nodiscard]] static constexpr ShiftSpan of(int at, int length, int middle, int reach) {
    return {std::max(middle - reach, at + kCameraBlock - length), std::min(middle + reach, at)};
  }
};
static_assert(ShiftSpan::of(8, 24, 0, 9).first == -8 && ShiftSpan::of(8, 24, 0, 9).last == 8 &&
              ShiftSpan::of(8, 24, 40, 9).count() == 0);

inline constexpr int kMostCameraReach = 1 << 11;  ///< What ranks have bits for.

/// The smallest is the best match: (SAD, distance from the middle, dy, dx), of which `apart` are
/// the last two, less the middle. A SAD has 14 bits, a distance 24.
[[nodiscard]] constexpr uint64_t rankOfMatch(uint32_t sad, Point apart) {
  const auto distance = static_cast<uint32_t>(apart.x * apart.x + apart.y * apart.y);
  return uint64_t{sad} << 48 | uint64_t{distance} << 24 |
         static_cast<uint64_t>(apart.y + kMostCameraReach) << 12 |
         static_cast<uint64_t>(apart.x + kMostCameraReach);
}
static_assert(255 * kCameraBlock * kCameraBlock < 1 << 14);
static_assert(rankOfMatch(2, {9, 9}) < rankOfMatch(3, {}) &&
              rankOfMatch(2, {0, 1}) < rankOfMatch(2, {-1, 1}) &&
              rankOfMatch(2, {9, -1}) < rankOfMatch(2, {-9, 1}) &&
              rankOfMatch(2, {-1, 1}) < rankOfMatch(2, {1, 1}));

[[nodiscard]] constexpr BlockMatch matchOfRank(uint64_t rank, Point middle) {
  constexpr int kMask = 2 * kMostCameraReach - 1;
  return {static_cast<uint32_t>(rank >> 48),
          {middle.x + static_cast<int>(rank & kMask) - kMostCameraReach,
           middle.y + static_cast<int>(rank >> 12 & kMask) - kMostCameraReach}};
}
static_assert(matchOfRank(rankOfMatch(77, {-3, 5}), {10, 20}).shift == Point{7, 25} &&
              matchOfRank(rankOfMatch(77, {-3, 5}), {10, 20}).sad == 77);

/// The luma at a place within the picture, in 1/16 grey level.
inline constexpr int kLevelUnit = 16;
[[nodiscard]] constexpr int levelAtPlace(ImageView<const uint8_t> picture, Point place) {
  constexpr int kRest = kCameraPlace * kCameraPlace / kLevelUnit;
  const BetweenPixels at{place.x / kCameraPlace, place.y / kCameraPlace, place.x % kCameraPlace,
                         place.y % kCameraPlace, kCameraPlace};
  return (at.sumOf(picture) + kRest / 2) / kRest;
}

/// Adds what the pixel `p` of `now` says that was at a place within the picture before.
constexpr void addPixel(ImageView<const uint8_t> now, Point p, ImageView<const uint8_t> before,
                        Point place, BlockSums& sums) {
  const uint8_t* row = now.row(p.y);
  const int gx = row[std::min(p.x + 1, now.width() - 1)] - row[std::max(p.x - 1, 0)];
  const int gy =
      now.row(std::min(p.y + 1, now.height() - 1))[p.x] - now.row(std::max(p.y - 1, 0))[p.x];
  const int e = kLevelUnit * row[p.x] - levelAtPlace(before, place);
  sums.xx += gx * gx;
  sums.xy += gx * gy;
  sums.yy += gy * gy;
  sums.xe += gx * e;
  sums.ye += gy * e;
  sums.ee += static_cast<uint64_t>(int64_t{e} * e);
  ++sums.pixels;
}

}  // namespace rg
