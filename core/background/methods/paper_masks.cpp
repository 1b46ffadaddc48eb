// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/methods/paper_masks.hpp"

#include <algorithm>
#include <cassert>
#include <numeric>

namespace rg::background {

void keepAbove(int threshold, const Executor& executor, ImageView<uint8_t> plane) {
  executor.forRows(plane.height(), [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      uint8_t* row = plane.row(y);
      for (int x = 0; x < plane.width(); ++x) row[x] = row[x] > threshold ? 255 : 0;
    }
  });
}

void keepBoth(ImageView<const uint8_t> a, ImageView<const uint8_t> b, const Executor& executor,
              ImageView<uint8_t> out) {
  assert(a.size == out.size && b.size == out.size);
  executor.forRows(out.height(), [&](int first, int last) {
    for (int y = first; y < last; ++y)
      for (int x = 0; x < out.width(); ++x) out.row(y)[x] = a.row(y)[x] & b.row(y)[x];
  });
}

void joinFound(const GaussianTests& tests, ImageView<const uint8_t> filled,
               const Executor& executor, ImageView<uint8_t> out) {
  assert(tests.common.size() == out.size && filled.size == out.size);
  executor.forRows(out.height(), [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      const uint8_t *common = tests.common.row(y), *fill = filled.row(y);
      const uint8_t *simple = tests.simple.row(y), *gaussian = tests.gaussian.row(y);
      uint8_t* to = out.row(y);
      for (int x = 0; x < out.width(); ++x)
        to[x] = static_cast<uint8_t>(common[x] | (fill[x] & (simple[x] | gaussian[x])));
    }
  });
}

void choosePartsToFill(std::span<const Component> parts, Size frame,
                       std::vector<uint32_t>& chosen) {
  chosen.resize(parts.size());
  std::iota(chosen.begin(), chosen.end(), 0u);
  std::sort(chosen.begin(), chosen.end(), [&](uint32_t a, uint32_t b) {
    const int64_t areaA = parts[a].box.area(), areaB = parts[b].box.area();
    return areaA != areaB ? areaA > areaB : a < b;
  });
  int64_t budget = 4 * frame.area();
  const auto isTooMuch = [&](uint32_t part) {
    budget -= parts[part].box.area();
    return budget < 0;
  };
  chosen.erase(std::find_if(chosen.begin(), chosen.end(), isTooMuch), chosen.end());
}

}  // namespace rg::background
