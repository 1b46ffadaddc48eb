// SPDX-License-Identifier: LGPL-2.1-or-later
// A cascade in many windows, one by one: the plain version of what the detector does by rows.
#pragma once

#include "core/base/memory/image.hpp"
#include "core/detection/cascade_window.hpp"
#include "core/detection/search_windows.hpp"

#include <cstdint>

namespace rg::detection {

/// What windows are judged by: a cascade for each scale, laid out for these planes with a single
/// phase (integral.hpp).
struct JudgedPlanes {
  const CascadeView* scales = nullptr;
  ImageView<const uint32_t> sums;
  ImageView<const double> squares;
};

[[nodiscard]] constexpr uint16_t judgeWindowOf(const JudgedPlanes& planes,
                                               const WindowTable& windows, uint32_t id) {
  const WindowPlace place = placeOf(windows, id);
  const CascadeView& cascade = planes.scales[windows.ranges[place.range].scale];
  return judgeWindow(cascade, planes.sums.row(place.at.y) + place.at.x,
                     planes.squares.row(place.at.y) + place.at.x);
}

/// stages[id]: how many stages each window passed, or kFlatWindow.
inline void judgeWindows(const JudgedPlanes& planes, const WindowTable& windows, uint16_t* stages) {
  for (uint32_t id = 0; id < windows.count; ++id) stages[id] = judgeWindowOf(planes, windows, id);
}

}  // namespace rg::detection
