// SPDX-License-Identifier: LGPL-2.1-or-later
// Borders of regions as they are met (part of stage 2).
#pragma once

#include "core/segmentation/absorption.hpp"

#include <array>
#include <cstdint>
#include <utility>
#include <vector>

namespace rg::segmentation {

/// Borders as they come, pairs that come again soon joined.
class BorderList {
 public:
  void clear() {
    borders_.clear();
    recent_.fill(0);
  }

  void add(uint32_t a, uint32_t b, uint32_t borderPx) {
    if (a > b) std::swap(a, b);
    uint32_t& at = recent_[(a * 0x9E3779B1u ^ b * 0x85EBCA77u) >> (32 - kRecentBits)];
    if (at < borders_.size() && borders_[at].a == a && borders_[at].b == b) {
      borders_[at].borderPx += borderPx;
      return;
    }
    at = static_cast<uint32_t>(borders_.size());
    borders_.push_back({a, b, borderPx});
  }

  [[nodiscard]] const std::vector<AbsorbedBorder>& borders() const { return borders_; }

 private:
  static constexpr int kRecentBits = 11;
  std::vector<AbsorbedBorder> borders_;
  std::array<uint32_t, 1 << kRecentBits> recent_{};  ///< Where pairs of a hash are.
};

}  // namespace rg::segmentation
