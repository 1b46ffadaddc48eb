// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/evidence.hpp"

#include "core/appearance.hpp"

#include <algorithm>

namespace rg {
namespace {

constexpr int kGridLines = 192;  // A person in a wide view still spans some ten cells.
constexpr uint8_t kUnknownBin = kColourBins - 1;

uint32_t rootOf(std::vector<uint32_t>& parent, uint32_t node) {
  while (parent[node] != node) node = parent[node] = parent[parent[node]];
  return node;
}

void join(std::vector<uint32_t>& parent, uint32_t a, uint32_t b) {
  const uint32_t rootA = rootOf(parent, a), rootB = rootOf(parent, b);
  parent[std::max(rootA, rootB)] = std::min(rootA, rootB);
}

/// Raster neighbours that come before a cell, and the one to its right on the row above.
constexpr Point kEarlier[] = {{-1, 0}, {-1, -1}, {0, -1}, {1, -1}};

}  // namespace

void gather(const Graph& graph, std::span<const uint32_t> groupOf,
            std::span<const uint8_t> isBackground, Evidence& e) {
  e.frame = graph.size;
  e.stepPx = std::max(1, std::min(e.frame.width, e.frame.height) / kGridLines);
  e.grid = {(e.frame.width + e.stepPx - 1) / e.stepPx, (e.frame.height + e.stepPx - 1) / e.stepPx};
  const auto cells = static_cast<size_t>(e.grid.area());
  e.group.assign(cells, 0);
  e.bin.assign(cells, kUnknownBin);
  e.cellsOf.assign(isBackground.size(), 0);
  const Labels& labels = *graph.labels;
  const Picture* picture = labels.picture.get();
  for (int cy = 0; cy < e.grid.height; ++cy) {
    const uint16_t* ids = labels.ids.row(e.middleOf(0, cy).y);
    for (int cx = 0; cx < e.grid.width; ++cx) {
      const auto [x, y] = e.middleOf(cx, cy);
      if (ids[x] == kNoRegion || ids[x] > groupOf.size()) continue;
      const uint32_t group = groupOf[ids[x] - 1u];
      if (isBackground[group]) continue;
      e.group[e.at(cx, cy)] = static_cast<uint16_t>(group + 1);
      ++e.cellsOf[group];
      if (picture)
        e.bin[e.at(cx, cy)] =
            colourBin(picture->red().at(x, y), picture->green().at(x, y), picture->blue().at(x, y));
    }
  }
}

void findPieces(const Evidence& e, std::span<const uint16_t> owner, PieceScratch& s,
                std::vector<Piece>& pieces) {
  const auto isFree = [&](size_t cell) { return e.group[cell] != 0 && owner[cell] == 0; };
  s.label.assign(e.group.size(), 0);
  s.parent.assign(1, 0);
  for (int y = 0; y < e.grid.height; ++y)
    for (int x = 0; x < e.grid.width; ++x) {
      const size_t cell = e.at(x, y);
      if (!isFree(cell)) continue;
      uint32_t label = 0;
      for (const Point& d : kEarlier) {
        if (x + d.x < 0 || x + d.x >= e.grid.width || y + d.y < 0) continue;
        const uint32_t other = s.label[e.at(x + d.x, y + d.y)];
        if (other == 0) continue;
        if (label != 0) join(s.parent, label, other);
        label = label == 0 ? other : std::min(label, other);
      }
      if (label == 0) {
        label = static_cast<uint32_t>(s.parent.size());
        s.parent.push_back(label);
      }
      s.label[cell] = label;
    }
  // Roots come before their members, so numbers in the order of the roots are raster order.
  uint32_t count = 0;
  for (uint32_t i = 1; i < s.parent.size(); ++i)
    s.parent[i] = s.parent[i] == i ? ++count : s.parent[s.parent[i]];
  pieces.assign(count, {});
  for (int y = 0; y < e.grid.height; ++y)
    for (int x = 0; x < e.grid.width; ++x) {
      uint32_t& label = s.label[e.at(x, y)];
      if (label == 0) continue;
      label = s.parent[label];
      Piece& piece = pieces[label - 1];
      ++piece.cells;
      piece.box = unite(piece.box, {x, y, 1, 1});
    }
}

}  // namespace rg
