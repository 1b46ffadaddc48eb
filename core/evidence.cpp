// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/evidence.hpp"

#include "core/appearance.hpp"
#include "core/simd/run_rows.hpp"

#include <algorithm>

namespace rg {
namespace {

constexpr int kGridLines = 192;  // A person in a wide view still spans some ten cells.
constexpr uint8_t kUnknownBin = kColourBins - 1;

/// Calls visit(x, y, cell) for the cells of which the middle lies in a run of pixels.
template <class Visit>
void forSamples(const Evidence& e, const RegionRun& run, const Visit& visit) {
  const int cy = std::min(run.y / e.stepPx, e.grid.height - 1);
  if (e.middleOf(0, cy).y != run.y) return;
  for (int cx = run.begin / e.stepPx; cx < e.grid.width; ++cx) {
    const int x = e.middleOf(cx, cy).x;
    if (x >= run.end) return;
    if (x >= run.begin) visit(x, int{run.y}, e.at(cx, cy));
  }
}

constexpr int kLeastApart =
    6;  // Sixteenths of a pixel per frame: parts of one thing differ by less.

}  // namespace

void gather(const Graph& graph, std::span<const uint32_t> groupOf,
            std::span<const uint8_t> isBackground, std::span<const uint32_t> expectedOf,
            Evidence& e) {
  e.frame = graph.size;
  e.stepPx = std::max(1, std::min(e.frame.width, e.frame.height) / kGridLines);
  e.grid = {(e.frame.width + e.stepPx - 1) / e.stepPx, (e.frame.height + e.stepPx - 1) / e.stepPx};
  const auto cells = static_cast<size_t>(e.grid.area());
  e.group.assign(cells, 0);
  e.bin.assign(cells, kUnknownBin);
  e.expected.resize(cells);
  e.cellsOf.assign(isBackground.size(), 0);
  const Picture* picture = graph.labels->picture.get();
  for (size_t region = 0; region < groupOf.size(); ++region) {
    const uint32_t group = groupOf[region];
    if (isBackground[group]) continue;
    const auto sample = [&](int x, int y, size_t cell) {
      e.group[cell] = static_cast<uint16_t>(group + 1);
      ++e.cellsOf[group];
      e.expected[cell] = static_cast<uint16_t>(expectedOf[region]);
      if (picture)
        e.bin[cell] =
            colourBin(picture->red().at(x, y), picture->green().at(x, y), picture->blue().at(x, y));
    };
    for (const RegionRun& run : graph.runs.of(region)) forSamples(e, run, sample);
  }
  e.listRuns();
}

bool areApart(const Evidence& e, uint16_t a, uint16_t b) {
  if (!e.showsMovers || a == b || a == 0 || b == 0) return false;
  const uint32_t p = e.cellsOf[a - 1u], q = e.cellsOf[b - 1u];
  if (e.motionOf.empty()) return false;
  const Point v = e.motionOf[a - 1u], w = e.motionOf[b - 1u];
  const int dx = v.x - w.x, dy = v.y - w.y;
  if (dx * dx + dy * dy < kLeastApart * kLeastApart) return false;
  return 3 * std::min(p, q) >= std::max(p, q);
}

void Evidence::listRuns() {
  runs.clear();
  std::vector<uint16_t>& begins = runBegins;
  begins.resize(static_cast<size_t>(grid.width) + 1);
  for (int y = 0; y < grid.height && grid.width > 0; ++y) {
    const uint16_t* row = group.data() + at(0, y);
    const int count = simd::findRuns(row, grid.width, begins.data());
    for (size_t i = 0; i < static_cast<size_t>(count); ++i)
      if (row[begins[i]] != 0) runs.push_back({static_cast<uint16_t>(y), begins[i], begins[i + 1]});
  }
}

}  // namespace rg
