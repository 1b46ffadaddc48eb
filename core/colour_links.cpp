// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/colour_links.hpp"

#include "core/background.hpp"

#include <algorithm>

namespace rg {
namespace {

constexpr int kBandsOfRows = 8;  // Each has its own histogram.

enum Direction : uint8_t { kUp, kLeft, kRight, kDown, kNowhere };

constexpr uint8_t average(uint8_t a, uint8_t b) {
  return static_cast<uint8_t>((a + b + 1) >> 1);
}

constexpr uint8_t distance(uint8_t a, uint8_t b) {
  return a > b ? static_cast<uint8_t>(a - b) : static_cast<uint8_t>(b - a);
}

/// Writes the mean of each pixel and its two neighbours, weights 1 2 1; the row's ends repeat.
void smoothAcross(const uint8_t* from, int width, Span span, uint8_t* to) {
  const auto at = [&](int x) { return from[std::clamp(x, 0, width - 1)]; };
  const auto clamped = [&](int x) { to[x] = average(average(at(x - 1), at(x + 1)), from[x]); };
  if (span.first >= span.last) return;
  clamped(span.first);
  clamped(span.last - 1);
  for (int x = span.first + 1; x < span.last - 1; ++x)
    to[x] = average(average(from[x - 1], from[x + 1]), from[x]);
}

void smoothDown(const uint8_t* above, const uint8_t* from, const uint8_t* below, Span span,
                uint8_t* to) {
  for (int x = span.first; x < span.last; ++x)
    to[x] = average(average(above[x], below[x]), from[x]);
}

void firstDistance(const uint8_t* a, const uint8_t* b, int count, uint8_t* to) {
  for (int i = 0; i < count; ++i) to[i] = std::min(distance(a[i], b[i]), kFarthest);
}

void largerDistance(const uint8_t* a, const uint8_t* b, int count, uint8_t* to) {
  for (int i = 0; i < count; ++i)
    to[i] = std::max(to[i], std::min(distance(a[i], b[i]), kFarthest));
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
  findBand(planes, executor);
  smooth(planes, executor);

  const auto forRows = [&](auto&& work) {
    executor.forRows(size_.height, [&](int first, int last) {
      for (int y = first; y < last; ++y) work(y);
    });
  };
  const bool guards = band_.count > 0;
  if (guards) {
    hues_.resize(size_);
    forRows([&](int y) { findHues(y); });
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

// A quarter of the pixels is enough for a peak.
void ColourLinks::findBand(const Planes& planes, const Executor& executor) {
  band_ = {};
  if (channels_ == 1) return;
  histograms_.resize(kBandsOfRows);
  std::array<uint64_t, kBandsOfRows> totals{};
  executor.forEach(kBandsOfRows, [&](int band) {
    HueHistogram& histogram = histograms_[static_cast<size_t>(band)];
    histogram.fill(0);
    for (int y = 2 * band; y < size_.height; y += 2 * kBandsOfRows) {
      const Span row = span(y);
      for (int x = row.first; x < row.last; x += 2) {
        const int hue = hueOf(planes[0].row(y)[x], planes[1].row(y)[x], planes[2].row(y)[x]);
        if (hue != kAchromatic) ++histogram[static_cast<size_t>(hue)];
        ++totals[static_cast<size_t>(band)];
      }
    }
  });
  uint64_t total = totals[0];
  for (size_t band = 1; band < kBandsOfRows; ++band) {
    total += totals[band];
    for (size_t hue = 0; hue < kHueCount; ++hue) histograms_[0][hue] += histograms_[band][hue];
  }
  band_ = findBackgroundBand(histograms_[0], total);
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
      for (int y = first; y < last; ++y)
        smoothDown(across_[i].row(std::max(y - 1, 0)), across_[i].row(y),
                   across_[i].row(std::min(y + 1, size_.height - 1)), span(y), smooth_[i].row(y));
    });
  }
}

void ColourLinks::findHues(int y) {
  const Span row = span(y);
  const uint8_t *red = smooth_[0].row(y), *green = smooth_[1].row(y), *blue = smooth_[2].row(y);
  int16_t* hues = hues_.row(y);
  for (int x = row.first; x < row.last; ++x)
    hues[x] = static_cast<int16_t>(hueOf(red[x], green[x], blue[x]));
}

// Over the span of this row and the one above: the pairs that end outside must be void, too.
void ColourLinks::measure(int y, ImageView<const uint8_t> mask) {
  const Span row = hull(y, 1, 0);
  const int count = row.last - row.first;
  uint8_t* left = left_.row(y);
  uint8_t* up = up_.row(y);
  left[row.first] = left[std::max(row.last, row.first)] = kNoPair;
  if (count <= 0) return;
  for (int c = 0; c < channels_; ++c) {
    const auto i = static_cast<size_t>(c);
    const auto note = c == 0 ? firstDistance : largerDistance;
    const uint8_t* pixels = smooth_[i].row(y) + row.first;
    note(pixels, pixels + 1, count - 1, left + row.first + 1);
    if (y > 0) note(smooth_[i].row(y - 1) + row.first, pixels, count, up + row.first);
  }
  if (y == 0) std::fill_n(up + row.first, count, kNoPair);
  if (mask.data == nullptr) return;
  const uint8_t* scope = mask.row(y) + row.first;
  voidPairs(scope, scope + 1, count - 1, left + row.first + 1);
  if (y > 0) voidPairs(mask.row(y - 1) + row.first, scope, count, up + row.first);
}

void ColourLinks::guardHues(int y) {
  const auto parts = [&](int a, int b) {
    return a != kAchromatic && b != kAchromatic && band_.contains(a) != band_.contains(b) &&
           hueDistance(a, b) > kHueGuard;
  };
  const Span row = span(y);
  const int16_t* hues = hues_.row(y);
  const int16_t* above = hues_.row(std::max(y - 1, 0));
  uint8_t* left = left_.row(y);
  uint8_t* up = up_.row(y);
  for (int x = row.first; x < row.last; ++x) {
    if (left[x] < kFarthest && parts(hues[x - 1], hues[x])) left[x] = kFarthest;
    if (up[x] < kFarthest && parts(above[x], hues[x])) up[x] = kFarthest;
  }
}

void ColourLinks::chooseNearest(int y) {
  const Span row = span(y);
  const uint8_t *left = left_.row(y), *up = up_.row(y), *down = up_.row(y + 1);
  uint8_t* nearest = nearest_.row(y);
  for (int x = row.first; x < row.last; ++x) {
    const uint8_t u = up[x], l = left[x], r = left[x + 1], d = down[x];
    const uint8_t least = std::min(std::min(u, l), std::min(r, d));
    uint8_t choice = kDown;
    choice = r == least ? uint8_t{kRight} : choice;
    choice = l == least ? uint8_t{kLeft} : choice;
    choice = u == least ? uint8_t{kUp} : choice;
    nearest[x] = least == kNoPair ? uint8_t{kNowhere} : choice;
  }
}

void ColourLinks::link(int y, ImageView<const uint8_t> mask, const LinkParams& params) {
  const Span row = span(y);
  const auto similarity = static_cast<uint8_t>(std::clamp(params.similarity, 0, 254));
  const uint8_t *left = left_.row(y), *up = up_.row(y);
  uint8_t* links = links_.row(y);
  const auto bitIf = [](bool isSet, LinkBit bit) { return isSet ? int{bit} : 0; };
  for (int x = row.first; x < row.last; ++x)
    links[x] = static_cast<uint8_t>(kInScope | bitIf(left[x] <= similarity, kLinkedLeft) |
                                    bitIf(up[x] <= similarity, kLinkedUp));
  if (params.joinsSingles) {
    const uint8_t* nearest = nearest_.row(y);
    const uint8_t* above = nearest_.row(std::max(y - 1, 0));
    for (int x = row.first; x < row.last; ++x) {
      const bool isUpWanted = nearest[x] == kUp || (up[x] != kNoPair && above[x] == kDown);
      links[x] = static_cast<uint8_t>(links[x] | bitIf(nearest[x] == kLeft, kLinkedLeft) |
                                      bitIf(isUpWanted, kLinkedUp));
    }
    for (int x = row.first + 1; x < row.last; ++x)
      links[x] = static_cast<uint8_t>(links[x] | bitIf(nearest[x - 1] == kRight, kLinkedLeft));
  }
  if (mask.data == nullptr) return;
  const uint8_t* scope = mask.row(y);
  for (int x = row.first; x < row.last; ++x)
    if (scope[x] != kForegroundPixel) links[x] = 0;
}

}  // namespace rg
