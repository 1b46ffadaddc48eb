// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/object_pixels.hpp"

#include <algorithm>
#include <numeric>

namespace rg {
namespace {

uint64_t sumOf(const uint8_t* values, int count) {
  uint32_t sum = 0;  // Of a row: 2^16 pixels of 2^8 levels.
  for (int i = 0; i < count; ++i) sum += values[i];
  return sum;
}

void listParts(const OwnedCells& cells, ObjectPixelScratch& s) {
  const Evidence& grid = cells.grid;
  s.parts.clear();
  s.firstOfRow.assign(static_cast<size_t>(grid.grid.height) + 1, 0);
  grid.forParts(cells.owner, [&](const RegionRun& part, uint16_t owner) {
    if (owner == 0) return;
    s.parts.push_back({part.begin * grid.stepPx, part.end * grid.stepPx, owner});
    ++s.firstOfRow[part.y + 1u];
  });
  std::partial_sum(s.firstOfRow.begin(), s.firstOfRow.end(), s.firstOfRow.begin());
}

void addRun(const RegionRun& run, const Picture* picture, ObjectSums& sum) {
  const auto count = static_cast<uint64_t>(run.end - run.begin);
  if (sum.count == 0 || run.y < sum.first.y || (run.y == sum.first.y && run.begin < sum.first.x))
    sum.first = {run.begin, run.y};
  sum.count += count;
  sum.x += count * static_cast<uint64_t>(run.begin + run.end - 1) / 2;
  sum.y += count * run.y;
  if (!picture) return;
  const auto add = [&](const ImageView<const uint8_t>& plane) {
    return sumOf(plane.row(run.y) + run.begin, run.end - run.begin);
  };
  sum.red += add(picture->red());
  sum.green += add(picture->green());
  sum.blue += add(picture->blue());
}

}  // namespace

void findObjectPixels(const Graph& graph, std::span<const uint8_t> isBackground,
                      const OwnedCells& cells, ObjectPixelScratch& s, const ObjectPixels& pixels) {
  pixels.slots.resize(graph.size);
  pixels.slots.fill(0);
  std::fill(pixels.sums.begin(), pixels.sums.end(), ObjectSums{});
  listParts(cells, s);
  const Picture* picture = graph.labels->picture.get();
  for (size_t region = 0; region < graph.regions.size(); ++region) {
    if (isBackground[region] != 0) continue;
    for (const RegionRun& run : graph.runs.of(region)) {
      const auto row = static_cast<size_t>(run.y / cells.grid.stepPx);
      const auto end = s.parts.begin() + s.firstOfRow[row + 1];
      auto part = std::upper_bound(s.parts.begin() + s.firstOfRow[row], end, int{run.begin},
                                   [](int x, const auto& p) { return x < p.end; });
      for (; part != end && part->begin < run.end; ++part) {
        const RegionRun mine{run.y, std::max(run.begin, static_cast<uint16_t>(part->begin)),
                             static_cast<uint16_t>(std::min<int>(run.end, part->end))};
        std::fill(pixels.slots.row(run.y) + mine.begin, pixels.slots.row(run.y) + mine.end,
                  part->owner);
        addRun(mine, picture, pixels.sums[part->owner - 1u]);
      }
    }
  }
}

}  // namespace rg
