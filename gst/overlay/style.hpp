// SPDX-License-Identifier: LGPL-2.1-or-later
// Sizes and colours of what is drawn, so that it can be read on any frame.
#pragma once

#include "core/base/geometry.hpp"
#include "core/graph/graph.hpp"

#include <algorithm>
#include <array>
#include <cstdint>

namespace rg::overlay {

struct Style {
  int linePx = 1;        ///< Thickness of lines.
  int borderPx = 2;      ///< Of boxes.
  int rimPx = 1;         ///< Dark rim on both sides of a line; 0 = none.
  int textPx = 9;        ///< Height of capital letters.
  int spacePx = 2;       ///< Around text, and between dashes.
  bool hasWords = true;  ///< There is room for more than numbers.
};

/// Lines of 1/320 and letters of 1/45 of the frame's shorter side, times `scale`; never so small
/// that they vanish: where four pixels share their colour, a border of one pixel may have none.
/// Small frames go without rims and words, which would hide what they point at.
[[nodiscard]] inline Style styleFor(Size frame, double scale) {
  const double side = std::min(frame.width, frame.height) * scale;
  Style style;
  style.linePx = std::max(1, static_cast<int>(side / 320 + 0.5));
  style.borderPx = std::max(2, style.linePx);
  style.rimPx = side < 240 ? 0 : std::max(1, style.linePx / 2);
  style.textPx = std::max(7, static_cast<int>(side / 45 + 0.5));
  style.spacePx = std::max(2, style.textPx / 4);
  style.hasWords = side >= 240;
  return style;
}

/// A colour of its own for each of twelve objects in turn; neighbours in number differ most.
[[nodiscard]] inline graph::Colour colourOf(uint64_t id) {
  constexpr std::array<graph::Colour, 12> kColours{{{255, 92, 80},
                                                    {64, 200, 255},
                                                    {255, 214, 40},
                                                    {190, 120, 255},
                                                    {90, 225, 90},
                                                    {255, 130, 215},
                                                    {60, 235, 205},
                                                    {255, 160, 50},
                                                    {130, 160, 255},
                                                    {205, 235, 70},
                                                    {235, 85, 150},
                                                    {175, 205, 215}}};
  return kColours[id % kColours.size()];
}

}  // namespace rg::overlay
