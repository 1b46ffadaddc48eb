// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/segmentation/hue.hpp"

#include <numeric>

namespace rg::segmentation {
namespace {

using Sums = std::array<uint64_t, kHueCount>;

Sums windowSums(const HueHistogram& histogram) {
  const auto at = [&](int hue) { return histogram[static_cast<size_t>(wrapped(hue))]; };
  Sums sums{};
  uint64_t sum = 0;
  for (int d = -kSmoothingReach; d <= kSmoothingReach; ++d) sum += at(d);
  for (int hue = 0; hue < kHueCount; ++hue) {
    sums[static_cast<size_t>(hue)] = sum;
    sum += at(hue + kSmoothingReach + 1);
    sum -= at(hue - kSmoothingReach);
  }
  return sums;
}

}  // namespace

HueBand findBackgroundBand(const HueHistogram& histogram, uint64_t total) {
  const uint64_t chromatic = std::accumulate(histogram.begin(), histogram.end(), uint64_t{0});
  if (!isColourful(chromatic, total)) return {};
  const Sums sums = windowSums(histogram);
  const auto peak = static_cast<int>(std::max_element(sums.begin(), sums.end()) - sums.begin());
  const uint64_t least = sums[static_cast<size_t>(peak)] / kTailShare;
  const auto reach = [&](int step) {
    int count = 0;
    while (count < kHueCount / 2 &&
           sums[static_cast<size_t>(wrapped(peak + step * (count + 1)))] > least)
      ++count;
    return count;
  };
  return bandRound(peak, reach(-1), reach(1));
}

}  // namespace rg::segmentation
