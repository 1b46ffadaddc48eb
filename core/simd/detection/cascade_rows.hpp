// SPDX-License-Identifier: LGPL-2.1-or-later
// A cascade in a row of windows, as many at once as a vector holds, compiled for every instruction
// set. All give the bits of the plain version (core/detection/cascade_window.hpp): windows don't
// mix, and each one's numbers are rounded as there.
#pragma once

#include "core/detection/cascade_window.hpp"

#include <cstdint>

namespace rg::detection::simd {

/// Windows a step apart. Their sums stand side by side (SumLayout), their squares a step apart.
struct WindowRow {
  const uint32_t* sums = nullptr;
  const double* squares = nullptr;
  int stepPx = 1;
  int count = 0;
};

/// stages[i] as of judgeWindow(). Sums up to a vector behind the row's last window are read: the
/// plane needs kMostLanes columns more.
void judgeRow(const CascadeView& cascade, const WindowRow& row, uint16_t* stages);

inline constexpr int kMostLanes = 16;

}  // namespace rg::detection::simd
