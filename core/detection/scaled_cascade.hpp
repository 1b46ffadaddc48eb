// SPDX-License-Identifier: LGPL-2.1-or-later
// A cascade brought to the size of windows: rectangles become places in planes of sums.
#pragma once

#include "core/detection/cascade.hpp"
#include "core/detection/cascade_window.hpp"
#include "core/detection/search_windows.hpp"

#include <cstddef>
#include <vector>

namespace rg::detection {

/// How planes of sums lie in memory. Columns may be sorted by their remainder when divided by
/// `phases`, so that what neighbouring windows ask for, a step apart, stands side by side: column x
/// is the (x / phases)-th of the block x mod phases, which has `phaseColumns`.
struct SumLayout {
  int phases = 1;
  int phaseColumns = 0;
  ptrdiff_t rowSums = 0;     ///< From row to row.
  ptrdiff_t rowSquares = 0;  ///< Their plane has its columns in order.
};

/// The trained window's pixels become cells of the scaled one, whose edges are rounded to whole
/// pixels, halves upwards; a rectangle is made of the cells that its pixels became. So those that
/// touch still do, upright or tilted, and a picture enlarged by a whole factor has the sums of the
/// picture itself, times the factor's square. Memory: 40 bytes for each node and 16 for each row of
/// each rectangle.
class ScaledCascade {
 public:
  /// The cascade must have passed check(), and live as long as this. Scale: 1 or more.
  ScaledCascade(const Cascade& cascade, const Scale& scale, const SumLayout& layout);

  [[nodiscard]] CascadeView view() const;

 private:
  [[nodiscard]] Lookup place(const Feature& feature, const Scale& scale, const SumLayout& layout);

  const Cascade* cascade_;
  std::vector<Lookup> lookups_;
  std::vector<Corners> rows_;
  ContrastLookup contrast_;
};

}  // namespace rg::detection
