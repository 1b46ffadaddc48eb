// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/shadow.hpp"

#include "core/pixel.hpp"

#include <algorithm>
#include <array>
#include <numeric>

namespace rg {
namespace {

constexpr int kRadius = 2;
constexpr int64_t kMostResidual = 36;  ///< Square grey levels that noise and texture may leave.
constexpr int64_t kMostTint = 14;      ///< Grey levels that a channel may leave the factor's line.

/// Sums of picture I and background B over a window.
struct WindowSums {
  int64_t count = 0, i = 0, b = 0, ii = 0, ib = 0, bb = 0;
};

struct ColumnSums {
  std::array<uint32_t, kWordColumns + 2 * kRadius> i, b, ii, ib, bb;
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

bool isInRange(const WindowSums& s) {
  return s.i * 20 <= s.b * 19 && s.i * 5 >= s.b * 2;
}

/// One factor explains the window: the rest of I − (Σi / Σb) B is noise.
bool isDarkened(const WindowSums& s) {
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

/// The shadow among the pixels of one word of the mask.
uint64_t findInWord(const ColourPlanes& picture, const ColourPlanes& background, Point at,
                    uint64_t mask) {
  const Size size = picture.green.size;
  const int y = at.y, first = at.x * kWordColumns;
  const int begin = std::max(0, first - kRadius);
  const int end = std::min(size.width, first + kWordColumns + kRadius);
  ColumnSums columns;
  // Green stands for brightness: luma may have another range than the colours.
  sumColumns(picture.green, background.green, y, begin, end, columns);
  const int rows = std::min(size.height - 1, y + kRadius) - std::max(0, y - kRadius) + 1;
  uint64_t shadow = 0;
  forSetBits(mask, first, [&](int x) {
    const auto from = static_cast<size_t>(std::max(begin, x - kRadius) - begin);
    const auto to = static_cast<size_t>(std::min(end, x + kRadius + 1) - begin);
    const auto sum = [&](const auto& column) {
      return std::accumulate(column.begin() + from, column.begin() + to, int64_t{0});
    };
    WindowSums sums{
        rows * static_cast<int64_t>(to - from), sum(columns.i), sum(columns.b), 0, 0, 0};
    if (!isInRange(sums) || !keepsColour(picture, background, {x, y}, sums)) return;
    sums.ii = sum(columns.ii);
    sums.ib = sum(columns.ib);
    sums.bb = sum(columns.bb);
    if (isDarkened(sums)) shadow |= uint64_t{1} << (x - first);
  });
  return shadow;
}

}  // namespace

void findShadows(const ColourPlanes& picture, const ColourPlanes& background, const BitMask& mask,
                 const Executor& executor, BitMask& shadow) {
  executor.forRows(mask.height(), [&](int first, int last) {
    for (int y = first; y < last; ++y)
      for (int word = 0; word < mask.wordsPerRow(); ++word) {
        const uint64_t columns = mask.row(y)[word];
        shadow.row(y)[word] =
            columns == 0 ? 0 : findInWord(picture, background, {word, y}, columns);
      }
  });
}

}  // namespace rg
