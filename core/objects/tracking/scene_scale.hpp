// SPDX-License-Identifier: LGPL-2.1-or-later
// How large things are in this scene: height and width as lines in the row of their feet, learnt
// from what was tracked by itself. No trained model and no absolute pixels.
//
// Determinism: integers; medians over the latest samples of each band of rows.
#pragma once

#include "core/base/geometry.hpp"
#include "core/objects/numbers.hpp"

#include <array>
#include <cstdint>

namespace rg::objects {

/// Width and height in 1/16 px.
struct Extent {
  int32_t width = 0;
  int32_t height = 0;
};

class SceneScale {
 public:
  void reset(Size frame, const Numbers::Sizes& numbers = {});
  /// Thing `id` was seen whole with its feet at row `footPx`. Width 0: of unknown width.
  void learn(uint64_t id, int footPx, Extent size);

  /// Enough was seen to say how large things are.
  [[nodiscard]] bool isKnown() const { return isKnown_; }
  /// Of several things seen most have about the expected size: what is twice as wide is two things.
  [[nodiscard]] bool isUniform() const { return isUniform_; }
  /// What to expect at a row; {} unless isKnown.
  [[nodiscard]] Extent at(int footPx) const;

 private:
  static constexpr int kBands = 16;
  static constexpr int kSamples = 24;  ///< The latest of each band.
  struct Sample {
    uint64_t id;
    int32_t foot, width, height;
  };
  struct Band {
    std::array<Sample, kSamples> samples;
    uint32_t seen = 0;  ///< Ever.
    [[nodiscard]] int count() const { return seen < kSamples ? static_cast<int>(seen) : kSamples; }
  };
  struct Line {
    int64_t slope = 0;   ///< In 1/16 px per row, Q16.
    int64_t offset = 0;  ///< At row 0, in 1/16 px, Q16.
  };
  [[nodiscard]] Line fit(int32_t Sample::*value) const;
  [[nodiscard]] int64_t valueAt(const Line& line, int footPx) const;
  void refit();
  [[nodiscard]] bool isAsExpected(const Sample& sample) const;
  [[nodiscard]] bool areMostAlike() const;

  Size frame_;
  Numbers::Sizes numbers_;
  std::array<Band, kBands> bands_;
  Line height_, width_;
  int lowFoot_ = 0, highFoot_ = 0;  ///< Rows between which there are samples.
  bool isKnown_ = false, isUniform_ = false;
};

}  // namespace rg::objects
