// SPDX-License-Identifier: LGPL-2.1-or-later
// Where to look: the part of the frame that is of interest, as polygons and as a picture.
//
// Coordinates are shares of the frame's width and height, so that they hold for any size.
// Determinism: integers; a pixel belongs to a polygon when its centre does (even-odd rule).
#pragma once

#include "core/base/geometry.hpp"
#include "core/base/memory/image.hpp"
#include "core/base/result.hpp"

#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

namespace rg::background {

inline constexpr uint8_t kInside = 255;

struct InterestPolygon {
  static constexpr int kUnit = 1 << 16;  ///< The width and the height of the frame.
  bool isExcluded = false;
  std::vector<Point> points;
};

/// All polygons together have no more points, and their text no more bytes, so that nobody's
/// setting holds up a stream: a finer shape is for a picture.
inline constexpr size_t kMostInterestPoints = 1000;
inline constexpr size_t kMostInterestBytes = size_t{1} << 17;

/// Reads polygons from text: separated by ';', each a list of points "x,y" from 0 to 1 separated by
/// blanks, three at least, with the word "exclude" before those that are cut out. Empty text: none.
/// Time is linear in the length of the text.
[[nodiscard]] Result<std::vector<InterestPolygon>> parsePolygons(std::string_view text);

/// Writes kInside where to look, else 0: inside one of the polygons that are not excluded, where
/// there are any, outside of all that are, and where `picture`, which is fitted to the frame by the
/// nearest pixel, is at least 128; an empty picture says nothing.
void drawInterest(std::span<const InterestPolygon> polygons, ImageView<const uint8_t> picture,
                  ImageView<uint8_t> interest);

}  // namespace rg::background
