// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/ghosts/outline_ghosts.hpp"

#include "core/base/pixel.hpp"

#include <algorithm>

namespace rg::background {
namespace {

constexpr int64_t kLeastContour = 8;  ///< Pixels of outline that must be readable.
constexpr int64_t kLeastEdge = 4;     ///< Grey levels that camera noise makes.

class OutlineReader {
 public:
  OutlineReader(const CellSearch& search, const ColourPlanes& now, const SceneMemory& memory)
      : search_(search), now_(now), memory_(memory), scene_(memory.planes()) {}

  void read(const ComponentRun& cells) {
    const Box bounds = boundsOf(now_.green.size);
    const Box box = pixelsOfCells(cells, now_.green.size);
    for (int y = box.y; y < box.bottom(); ++y)
      for (int x = box.x; x < box.right(); ++x)
        if (isFound({x, y}))
          for (const Point step : {Point{1, 0}, Point{-1, 0}, Point{0, 1}, Point{0, -1}})
            addAcross({x, y}, step, bounds);
  }

  [[nodiscard]] bool isGhost() const {
    return read_ >= kLeastContour && 2 * inScene_ > 3 * inPicture_ + kLeastEdge * read_;
  }

 private:
  [[nodiscard]] bool isFound(Point p) const { return search_.foundRow(p.y)[p.x] != 0; }

  /// The outline is a pixel or two off: compares one pixel inside with two outside.
  void addAcross(Point p, Point step, const Box& bounds) {
    const Point beside{p.x + step.x, p.y + step.y};
    const Point outside{beside.x + step.x, beside.y + step.y};
    const Point inside{p.x - step.x, p.y - step.y};
    if (!bounds.contains(outside) || !bounds.contains(inside)) return;
    if (isFound(beside) || isFound(outside) || memory_.known().at(outside.x, outside.y) == 0)
      return;
    inPicture_ += difference(now_, inside, outside);
    inScene_ += difference(scene_, inside, outside);
    ++read_;
  }

  static int difference(const ColourPlanes& planes, Point a, Point b) {
    const auto along = [&](ImageView<const uint8_t> plane) {
      return absDiff(plane.at(a.x, a.y), plane.at(b.x, b.y));
    };
    return std::max({along(planes.red), along(planes.green), along(planes.blue)});
  }

  const CellSearch& search_;
  const ColourPlanes& now_;
  const SceneMemory& memory_;
  const ColourPlanes scene_;
  int64_t inPicture_ = 0, inScene_ = 0, read_ = 0;
};

}  // namespace

bool isGhost(const CellSearch& search, uint32_t part, const ColourPlanes& now,
             const SceneMemory& memory) {
  OutlineReader reader(search, now, memory);
  for (const ComponentRun& run : search.parts().runs)
    if (run.component == part) reader.read(run);
  return reader.isGhost();
}

}  // namespace rg::background
