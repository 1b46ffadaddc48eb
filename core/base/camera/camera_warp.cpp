// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/camera/camera_warp.hpp"

#include "core/simd/base/motion_rows.hpp"

#include <algorithm>

namespace rg {
namespace {

constexpr int kSpan = 16;  // Columns; a power of two.
constexpr int kPlace = 1 << CameraMotion::kPlaceBits;
constexpr int kUnitBits = CameraMotion::kMotionBits;
constexpr int kUnit = 1 << kUnitBits;

/// Rows or columns that the previous frame shows as well.
ShownRange shownBy(int length, int shift) {
  const int whole = shift >> kUnitBits;
  const bool isWhole = shift % kUnit == 0;
  return {std::clamp(whole + (isWhole ? 0 : 1), 0, length), std::clamp(length + whole, 0, length)};
}

void warpByShift(ImageView<const uint8_t> previous, Point shift, const Executor& executor,
                 ImageView<uint8_t> expected, std::span<ShownRange> shown) {
  const auto wholeOf = [](int v) { return -((v + kUnit - 1) >> kUnitBits); };
  const auto partOf = [&](int v) { return -v - wholeOf(v) * kUnit; };
  const int dx = wholeOf(shift.x), dy = wholeOf(shift.y);
  const int u = partOf(shift.x), v = partOf(shift.y);
  const int width = previous.width(), height = previous.height();
  const int first = std::clamp(-dx, 0, width), last = std::clamp(width - 1 - dx, first, width);
  const ShownRange columns = shownBy(width, shift.x), rows = shownBy(height, shift.y);
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

/// A row of the frame, of which each pixel has a place of its own.
class RowWarp {
 public:
  RowWarp(ImageView<const uint8_t> previous, const CameraMotion& camera)
      : previous_(previous),
        camera_(camera),
        mostX_((previous.width() - 1) * kPlace),
        mostY_((previous.height() - 1) * kPlace) {}

  [[nodiscard]] ShownRange run(int y, uint8_t* to) {
    shown_ = {};
    Point from = camera_.before(0, y);
    for (int x = 0; x < previous_.width(); x += kSpan) {
      const Point until = camera_.before(x + kSpan, y);
      runSpan(from, until, x, to);
      from = until;
    }
    return shown_;
  }

 private:
  void runSpan(Point from, Point until, int x0, uint8_t* to) {
    const int count = std::min(kSpan, previous_.width() - x0);
    const int dx = until.x - from.x, dy = until.y - from.y;
    for (int i = 0; i < count; ++i) {
      const int x = from.x + dx * i / kSpan, y = from.y + dy * i / kSpan;
      if (x >= 0 && x <= mostX_ && y >= 0 && y <= mostY_) {
        if (shown_.last == 0) shown_.first = x0 + i;
        shown_.last = x0 + i + 1;
      }
      to[x0 + i] = sample(x, y);
    }
  }

  [[nodiscard]] uint8_t sample(int x, int y) const {
    constexpr int kRest = CameraMotion::kPlaceBits - kUnitBits;
    x = std::clamp(x + (1 << (kRest - 1)), 0, mostX_);
    y = std::clamp(y + (1 << (kRest - 1)), 0, mostY_);
    const int column = x >> CameraMotion::kPlaceBits, row = y >> CameraMotion::kPlaceBits;
    const int right = (x & (kPlace - 1)) >> kRest, low = (y & (kPlace - 1)) >> kRest;
    const uint8_t* upper = previous_.row(row) + column;
    const uint8_t* lower = previous_.row(std::min(row + 1, previous_.height() - 1)) + column;
    const int next = column + 1 < previous_.width() ? 1 : 0;
    const int above = upper[0] * (kUnit - right) + upper[next] * right;
    const int below = lower[0] * (kUnit - right) + lower[next] * right;
    return static_cast<uint8_t>((above * (kUnit - low) + below * low + kUnit * kUnit / 2) >>
                                (2 * kUnitBits));
  }

  ImageView<const uint8_t> previous_;
  const CameraMotion& camera_;
  int mostX_, mostY_;
  ShownRange shown_;
};

}  // namespace

void warpByCamera(ImageView<const uint8_t> previous, const CameraMotion& camera,
                  const Executor& executor, ImageView<uint8_t> expected,
                  std::span<ShownRange> shown) {
  if (camera.isShift()) return warpByShift(previous, camera.at(0, 0), executor, expected, shown);
  executor.forRows(previous.height(), [&](int begin, int end) {
    RowWarp warp(previous, camera);
    for (int y = begin; y < end; ++y) shown[static_cast<size_t>(y)] = warp.run(y, expected.row(y));
  });
}

}  // namespace rg
