// SPDX-License-Identifier: LGPL-2.1-or-later
// Planes that say which pixels are divided into regions, and where in a row those are.
#pragma once

#include "core/base/memory/executor.hpp"
#include "core/base/memory/image.hpp"
#include "core/base/run.hpp"

#include <cstdint>
#include <vector>

namespace rg {

/// Values of a scope plane: kInScope and kInScopeApart are in scope, what is below is not. No
/// region holds pixels of both. bgremove's mask is a scope plane: its foreground is in scope.
inline constexpr uint8_t kInScope = 255;
inline constexpr uint8_t kInScopeApart = 254;

[[nodiscard]] constexpr bool isInScope(uint8_t value) {
  return value >= kInScopeApart;
}

/// Takes out of scope what is outside of the interest: its values are 255 inside, else 0.
void keepInside(ImageView<const uint8_t> interest, ImageView<uint8_t> scope);

/// Of each row, the columns outside which no pixel is in scope.
class RowSpans {
 public:
  /// A scope without data: all pixels.
  void find(Size size, ImageView<const uint8_t> scope, const Executor& executor);

  /// Of an empty row first ≥ last.
  [[nodiscard]] Span of(int y) const { return spans_[static_cast<size_t>(y)]; }
  /// What the spans of the rows first … last − 1 of the picture cover.
  [[nodiscard]] Span hull(int first, int last) const;

 private:
  Size size_;
  std::vector<Span> spans_;
};

}  // namespace rg
