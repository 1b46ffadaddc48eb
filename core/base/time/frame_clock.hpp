// SPDX-License-Identifier: LGPL-2.1-or-later
// From times to frame counts: how many frames a second has, as the stream's own times say.
#pragma once

#include "core/base/stage.hpp"
#include "core/base/time/time.hpp"

#include <algorithm>
#include <cstdint>

namespace rg {

/// The mean distance of frames, from their times. Integers: the same for every run.
class FrameClock {
 public:
  /// Distances of 0 or below and above a second say nothing of the rate and are left out.
  void tick(FrameTime time) {
    constexpr int64_t kMostNs = 1'000'000'000;
    if (time.isKnown && hasLast_) {
      const int64_t step = timeBetween(lastNs_, time.ns);
      if (step > 0 && step <= kMostNs) {
        intervalNs_ = steps_ == 0 ? step : intervalNs_ + (step - intervalNs_) / 8;
        steps_ = 1;
      }
    }
    lastNs_ = time.ns;
    hasLast_ = time.isKnown;
  }
  void breakOff() { hasLast_ = false; }

  [[nodiscard]] int64_t frames(double seconds) const {
    const double some = seconds > 0 ? std::min(seconds, 1e6) : 0.0;  // What is no number is 0.
    const auto ns = static_cast<int64_t>(some * 1e9);
    return std::max<int64_t>(1, ns / std::max<int64_t>(1, intervalNs_));
  }

 private:
  int64_t intervalNs_ = kNominalStepNs;
  int64_t lastNs_ = 0;
  int steps_ = 0;
  bool hasLast_ = false;
};

}  // namespace rg
