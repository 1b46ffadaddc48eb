// SPDX-License-Identifier: LGPL-2.1-or-later
// How large the things are that come and go at once in this scene: leaves, rain, noise. What is no
// larger is not taken for an object.
//
// Determinism: integer counts that fade with the stream's time.
#pragma once

#include "core/objects/numbers.hpp"

#include <array>
#include <cstdint>

namespace rg::objects {

class Clutter {
 public:
  /// Time goes on: counts halve about every three seconds.
  void age(int64_t stepNs);
  /// Something was there for a moment only.
  void learn(int64_t areaPx);
  /// Objects are at least so large, in pixels: what is larger came and went no more than
  /// `some` times of late. 0 = all.
  [[nodiscard]] int64_t leastPx(Number some = Numbers::Life{}.clutterSome) const;

 private:
  static constexpr int kBins = 32;
  std::array<uint32_t, kBins> counts_{};  ///< In 1/256; bin i: areas of i binary digits.
  int64_t sinceNs_ = 0;
};

}  // namespace rg::objects
