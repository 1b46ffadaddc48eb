// SPDX-License-Identifier: LGPL-2.1-or-later
// Is what stands still a thing, or the place that a thing has left while the memory shows it still?
//
// Determinism: sums over the pixels of a part; any order gives the same.
#pragma once

#include "core/background/cell_search.hpp"
#include "core/background/scene_memory.hpp"
#include "core/base/pixel.hpp"

#include <algorithm>
#include <cstdint>

namespace rg::background {

/// What is on both sides of an outline: of all places that could be read, how far the two sides are
/// apart in the picture and in the memory, in grey levels.
struct OutlineSums {
  int64_t inPicture = 0, inScene = 0, read = 0;

  /// Whether the outline is an edge in the memory rather than in the picture.
  [[nodiscard]] constexpr bool isGhost() const {
    constexpr int64_t kLeastContour = 8;  // Pixels of outline that must be readable.
    constexpr int64_t kLeastEdge = 4;     // Grey levels that camera noise makes.
    return read >= kLeastContour && 2 * inScene > 3 * inPicture + kLeastEdge * read;
  }
};

/// Where outlines are read; `known` is 255 where the scene is, else 0.
struct OutlinePlanes {
  ColourPlanes now, scene;
  ImageView<const uint8_t> known;
};

/// Largest difference of a channel.
[[nodiscard]] constexpr int differenceOf(const ColourPlanes& planes, Point a, Point b) {
  const int red = absDiff(planes.red.at(a.x, a.y), planes.red.at(b.x, b.y));
  const int green = absDiff(planes.green.at(a.x, a.y), planes.green.at(b.x, b.y));
  const int blue = absDiff(planes.blue.at(a.x, a.y), planes.blue.at(b.x, b.y));
  return std::max(red, std::max(green, blue));
}

/// Adds what a found pixel is beside; isFound(point), also of points outside of the frame. The
/// outline is a pixel or two off: one pixel inside is compared with two outside.
template <class IsFound, class Sums>
constexpr void addOutline(Point p, const IsFound& isFound, const OutlinePlanes& planes,
                          Sums& sums) {
  const Box bounds = boundsOf(planes.known.size);
  for (int side = 0; side < 4; ++side) {
    const Point step{(side == 0) - (side == 1), (side == 2) - (side == 3)};
    const Point beside{p.x + step.x, p.y + step.y};
    const Point outside{beside.x + step.x, beside.y + step.y};
    const Point inside{p.x - step.x, p.y - step.y};
    if (!bounds.contains(outside) || !bounds.contains(inside) || isFound(beside) ||
        isFound(outside) || planes.known.at(outside.x, outside.y) == 0)
      continue;
    sums.inPicture += differenceOf(planes.now, inside, outside);
    sums.inScene += differenceOf(planes.scene, inside, outside);
    ++sums.read;
  }
}

/// Of all pixels of a part.
[[nodiscard]] OutlineSums sumOutline(const CellSearch& search, uint32_t part,
                                     const ColourPlanes& now, const SceneMemory& memory);

}  // namespace rg::background
