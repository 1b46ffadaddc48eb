// SPDX-License-Identifier: LGPL-2.1-or-later
// What a region's pixels say of a motion that is linear in the position (part of stage 4): the sums
// of core/motion/fit_sums.hpp over its cells, with the cells' places.
//
// Each 8x8 cell is seen at one displacement, that of its middle. Cells of which a part has entered
// the frame since the previous one are left out. Determinism: integer sums.
#pragma once

#include "core/motion/fit_sums.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

namespace rg::motion {

inline constexpr int kSlopeUnitPx = 32;
/// Beyond it from the centroid a region moves as it does there.
inline constexpr int kMostOffsetPx = 512;

/// The same picture before and after, as it is or smoothed.
struct FitPlane {
  ImageView<const uint8_t> current;
  const PaddedLuma* previous = nullptr;
};

/// A displacement at the centroid, 1/256 px, and how it changes with the place: of x along x and y,
/// of y along x and y, in 1/256 px per kSlopeUnitPx.
struct FitField {
  Point at;
  std::array<int, 4> slopes{};
  Point centroid;  ///< In pixels.
};

/// Sums over cells; moments stay below 2^41 · 2^18.
struct FitMoments {
  /// Times 1, x, y, x², xy and y² of the cell's offset from the centroid, in pixels.
  std::array<int64_t, 6> xx{}, xy{}, yy{};
  /// Times 1, x and y.
  std::array<int64_t, 3> xr{}, yr{}, x{}, y{};
  int64_t pixels = 0, seen = 0, r = 0, rr = 0, misfit = 0;
  friend bool operator==(const FitMoments&, const FitMoments&) = default;
};

// No references to constants: a device has none of the host's.
constexpr Point offsetOf(const MatchedCell& cell, Point centroid) {
  const auto bounded = [](int d) {
    return d < -kMostOffsetPx ? -kMostOffsetPx : d > kMostOffsetPx ? kMostOffsetPx : d;
  };
  return {bounded(cell.x + kCellSize / 2 - centroid.x),
          bounded(cell.y + kCellSize / 2 - centroid.y)};
}

constexpr Point displacementAt(const FitField& field, Point offset, int reach) {
  const int most = reach * kFine - 1;
  const auto along = [&](int at, int slopeX, int slopeY) {
    return std::clamp(at + (slopeX * offset.x + slopeY * offset.y) / kSlopeUnitPx, -most, most);
  };
  return {along(field.at.x, field.slopes[0], field.slopes[1]),
          along(field.at.y, field.slopes[2], field.slopes[3])};
}

/// What enters the frame has no match in the previous one.
constexpr bool isVisible(const MatchedCell& cell, Point d, Size size) {
  const auto isInside = [](int first, int shift, int length) {
    const int end = std::min(first + kCellSize, length);
    return first * kFine >= shift && (end - 1) * kFine - shift <= (length - 1) * kFine;
  };
  return isInside(cell.x, d.x, size.width) && isInside(cell.y, d.y, size.height);
}

/// Of a cell, or of a part of it.
constexpr void addCell(const FitSums& sums, Point offset, FitMoments& moments) {
  const int x = offset.x, y = offset.y;
  const int places[] = {1, x, y, x * x, x * y, y * y};
  for (size_t i = 0; i < 6; ++i) {
    moments.xx[i] += int64_t{sums.xx} * places[i];
    moments.xy[i] += int64_t{sums.xy} * places[i];
    moments.yy[i] += int64_t{sums.yy} * places[i];
  }
  for (size_t i = 0; i < 3; ++i) {
    moments.xr[i] += int64_t{sums.xr} * places[i];
    moments.yr[i] += int64_t{sums.yr} * places[i];
    moments.x[i] += int64_t{sums.x} * places[i];
    moments.y[i] += int64_t{sums.y} * places[i];
  }
  moments.pixels += sums.pixels;
  moments.seen += sums.seen;
  moments.r += sums.r;
  moments.rr += sums.rr;
  moments.misfit += sums.misfit;
}

inline constexpr int kMoments = 35;
/// Number `i` of the moments, in the order in which they stand.
template <class Moments>
constexpr auto& momentOf(Moments& m, size_t i) {
  if (i < 18) return i < 6 ? m.xx[i] : i < 12 ? m.xy[i - 6] : m.yy[i - 12];
  if (i < 24) return i < 21 ? m.xr[i - 18] : m.yr[i - 21];
  if (i < 30) return i < 27 ? m.x[i - 24] : m.y[i - 27];
  if (i < 33) return i == 30 ? m.pixels : i == 31 ? m.seen : m.r;
  return i == 33 ? m.rr : m.misfit;
}
/// What addCell() adds to it.
constexpr int64_t momentOf(const FitSums& sums, Point offset, int i) {
  const auto placeOf = [&](int place) {
    const int x = offset.x, y = offset.y;
    const int first = place == 0 ? 1 : place == 1 ? x : y;
    return place < 3 ? first : place == 3 ? x * x : place == 4 ? x * y : y * y;
  };
  if (i < 18) return int64_t{i < 6 ? sums.xx : i < 12 ? sums.xy : sums.yy} * placeOf(i % 6);
  if (i < 24) return int64_t{i < 21 ? sums.xr : sums.yr} * placeOf(i % 3);
  if (i < 30) return int64_t{i < 27 ? sums.x : sums.y} * placeOf(i % 3);
  if (i < 33) return i == 30 ? sums.pixels : i == 31 ? sums.seen : sums.r;
  return i == 33 ? sums.rr : sums.misfit;
}

/// limit: as for sumFit. On the best instructions that the machine has; the same bits as
/// sumMomentsPlainly on all.
[[nodiscard]] FitMoments sumMoments(std::span<const MatchedPart> parts, const FitPlane& plane,
                                    const FitField& field, int limit);

/// The same pixel by pixel: what it means.
[[nodiscard]] FitMoments sumMomentsPlainly(std::span<const MatchedPart> parts,
                                           const FitPlane& plane, const FitField& field, int limit);

}  // namespace rg::motion
