// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/histogram.hpp"

#include <algorithm>
#include <mutex>

namespace rg {

Histogram countLevels(ImageView<const uint8_t> image, const Executor& executor) {
  Histogram total{};
  std::mutex mutex;  // Protects `total`; nothing is called while it is held.
  executor.forRows(image.height(), [&](int first, int last) {
    // Two tables: equal neighbours would wait for each other's increment.
    Histogram even{}, odd{};
    for (int y = first; y < last; ++y) {
      const uint8_t* row = image.row(y);
      int x = 0;
      for (; x + 1 < image.width(); x += 2) {
        ++even[row[x]];
        ++odd[row[x + 1]];
      }
      if (x < image.width()) ++even[row[x]];
    }
    const std::lock_guard lock(mutex);
    for (size_t i = 0; i < total.size(); ++i) total[i] += even[i] + odd[i];
  });
  return total;
}

int quantile(const Histogram& histogram, int share) {
  uint64_t total = 0;
  for (const uint32_t count : histogram) total += count;
  uint64_t below = 0;
  for (int level = 0; level < 256; ++level) {
    below += histogram[static_cast<size_t>(level)];
    if (below * 256 >= total * static_cast<uint64_t>(share)) return level;
  }
  return 255;
}

int differenceThreshold(const Histogram& histogram, int least) {
  int peak = 0, tail = 0;
  for (int level = 0; level < 256; ++level) {
    const uint32_t count = histogram[static_cast<size_t>(level)];
    if (count > histogram[static_cast<size_t>(peak)]) peak = level;
    if (count > 0) tail = level;
  }
  // Distance below the line from peak to tail, times the line's length.
  const int64_t height = histogram[static_cast<size_t>(peak)];
  const int64_t span = tail - peak;
  int corner = peak;
  int64_t farthest = 0;
  for (int level = peak; level <= tail; ++level) {
    const int64_t count = histogram[static_cast<size_t>(level)];
    const int64_t distance = height * (tail - level) - count * span;
    if (distance > farthest) {
      farthest = distance;
      corner = level;
    }
  }
  const int noise = 3 * (quantile(histogram, 128) + 1);
  return std::min(255, std::max({corner, noise, least}));
}

int contrastThreshold(const Histogram& histogram, int least) {
  constexpr int kTenth = 26;  // Of 256.
  const int range = quantile(histogram, 256 - kTenth) - quantile(histogram, kTenth);
  return std::min(255, std::max(range / 8, least));
}

}  // namespace rg
