// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/tracking/looks/object_pixels.hpp"

#include <algorithm>
#include <numeric>

namespace rg::objects {
namespace {

uint64_t sumOf(const uint8_t* values, int count) {
  uint32_t sum = 0;  // Of a row: 2^16 pixels of 2^8 levels.
  for (int i = 0; i < count; ++i) sum += values[i];
  return sum;
}

void listParts(const OwnedCells& cells, ObjectPixelScratch& s) {
  const GroupGrid& grid = cells.grid;
  s.parts.clear();
  s.firstOfRow.assign(static_cast<size_t>(grid.grid.height) + 1, 0);
  grid.forParts(cells.owner, [&](const Run& part, uint16_t owner) {
    if (owner == 0) return;
    s.parts.push_back({part.begin * grid.stepPx, part.end * grid.stepPx, owner});
    ++s.firstOfRow[part.y + 1u];
  });
  std::partial_sum(s.firstOfRow.begin(), s.firstOfRow.end(), s.firstOfRow.begin());
}

/// Runs come in raster order.
void addRun(const Run& run, const Picture* picture, ObjectSums& sum) {
  const auto count = static_cast<uint64_t>(run.end - run.begin);
  if (sum.count == 0) sum.first = {run.begin, run.y};
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

/// Writes the owners of a region's pixels, and how far each row has any.
void fillSlots(std::span<const Run> runs, const GroupGrid& grid, ObjectPixelScratch& s,
               Image<uint16_t>& slots) {
  for (const Run& run : runs) {
    const auto row = static_cast<size_t>(run.y / grid.stepPx);
    const auto end = s.parts.begin() + s.firstOfRow[row + 1];
    auto part = std::upper_bound(s.parts.begin() + s.firstOfRow[row], end, int{run.begin},
                                 [](int x, const auto& p) { return x < p.end; });
    for (; part != end && part->begin < run.end; ++part) {
      const int first = std::max<int>(run.begin, part->begin);
      const int last = std::min<int>(run.end, part->end);
      std::fill(slots.row(run.y) + first, slots.row(run.y) + last, part->owner);
      ObjectPixelScratch::Extent& extent = s.extents[run.y];
      extent.first = std::min(extent.first, first);
      extent.last = std::max(extent.last, last);
    }
  }
}

}  // namespace

/// Objects are summed by the rows of slots: their runs are longer than those of the regions.
void findObjectPixels(const graph::Graph& graph, std::span<const uint8_t> isBackground,
                      const OwnedCells& cells, ObjectPixelScratch& s, const ObjectPixels& pixels) {
  Image<uint16_t>& slots = pixels.slots;
  slots.resize(graph.size);
  slots.fill(0);
  std::fill(pixels.sums.begin(), pixels.sums.end(), ObjectSums{});
  listParts(cells, s);
  s.extents.assign(static_cast<size_t>(graph.size.height), {graph.size.width, 0});
  for (size_t region = 0; region < graph.regions.size(); ++region)
    if (isBackground[region] == 0) fillSlots(graph.runs.of(region), cells.grid, s, slots);
  const Picture* picture = graph.picture.get();
  for (int y = 0; y < graph.size.height; ++y) {
    const uint16_t* row = slots.row(y);
    const ObjectPixelScratch::Extent extent = s.extents[static_cast<size_t>(y)];
    for (int begin = extent.first; begin < extent.last;) {
      const int end = graph::endOfRun(row, begin, extent.last);
      const Run run{static_cast<uint16_t>(y), static_cast<uint16_t>(begin),
                    static_cast<uint16_t>(end)};
      if (row[begin] != 0) addRun(run, picture, pixels.sums[row[begin] - 1u]);
      begin = end;
    }
  }
}

}  // namespace rg::objects
