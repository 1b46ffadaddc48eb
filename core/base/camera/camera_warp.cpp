// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/camera/camera_warp.hpp"

#include "core/base/camera/camera_pixels.hpp"
#include "core/simd/base/motion_rows.hpp"

#include <algorithm>

namespace rg {
namespace {

constexpr int kUnitBits = CameraMotion::kMotionBits;
constexpr int kUnit = kCameraMotion;

void warpByShift(ImageView<const uint8_t> previous, Point shift, const Executor& executor,
                 ImageView<uint8_t> expected, std::span<ShownRange> shown) {
  const auto wholeOf = [](int v) { return -((v + kUnit - 1) >> kUnitBits); };
  const auto partOf = [&](int v) { return -v - wholeOf(v) * kUnit; };
  const int dx = wholeOf(shift.x), dy = wholeOf(shift.y);
  const int u = partOf(shift.x), v = partOf(shift.y);
  const int width = previous.width(), height = previous.height();
  const int first = std::clamp(-dx, 0, width), last = std::clamp(width - 1 - dx, first, width);
  const ShownRange columns = shownAfterShift(width, shift.x),
                   rows = shownAfterShift(height, shift.y);
  executor.forRows(height, [&](int begin, int end) {
    for (int y = begin; y < end; ++y) {
      const uint8_t* above = previous.row(std::clamp(y + dy, 0, height - 1));
      const uint8_t* below = previous.row(std::clamp(y + dy + 1, 0, height - 1));
      uint8_t* to = expected.row(y);
      const auto repeatBorder = [&](int from, int until, int column) {
        const uint8_t sides[] = {above[column], above[column], below[column], below[column]};
        if (from == until) return;
        rg::simd::warpRow({sides, sides + 2, u, v}, 1, to + from);
        std::fill(to + from + 1, to + until, to[from]);
      };
      repeatBorder(0, first, 0);
      if (first < last)
        rg::simd::warpRow({above + first + dx, below + first + dx, u, v}, last - first, to + first);
      repeatBorder(last, width, width - 1);
      shown[static_cast<size_t>(y)] = y >= rows.first && y < rows.last ? columns : ShownRange{};
    }
  });
}

static_assert(kWarpSpan == rg::simd::kWarpSpan);

/// The four pixels round it, to the next sixteenth, are all in the picture.
constexpr bool isWellInside(Size size, Point place) {
  constexpr int kHalf = kCameraPlace / kUnit / 2;
  return place.x >= 0 && place.x + kHalf < (size.width - 1) * kCameraPlace && place.y >= 0 &&
         place.y + kHalf < (size.height - 1) * kCameraPlace;
}

/// A row of the frame, of which each pixel has a place of its own.
ShownRange warpRow(ImageView<const uint8_t> previous, const CameraMotion& camera, int y,
                   uint8_t* to) {
  ShownRange shown;
  Point from = camera.before(0, y);
  for (int x0 = 0; x0 < previous.width(); x0 += kWarpSpan) {
    const Point until = camera.before(x0 + kWarpSpan, y);
    const int count = std::min(kWarpSpan, previous.width() - x0);
    if (count == kWarpSpan && isWellInside(previous.size, from) &&
        isWellInside(previous.size, until)) {
      if (shown.last == 0) shown.first = x0;
      shown.last = x0 + kWarpSpan;
      rg::simd::warpSpan(
          {previous.data, previous.strideBytes, from.x, from.y, until.x - from.x, until.y - from.y},
          to + x0);
      from = until;
      continue;
    }
    for (int i = 0; i < count; ++i) {
      const Point place = placeBetween(from, until, i, kWarpSpan);
      if (showsPlace(previous.size, place)) {
        if (shown.last == 0) shown.first = x0 + i;
        shown.last = x0 + i + 1;
      }
      to[x0 + i] = warpedLevel(previous, place);
    }
    from = until;
  }
  return shown;
}

}  // namespace

void warpByCamera(ImageView<const uint8_t> previous, const CameraMotion& camera,
                  const Executor& executor, ImageView<uint8_t> expected,
                  std::span<ShownRange> shown) {
  if (camera.isShift()) return warpByShift(previous, camera.at(0, 0), executor, expected, shown);
  executor.forRows(previous.height(), [&](int begin, int end) {
    for (int y = begin; y < end; ++y)
      shown[static_cast<size_t>(y)] = warpRow(previous, camera, y, expected.row(y));
  });
}

}  // namespace rg
