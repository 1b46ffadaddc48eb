// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/shadow.hpp"

#include "core/pixel.hpp"

#include <algorithm>
#include <array>
#include <cstring>

namespace rg {
namespace {

constexpr int kRadius = 2;
constexpr int kBlock = 256;            ///< Columns at a time: sums live on the stack.
constexpr int64_t kMostResidual = 36;  ///< Square grey levels that noise and texture may leave.
constexpr int64_t kMostTint = 14;      ///< Grey levels that a channel may leave the factor's line.

/// Sums of picture I and background B over a window.
struct WindowSums {
  int64_t count = 0, i = 0, b = 0, ii = 0, ib = 0, bb = 0;
};

struct ColumnSums {
  std::array<uint32_t, kBlock + 2 * kRadius> i, b, ii, ib, bb;
};

void sumColumns(ImageView<const uint8_t> picture, ImageView<const uint8_t> background, int y,
                int begin, int end, ColumnSums& sums) {
  const auto count = static_cast<size_t>(end - begin);
  for (auto* column : {&sums.i, &sums.b, &sums.ii, &sums.ib, &sums.bb})
    std::fill_n(column->begin(), count, 0u);
  const int last = std::min(picture.height() - 1, y + kRadius);
  for (int row = std::max(0, y - kRadius); row <= last; ++row) {
    const uint8_t* now = picture.row(row) + begin;
    const uint8_t* before = background.row(row) + begin;
    for (size_t x = 0; x < count; ++x) {
      const uint32_t i = now[x], b = before[x];
      sums.i[x] += i;
      sums.b[x] += b;
      sums.ii[x] += i * i;
      sums.ib[x] += i * b;
      sums.bb[x] += b * b;
    }
  }
}

/// One factor in range explains the window: the rest of I − (Σi / Σb) B is noise.
bool isDarkened(const WindowSums& s) {
  if (s.i * 20 > s.b * 19 || s.i * 5 < s.b * 2) return false;
  const int64_t squareB = s.b * s.b;  // Sums below 25 · 255² keep all products under 2⁵⁰.
  const int64_t rest = s.ii * squareB - 2 * s.i * s.b * s.ib + s.i * s.i * s.bb;
  return rest <= s.count * kMostResidual * squareB;
}

bool keepsColour(const ColourPlanes& picture, const ColourPlanes& background, Point p,
                 const WindowSums& s) {
  const auto isNear = [&](ImageView<const uint8_t> now, ImageView<const uint8_t> before) {
    const int64_t off = now.at(p.x, p.y) * s.b - before.at(p.x, p.y) * s.i;
    return off <= kMostTint * s.b && -off <= kMostTint * s.b;
  };
  return isNear(picture.red, background.red) && isNear(picture.green, background.green) &&
         isNear(picture.blue, background.blue);
}

void markBlock(const ColourPlanes& picture, const ColourPlanes& background, const Box& block,
               const uint8_t* mask, uint8_t* shadow) {
  const int y = block.y;
  const int begin = std::max(0, block.x - kRadius);
  const int end = std::min(picture.green.size.width, block.right() + kRadius);
  ColumnSums columns;
  // Green stands for brightness: luma may have another range than the colours.
  sumColumns(picture.green, background.green, y, begin, end, columns);
  const int rows =
      std::min(picture.green.size.height - 1, y + kRadius) - std::max(0, y - kRadius) + 1;
  for (int x = block.x; x < block.right(); ++x) {
    if (mask[x] == 0) continue;
    WindowSums sums;
    const int from = std::max(begin, x - kRadius), to = std::min(end, x + kRadius + 1);
    for (int i = from; i < to; ++i) {
      const auto column = static_cast<size_t>(i - begin);
      sums.i += columns.i[column];
      sums.b += columns.b[column];
      sums.ii += columns.ii[column];
      sums.ib += columns.ib[column];
      sums.bb += columns.bb[column];
    }
    sums.count = int64_t{rows} * (to - from);
    if (isDarkened(sums) && keepsColour(picture, background, {x, y}, sums)) shadow[x] = 255;
  }
}

}  // namespace

void findShadows(const ColourPlanes& picture, const ColourPlanes& background,
                 ImageView<const uint8_t> mask, const Executor& executor,
                 ImageView<uint8_t> shadow) {
  const int width = picture.green.size.width;
  executor.forRows(picture.green.size.height, [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      const uint8_t* row = mask.row(y);
      std::memset(shadow.row(y), 0, static_cast<size_t>(width));
      for (int x = 0; x < width; x += kBlock) {
        const int end = std::min(width, x + kBlock);
        if (std::any_of(row + x, row + end, [](uint8_t value) { return value != 0; }))
          markBlock(picture, background, {x, y, end - x, 1}, row, shadow.row(y));
      }
    }
  });
}

}  // namespace rg
