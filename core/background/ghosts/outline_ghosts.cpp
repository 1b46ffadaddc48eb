// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/ghosts/outline_ghosts.hpp"

namespace rg::background {

OutlineSums sumOutline(const CellSearch& search, uint32_t part, const ColourPlanes& now,
                       const SceneMemory& memory) {
  const OutlinePlanes planes{now, memory.planes(), memory.known()};
  const auto isFound = [&](Point p) { return search.foundRow(p.y)[p.x] != 0; };
  OutlineSums sums;
  for (const ComponentRun& run : search.parts().runs) {
    if (run.component != part) continue;
    const Box box = pixelsOfCells(run, now.green.size);
    for (int y = box.y; y < box.bottom(); ++y)
      for (int x = box.x; x < box.right(); ++x)
        if (isFound({x, y})) addOutline({x, y}, isFound, planes, sums);
  }
  return sums;
}

}  // namespace rg::background
