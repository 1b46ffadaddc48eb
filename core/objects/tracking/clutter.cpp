// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/tracking/clutter.hpp"

#include "core/base/time/time.hpp"

#include <algorithm>
#include <bit>

namespace rg::objects {
namespace {

constexpr int64_t kFadeNs = 250'000'000;
constexpr int64_t kLongestNs = 60'000'000'000;  // By then nothing is left.
constexpr uint32_t kOne = 256;

}  // namespace

void Clutter::age(int64_t stepNs) {
  sinceNs_ = addTimes(sinceNs_, std::clamp<int64_t>(stepNs, 0, kLongestNs));
  for (; sinceNs_ >= kFadeNs; sinceNs_ -= kFadeNs)
    for (uint32_t& count : counts_) count -= (count + 15) / 16;
}

void Clutter::learn(int64_t areaPx) {
  const auto digits = std::bit_width(static_cast<uint64_t>(std::max<int64_t>(areaPx, 0)));
  counts_[std::min(static_cast<size_t>(digits), counts_.size() - 1)] += kOne;
}

int64_t Clutter::leastPx(Number some) const {
  int64_t sum = 0;
  for (int bin = kBins - 1; bin > 0; --bin) {
    sum += counts_[static_cast<size_t>(bin)];
    if (sum > some * int64_t{kOne}) return int64_t{1} << bin;
  }
  return 0;
}

}  // namespace rg::objects
