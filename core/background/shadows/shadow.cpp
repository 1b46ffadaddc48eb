// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/shadows/shadow.hpp"

#include "core/background/shadows/shadow_window.hpp"

#include <algorithm>
#include <array>

namespace rg::background {
namespace {

constexpr int kRadius = kShadowRadius;

/// A pixel's window that may be cut off by the picture's border.
struct Window {
  int left, top, right, bottom;  ///< The last two are not part of it.
};

Window windowAround(Point p, Size size) {
  return {std::max(0, p.x - kRadius), std::max(0, p.y - kRadius),
          std::min(size.width, p.x + kRadius + 1), std::min(size.height, p.y + kRadius + 1)};
}

/// Sums over the windows of the columns of a word.
using WordSums = std::array<uint16_t, kWordColumns>;

/// Down the columns first, then across: the columns beyond the picture's border count nothing.
WordSums sumWindows(ImageView<const uint8_t> plane, Point at) {
  std::array<uint16_t, kWordColumns + 2 * kRadius> down{};
  const int first = at.x * kWordColumns - kRadius;
  const int begin = std::max(0, first);
  const int end = std::min(plane.width(), first + static_cast<int>(down.size()));
  const Window rows = windowAround({begin, at.y}, plane.size);
  for (int y = rows.top; y < rows.bottom; ++y) {
    const uint8_t* row = plane.row(y) + begin;
    uint16_t* to = down.data() + (begin - first);
    for (int x = 0; x < end - begin; ++x) to[x] = static_cast<uint16_t>(to[x] + row[x]);
  }
  WordSums sums{};
  for (size_t i = 0; i <= 2 * kRadius; ++i)
    for (size_t x = 0; x < sums.size(); ++x) sums[x] = static_cast<uint16_t>(sums[x] + down[x + i]);
  return sums;
}

void addProducts(ImageView<const uint8_t> picture, ImageView<const uint8_t> background,
                 const Window& window, WindowSums& sums) {
  sums.count = static_cast<int64_t>(window.right - window.left) * (window.bottom - window.top);
  int ii = 0, ib = 0, bb = 0;
  for (int y = window.top; y < window.bottom; ++y)
    for (int x = window.left; x < window.right; ++x) {
      const int i = picture.row(y)[x], b = background.row(y)[x];
      ii += i * i;
      ib += i * b;
      bb += b * b;
    }
  sums.ii = ii;
  sums.ib = ib;
  sums.bb = bb;
}

bool allKeepColour(const ColourPlanes& picture, const ColourPlanes& background, Point p,
                   const WindowSums& s) {
  const auto isNear = [&](ImageView<const uint8_t> now, ImageView<const uint8_t> before) {
    return keepsColour(now.at(p.x, p.y), before.at(p.x, p.y), s);
  };
  return isNear(picture.red, background.red) && isNear(picture.green, background.green) &&
         isNear(picture.blue, background.blue);
}

/// The shadow among the pixels of one word of the mask.
uint64_t findInWord(const ColourPlanes& picture, const ColourPlanes& background, Point at,
                    uint64_t mask) {
  // Green stands for brightness: luma may have another range than the colours.
  const WordSums i = sumWindows(picture.green, at), b = sumWindows(background.green, at);
  const int first = at.x * kWordColumns;
  uint64_t shadow = 0;
  forSetBits(mask, 0, [&](int column) {
    const Point p{first + column, at.y};
    WindowSums sums{0, i[static_cast<size_t>(column)], b[static_cast<size_t>(column)]};
    if (!isInRange(sums) || !allKeepColour(picture, background, p, sums)) return;
    addProducts(picture.green, background.green, windowAround(p, picture.green.size), sums);
    if (isDarkened(sums)) shadow |= uint64_t{1} << column;
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

}  // namespace rg::background
