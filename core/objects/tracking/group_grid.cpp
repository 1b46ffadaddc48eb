// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/tracking/group_grid.hpp"

#include "core/objects/tracking/looks/appearance.hpp"
#include "core/simd/base/run_rows.hpp"

#include <algorithm>
#include <cstdlib>

namespace rg::objects {
namespace {

constexpr int kGridLines = 192;  // A person in a wide view still spans some ten cells.
constexpr uint8_t kUnknownBin = kColourBins - 1;

/// Where each pixel of an axis is among the middles of the cells.
template <class MiddleOf>
void listCells(int pixels, int cells, const MiddleOf& middleOf, std::vector<uint16_t>& cellFrom) {
  cellFrom.resize(static_cast<size_t>(pixels) + 1);
  int cell = 0;
  for (int i = 0; i <= pixels; ++i) {
    while (cell < cells && middleOf(cell) < i) ++cell;
    cellFrom[static_cast<size_t>(i)] = static_cast<uint16_t>(cell);
  }
}

void layGrid(Size frame, GroupGrid& e) {
  if (e.frame == frame && !e.cellFromRow.empty()) return;
  e.frame = frame;
  e.stepPx = std::max(1, std::min(frame.width, frame.height) / kGridLines);
  e.grid = {(frame.width + e.stepPx - 1) / e.stepPx, (frame.height + e.stepPx - 1) / e.stepPx};
  listCells(
      frame.width, e.grid.width, [&](int x) { return e.middleOf(x, 0).x; }, e.cellFromColumn);
  listCells(
      frame.height, e.grid.height, [&](int y) { return e.middleOf(0, y).y; }, e.cellFromRow);
}

void findBins(const Picture& picture, const Run& cells, GroupGrid& e) {
  const int y = e.middleOf(0, cells.y).y;
  const uint8_t *red = picture.red().row(y), *green = picture.green().row(y);
  const uint8_t* blue = picture.blue().row(y);
  uint8_t* bins = e.bin.data() + e.at(0, cells.y);
  const int end = e.middleOf(cells.end - 1, 0).x;  // The last one may be cut off.
  int middle = e.middleOf(cells.begin, 0).x;
  for (int cell = cells.begin; cell < cells.end; ++cell, middle += e.stepPx) {
    const int x = std::min(middle, end);
    bins[cell] = colourBin(red[x], green[x], blue[x]);
  }
}

}  // namespace

void gather(const graph::Graph& graph, std::span<const GroupIndex> groupOf,
            std::span<const uint8_t> isBackground, std::span<const TrackIndex> expectedOf,
            GroupGrid& e) {
  layGrid(graph.size, e);
  const auto cells = static_cast<size_t>(e.grid.area());
  e.group.assign(cells, 0);
  e.bin.assign(cells, kUnknownBin);
  e.region.resize(cells);
  e.expected.resize(cells);
  const Picture* picture = e.picture = graph.picture.get();
  for (size_t region = 0; region < groupOf.size(); ++region) {
    const GroupIndex group = groupOf[region];
    if (isBackground[group.index()]) continue;
    for (const Run& run : graph.runs.of(region)) {
      const Run found = e.cellsIn(run);
      const int count = found.end - found.begin;
      if (count == 0) continue;
      const size_t first = e.at(found.begin, found.y);
      std::fill_n(e.group.data() + first, count, static_cast<uint16_t>(group.number()));
      std::fill_n(e.region.data() + first, count, static_cast<uint16_t>(region + 1));
      std::fill_n(e.expected.data() + first, count,
                  static_cast<uint16_t>(expectedOf[region].number()));
      if (picture) findBins(*picture, found, e);
    }
  }
  e.listRuns();
}

void GroupGrid::listRuns() {
  runs.clear();
  std::vector<uint16_t>& begins = runBegins;
  begins.resize(static_cast<size_t>(grid.width) + 1);
  for (int y = 0; y < grid.height && grid.width > 0; ++y) {
    const uint16_t* row = group.data() + at(0, y);
    const int count = rg::simd::findRuns(row, grid.width, begins.data());
    for (size_t i = 0; i < static_cast<size_t>(count); ++i)
      if (row[begins[i]] != 0) runs.push_back({static_cast<uint16_t>(y), begins[i], begins[i + 1]});
  }
}

}  // namespace rg::objects
