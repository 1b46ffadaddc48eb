// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/detection/scaled_cascade.hpp"

#include <algorithm>
#include <cmath>

namespace rg::detection {
namespace {

int scaled(int value, double factor) {
  return static_cast<int>(std::floor(value * factor + .5));
}

int32_t placeOf(const SumLayout& layout, int x, int y) {
  return static_cast<int32_t>(y * layout.rowSums + (x % layout.phases) * layout.phaseColumns +
                              x / layout.phases);
}

/// The cells of a box.
Box scaled(const Box& box, double factor) {
  const int left = scaled(box.x, factor), top = scaled(box.y, factor);
  return {left, top, scaled(box.right(), factor) - left, scaled(box.bottom(), factor) - top};
}

Corners cornersOf(const Box& box, const SumLayout& layout) {
  return {{placeOf(layout, box.x, box.y), placeOf(layout, box.right(), box.y),
           placeOf(layout, box.x, box.bottom()), placeOf(layout, box.right(), box.bottom())}};
}

ContrastLookup contrastOf(Size window, const Scale& scale, const SumLayout& layout) {
  const Box trained{1, 1, window.width - 2, window.height - 2};
  const Box box = scaled(trained, scale.factor);
  ContrastLookup lookup;
  lookup.corners = cornersOf(box, layout);
  lookup.squareCorners = cornersOf(box, {1, 0, layout.rowSquares, 0});
  lookup.area = static_cast<double>(trained.area());
  lookup.squareRatio = lookup.area / static_cast<double>(box.area());
  lookup.ratio = static_cast<float>(lookup.squareRatio);
  return lookup;
}

}  // namespace

ScaledCascade::ScaledCascade(const Cascade& cascade, const Scale& scale, const SumLayout& layout)
    : cascade_(&cascade), contrast_(contrastOf(cascade.window, scale, layout)) {
  lookups_.reserve(cascade.nodeFeatures.size());
  for (const int32_t feature : cascade.nodeFeatures)
    lookups_.push_back(place(cascade.features[static_cast<size_t>(feature)], scale, layout));
}

Lookup ScaledCascade::place(const Feature& feature, const Scale& scale, const SumLayout& layout) {
  Lookup lookup;
  lookup.firstRow = static_cast<int32_t>(rows_.size());
  for (size_t i = 0; i < kMostRects; ++i) {
    const Feature::Rect& rect = feature.rects[i];
    if (rect.weight == 0 && i > 1) continue;
    if (rect.weight == 0) {  // The first two are always summed.
      rows_.push_back({});
      lookup.rows[i] = 1;
      continue;
    }
    const int rows = feature.isTilted ? rect.box.width + rect.box.height : 1;
    int64_t trainedPx = 0, scaledPx = 0;
    for (int r = 0; r < rows; ++r) {
      const Box row = feature.isTilted ? tiltedRow(rect.box, r) : rect.box;
      const Box cells = scaled(row, scale.factor);
      rows_.push_back(cornersOf(cells, layout));
      trainedPx += row.area();
      scaledPx += cells.area();
    }
    lookup.rows[i] = rows;
    lookup.weights[i] = rect.weight;
    lookup.ratios[i] =
        static_cast<float>(static_cast<double>(trainedPx) / static_cast<double>(scaledPx));
  }
  return lookup;
}

CascadeView ScaledCascade::view() const {
  const Cascade& c = *cascade_;
  return {
      c.stages.data(), c.trees.data(), c.branches.data(), c.leaves.data(),
      lookups_.data(), rows_.data(),   contrast_,         static_cast<int32_t>(c.stages.size())};
}

}  // namespace rg::detection
