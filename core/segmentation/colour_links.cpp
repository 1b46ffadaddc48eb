// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/segmentation/colour_links.hpp"

#include "core/simd/segmentation/link_rows.hpp"

#include <algorithm>
#include <array>

namespace rg::segmentation {
namespace {

/// Pairs with a pixel out of scope, or apart, are none.
void voidPairs(const uint8_t* scopeA, const uint8_t* scopeB, int count, uint8_t* to) {
  for (int i = 0; i < count; ++i) {
    const bool isPair = (scopeA[i] == scopeB[i]) & isInScope(scopeA[i]);
    to[i] = isPair ? to[i] : kNoPair;
  }
}

/// Pixels out of scope are looked at, too, though not the result there: what is found there is old,
/// but never what nobody wrote.
template <class Value>
void fillAtNewSize(Image<Value>& plane, Size size, Value value) {
  if (plane.size() == size) return;
  plane.resize(size);
  plane.fill(value);
}

/// Raises distances to those of the hues.
void raiseByHue(const int16_t* a, const int16_t* b, int count, uint8_t* distances) {
  const auto hueOnly = [](int16_t hue) { return hue < 0 ? hue : hue & (simd::kInBand - 1); };
  for (int i = 0; i < count; ++i) {
    const auto step = static_cast<uint8_t>(hueStep(hueOnly(a[i]), hueOnly(b[i])));
    distances[i] = std::max(distances[i], step);
  }
}

}  // namespace

void ColourLinks::build(const ColourGrid& planes, const LinkParams& params,
                        const Executor& executor) {
  planes_ = planes;
  band_ = params.band;
  space_ = params.space;
  const Size size = planes.size;
  left_.resize({size.width + 1, size.height});
  up_.resize({size.width, size.height + 1});
  nearest_.resize(size);
  links_.resize(size);
  spans_.find(size, planes.scope, executor);
  const auto forRows = [&](auto&& work) {
    executor.forRows(size.height, [&](int first, int last) {
      for (int y = first; y < last; ++y) work(y);
    });
  };
  const bool guards = planes.channels == 3 && band_.count > 0;
  if (guards || isByHsv()) {
    fillAtNewSize(hues_, size, int16_t{kAchromatic});
    forRows([&](int y) { findHues(y); });
  }
  if (isByHsv()) {
    for (Image<uint8_t>* plane : {&saturations_, &values_}) fillAtNewSize(*plane, size, uint8_t{0});
    forRows([&](int y) { findHsv(y); });
  }
  forRows([&](int y) {
    measure(y);
    if (isByHsv()) measureHues(y);
    if (guards) guardHues(y);
  });
  std::fill_n(up_.row(size.height), size.width, kNoPair);
  if (params.joinsSingles) forRows([&](int y) { chooseNearest(y); });
  forRows([&](int y) { link(y, params); });
}

void ColourLinks::findHues(int y) {
  const Span row = spans_.of(y);
  if (row.count() == 0) return;
  const auto from = [&](size_t channel) { return planes_.colours[channel].row(y) + row.first; };
  simd::findHueRow(from(0), from(1), from(2), row.count(), band_, hues_.row(y) + row.first);
}

void ColourLinks::findHsv(int y) {
  const Span row = spans_.of(y);
  const uint8_t *red = planes_.colours[0].row(y), *green = planes_.colours[1].row(y),
                *blue = planes_.colours[2].row(y);
  uint8_t *saturations = saturations_.row(y), *values = values_.row(y);
  for (int x = row.first; x < row.last; ++x) {
    saturations[x] = static_cast<uint8_t>(saturationOf(red[x], green[x], blue[x]));
    values[x] = static_cast<uint8_t>(valueOf(red[x], green[x], blue[x]));
  }
}

// Void pairs stay void: kNoPair is more than any step of hues.
void ColourLinks::measureHues(int y) {
  const Span row = spans_.of(y);
  const int count = row.count();
  if (count == 0) return;
  const int16_t* hues = hues_.row(y) + row.first;
  raiseByHue(hues, hues + 1, count - 1, left_.row(y) + row.first + 1);
  if (y > 0) raiseByHue(hues_.row(y - 1) + row.first, hues, count, up_.row(y) + row.first);
}

// Over the span of this row and the one above: the pairs that end outside must be void, too.
void ColourLinks::measure(int y) {
  const Span row = spans_.hull(y - 1, y + 1);
  const int count = row.last - row.first;
  uint8_t* left = left_.row(y);
  uint8_t* up = up_.row(y);
  left[row.first] = left[std::max(row.last, row.first)] = kNoPair;
  if (count <= 0) return;
  std::array<ImageView<const uint8_t>, 3> colours = planes_.colours;
  if (isByHsv()) colours = {saturations_, values_, values_};
  simd::PixelPairs across{planes_.channels, {}, {}}, down{planes_.channels, {}, {}};
  for (int c = 0; c < planes_.channels; ++c) {
    const ImageView<const uint8_t> pixels = colours[static_cast<size_t>(c)];
    across.a[c] = pixels.row(y) + row.first;
    across.b[c] = across.a[c] + 1;
    down.a[c] = pixels.row(std::max(y - 1, 0)) + row.first;
    down.b[c] = across.a[c];
  }
  simd::measureRow(across, count - 1, kFarthest, left + row.first + 1);
  if (y > 0) simd::measureRow(down, count, kFarthest, up + row.first);
  if (y == 0) std::fill_n(up + row.first, count, kNoPair);
  if (planes_.scope.data == nullptr) return;
  const uint8_t* scope = planes_.scope.row(y) + row.first;
  voidPairs(scope, scope + 1, count - 1, left + row.first + 1);
  if (y > 0) voidPairs(planes_.scope.row(y - 1) + row.first, scope, count, up + row.first);
}

void ColourLinks::guardHues(int y) {
  const Span row = spans_.of(y);
  const int count = row.count();
  if (count == 0) return;
  const simd::HueGuard guard{kHueGuard, kFarthest};
  const int16_t* hues = hues_.row(y) + row.first;
  simd::guardRow(hues, hues + 1, count - 1, guard, left_.row(y) + row.first + 1);
  if (y > 0)
    simd::guardRow(hues_.row(y - 1) + row.first, hues, count, guard, up_.row(y) + row.first);
}

void ColourLinks::chooseNearest(int y) {
  const Span row = spans_.of(y);
  simd::chooseRow({left_.row(y) + row.first, up_.row(y) + row.first, up_.row(y + 1) + row.first},
                  row.count(), kNoPair, nearest_.row(y) + row.first);
}

void ColourLinks::link(int y, const LinkParams& params) {
  const Span row = spans_.of(y);
  const int count = row.count();
  uint8_t* links = links_.row(y);
  std::fill(links, links + row.first, uint8_t{0});
  std::fill(links + row.first + count, links + planes_.size.width, uint8_t{0});
  const bool chooses = params.joinsSingles;
  simd::linkRow({left_.row(y) + row.first, up_.row(y) + row.first,
                 chooses ? nearest_.row(y) + row.first : nullptr,
                 chooses ? nearest_.row(std::max(y - 1, 0)) + row.first : nullptr,
                 static_cast<uint8_t>(std::clamp(params.similarity, 0, int{kFarthest})), kNoPair},
                count, {kLinkedLeft, kLinkedUp, kIsPixel}, links + row.first);
  if (planes_.scope.data == nullptr) return;
  const uint8_t* scope = planes_.scope.row(y);
  for (int x = row.first; x < row.last; ++x) links[x] = isInScope(scope[x]) ? links[x] : uint8_t{0};
}

}  // namespace rg::segmentation
