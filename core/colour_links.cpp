// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/colour_links.hpp"

#include "core/background.hpp"
#include "core/simd/link_rows.hpp"

#include <algorithm>

namespace rg {
namespace {

/// Writes the mean of each pixel and its two neighbours, weights 1 2 1; the row's ends repeat.
void smoothAcross(const uint8_t* from, int width, Span span, uint8_t* to) {
  if (span.first >= span.last) return;
  const int first = std::max(span.first, 1), last = std::min(span.last, width - 1);
  if (first < last)
    simd::smoothRow(from + first - 1, from + first + 1, from + first, last - first, to + first);
  const int end = width - 1;
  if (span.first == 0) simd::smoothRow(from, from + std::min(1, end), from, 1, to);
  if (span.last == width)
    simd::smoothRow(from + std::max(end - 1, 0), from + end, from + end, 1, to + end);
}

/// Pairs with a pixel out of scope are none.
void voidPairs(const uint8_t* maskA, const uint8_t* maskB, int count, uint8_t* to) {
  for (int i = 0; i < count; ++i)
    if (maskA[i] != kForegroundPixel || maskB[i] != kForegroundPixel) to[i] = kNoPair;
}

}  // namespace

void ColourLinks::build(const Picture& picture, ImageView<const uint8_t> mask,
                        const LinkParams& params, const Executor& executor) {
  size_ = picture.size();
  channels_ = picture.isGrey() ? 1 : 3;
  const Planes planes{picture.red(), picture.green(), picture.blue()};
  left_.resize({size_.width + 1, size_.height});
  up_.resize({size_.width, size_.height + 1});
  nearest_.resize(size_);
  links_.resize(size_);
  findSpans(mask, executor);
  band_ = params.band;
  smooth(planes, executor);

  const auto forRows = [&](auto&& work) {
    executor.forRows(size_.height, [&](int first, int last) {
      for (int y = first; y < last; ++y) work(y);
    });
  };
  const bool guards = channels_ == 3 && band_.count > 0;
  if (guards) {
    hues_.resize(size_);
    forRows([&](int y) {
      const Span row = span(y);
      if (row.first < row.last)
        simd::findHueRow(smooth_[0].row(y) + row.first, smooth_[1].row(y) + row.first,
                         smooth_[2].row(y) + row.first, row.last - row.first, band_,
                         hues_.row(y) + row.first);
    });
  }
  forRows([&](int y) {
    measure(y, mask);
    if (guards) guardHues(y);
  });
  std::fill_n(up_.row(size_.height), size_.width, kNoPair);
  if (params.joinsSingles) forRows([&](int y) { chooseNearest(y); });
  forRows([&](int y) { link(y, mask, params); });
}

void ColourLinks::findSpans(ImageView<const uint8_t> mask, const Executor& executor) {
  spans_.assign(static_cast<size_t>(size_.height), Span{0, size_.width});
  if (mask.data == nullptr) return;
  executor.forRows(size_.height, [&](int firstRow, int lastRow) {
    for (int y = firstRow; y < lastRow; ++y) {
      const uint8_t* row = mask.row(y);
      const uint8_t* end = row + size_.width;
      const uint8_t* first = std::find(row, end, kForegroundPixel);
      const uint8_t* last = end;
      while (last != first && last[-1] != kForegroundPixel) --last;
      spans_[static_cast<size_t>(y)] = {static_cast<int>(first - row),
                                        static_cast<int>(last - row)};
    }
  });
}

Span ColourLinks::hull(int y, int above, int below) const {
  Span result{size_.width, 0};
  for (int i = std::max(0, y - above); i <= std::min(size_.height - 1, y + below); ++i) {
    const Span row = span(i);
    if (row.first >= row.last) continue;
    result = {std::min(result.first, row.first), std::max(result.last, row.last)};
  }
  return result;
}

void ColourLinks::smooth(const Planes& planes, const Executor& executor) {
  for (int c = 0; c < channels_; ++c) {
    const auto i = static_cast<size_t>(c);
    across_[i].resize(size_);
    smooth_[i].resize(size_);
    executor.forRows(size_.height, [&](int first, int last) {
      for (int y = first; y < last; ++y)
        smoothAcross(planes[i].row(y), size_.width, hull(y, 1, 1), across_[i].row(y));
    });
    executor.forRows(size_.height, [&](int first, int last) {
      for (int y = first; y < last; ++y) {
        const Span row = span(y);
        simd::smoothRow(across_[i].row(std::max(y - 1, 0)) + row.first,
                        across_[i].row(std::min(y + 1, size_.height - 1)) + row.first,
                        across_[i].row(y) + row.first, row.last - row.first,
                        smooth_[i].row(y) + row.first);
      }
    });
  }
}

// Over the span of this row and the one above: the pairs that end outside must be void, too.
void ColourLinks::measure(int y, ImageView<const uint8_t> mask) {
  const Span row = hull(y, 1, 0);
  const int count = row.last - row.first;
  uint8_t* left = left_.row(y);
  uint8_t* up = up_.row(y);
  left[row.first] = left[std::max(row.last, row.first)] = kNoPair;
  if (count <= 0) return;
  simd::PixelPairs across{channels_, {}, {}}, down{channels_, {}, {}};
  for (int c = 0; c < channels_; ++c) {
    const Image<uint8_t>& pixels = smooth_[static_cast<size_t>(c)];
    across.a[c] = pixels.row(y) + row.first;
    across.b[c] = across.a[c] + 1;
    down.a[c] = pixels.row(std::max(y - 1, 0)) + row.first;
    down.b[c] = across.a[c];
  }
  simd::measureRow(across, count - 1, kFarthest, left + row.first + 1);
  if (y > 0) simd::measureRow(down, count, kFarthest, up + row.first);
  if (y == 0) std::fill_n(up + row.first, count, kNoPair);
  if (mask.data == nullptr) return;
  const uint8_t* scope = mask.row(y) + row.first;
  voidPairs(scope, scope + 1, count - 1, left + row.first + 1);
  if (y > 0) voidPairs(mask.row(y - 1) + row.first, scope, count, up + row.first);
}

void ColourLinks::guardHues(int y) {
  const Span row = span(y);
  const int count = row.last - row.first;
  if (count <= 0) return;
  const simd::HueGuard guard{kHueGuard, kFarthest};
  const int16_t* hues = hues_.row(y) + row.first;
  simd::guardRow(hues, hues + 1, count - 1, guard, left_.row(y) + row.first + 1);
  if (y > 0)
    simd::guardRow(hues_.row(y - 1) + row.first, hues, count, guard, up_.row(y) + row.first);
}

void ColourLinks::chooseNearest(int y) {
  const Span row = span(y);
  simd::chooseRow({left_.row(y) + row.first, up_.row(y) + row.first, up_.row(y + 1) + row.first},
                  row.last - row.first, kNoPair, nearest_.row(y) + row.first);
}

void ColourLinks::link(int y, ImageView<const uint8_t> mask, const LinkParams& params) {
  const Span row = span(y);
  const int count = std::max(row.last - row.first, 0);
  uint8_t* links = links_.row(y);
  std::fill(links, links + row.first, uint8_t{0});
  std::fill(links + row.first + count, links + size_.width, uint8_t{0});
  const bool chooses = params.joinsSingles;
  simd::linkRow({left_.row(y) + row.first, up_.row(y) + row.first,
                 chooses ? nearest_.row(y) + row.first : nullptr,
                 chooses ? nearest_.row(std::max(y - 1, 0)) + row.first : nullptr,
                 static_cast<uint8_t>(std::clamp(params.similarity, 0, int{kFarthest})), kNoPair},
                count, {kLinkedLeft, kLinkedUp, kInScope}, links + row.first);
  if (mask.data == nullptr) return;
  const uint8_t* scope = mask.row(y);
  for (int x = row.first; x < row.last; ++x)
    if (scope[x] != kForegroundPixel) links[x] = 0;
}

}  // namespace rg
