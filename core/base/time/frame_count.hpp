// SPDX-License-Identifier: LGPL-2.1-or-later
// Counts of frames in 32 bits, which a camera of 25 frames a second fills in five years.
#pragma once

#include <cstdint>

namespace rg {

/// Goes on half-way where it would wrap: no frame is ever again among the first, and what happens
/// in every 2^n-th frame keeps its turn.
class FrameCount {
 public:
  constexpr FrameCount() = default;
  constexpr explicit FrameCount(uint32_t frames) : frames_(frames) {}

  constexpr FrameCount& operator++() {
    constexpr uint32_t kHalfWay = uint32_t{1} << 31;
    frames_ = frames_ == UINT32_MAX ? kHalfWay : frames_ + 1;
    return *this;
  }
  [[nodiscard]] constexpr uint32_t value() const { return frames_; }

 private:
  uint32_t frames_ = 0;
};

/// Counts one more, and stays at what 32 bits hold: "for how long" never becomes "never".
constexpr void countUp(uint32_t& count) {
  count += count != UINT32_MAX;
}

}  // namespace rg
