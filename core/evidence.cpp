// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/evidence.hpp"

#include "core/appearance.hpp"
#include "core/simd/run_rows.hpp"

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

/// Replaces the heights of a piece's columns by the numbers of its parts: its own for the first,
/// then those that follow `count`. Returns the last number that is used. A column is a joint where
/// both sides rise to three times its height, and the lower one to half of the piece's highest; of
/// joints side by side the lowest column begins the next part.
uint32_t labelParts(std::span<uint32_t> columns, uint32_t own, uint32_t count,
                    std::vector<uint32_t>& highest) {
  const size_t width = columns.size();
  highest.assign(width + 1, 0);  // Of a column and all to its right.
  for (size_t x = width; x-- > 0;) highest[x] = std::max(highest[x + 1], columns[x]);
  const uint32_t top = highest[0];
  uint32_t label = own, left = 0;
  for (size_t x = 0; x < width;) {
    size_t lowest = x, end = x;
    const auto isJoint = [&](size_t c) {
      const uint32_t lower = std::min(left, highest[c]);
      return 3 * lower >= top && 2 * columns[c] <= lower;
    };
    for (; end < width && isJoint(end); ++end)
      if (columns[end] < columns[lowest]) lowest = end;
    if (end == x) {
      left = std::max(left, columns[x]);
      columns[x++] = label;
      continue;
    }
    std::fill(columns.begin() + static_cast<std::ptrdiff_t>(x),
              columns.begin() + static_cast<std::ptrdiff_t>(lowest), label);
    label = ++count;
    std::fill(columns.begin() + static_cast<std::ptrdiff_t>(lowest),
              columns.begin() + static_cast<std::ptrdiff_t>(end), label);
    x = end;
  }
  return count;
}

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

/// Raster neighbours that come before a cell, and the one to its right on the row above.
constexpr Point kEarlier[] = {{-1, 0}, {-1, -1}, {0, -1}, {1, -1}};

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

void findPieces(const Evidence& e, std::span<const uint16_t> owner, PieceScratch& s,
                std::vector<Piece>& pieces) {
  s.label.assign(e.group.size(), 0);
  s.parent.assign(1, 0);
  e.forForeground([&](size_t cell, int x, int y) {
    if (!owner.empty() && owner[cell] != 0) return;
    uint32_t label = 0;
    for (const Point& d : kEarlier) {
      if (x + d.x < 0 || x + d.x >= e.grid.width || y + d.y < 0) continue;
      const uint32_t other = s.label[e.at(x + d.x, y + d.y)];
      if (other == 0 || areApart(e, e.group[cell], e.group[e.at(x + d.x, y + d.y)])) continue;
      if (label != 0) join(s.parent, label, other);
      label = label == 0 ? other : std::min(label, other);
    }
    if (label == 0) {
      label = static_cast<uint32_t>(s.parent.size());
      s.parent.push_back(label);
    }
    s.label[cell] = label;
  });
  // Roots come before their members, so numbers in the order of the roots are raster order.
  uint32_t count = 0;
  for (uint32_t i = 1; i < s.parent.size(); ++i)
    s.parent[i] = s.parent[i] == i ? ++count : s.parent[s.parent[i]];
  pieces.assign(count, {});
  e.forForeground([&](size_t cell, int x, int y) {
    uint32_t& label = s.label[cell];
    if (label == 0) return;
    label = s.parent[label];
    Piece& piece = pieces[label - 1];
    ++piece.cells;
    piece.box = unite(piece.box, {x, y, 1, 1});
    if (!e.showsMovers) return;
    const uint16_t group = e.group[cell];
    if (piece.group == 0 || e.cellsOf[group - 1u] > e.cellsOf[piece.group - 1u])
      piece.group = group;
  });
}

void cutPieces(const Evidence& e, PieceScratch& s, std::vector<Piece>& pieces) {
  // Columns of all pieces one after another: their sum is at most the number of cells.
  s.firstColumn.assign(1, 0);
  for (const Piece& piece : pieces)
    s.firstColumn.push_back(s.firstColumn.back() + static_cast<uint32_t>(piece.box.width));
  s.columns.assign(s.firstColumn.back(), 0);
  const auto columnOf = [&](uint32_t label, int x) {
    return s.firstColumn[label - 1] + static_cast<uint32_t>(x - pieces[label - 1].box.x);
  };
  const auto forCells = [&](auto&& visit) {
    e.forForeground([&](size_t cell, int x, int y) {
      if (uint32_t& label = s.label[cell]; label != 0) visit(label, x, y);
    });
  };
  forCells([&](uint32_t label, int x, int) { ++s.columns[columnOf(label, x)]; });
  const auto whole = static_cast<uint32_t>(pieces.size());
  uint32_t count = whole;
  for (uint32_t i = 0; i < whole; ++i) {
    const auto first = s.columns.begin() + s.firstColumn[i];
    count = labelParts({first, first + pieces[i].box.width}, i + 1, count, s.highest);
  }
  if (count == whole) return;
  s.cut.assign(count, {});
  forCells([&](uint32_t& label, int x, int y) {
    label = s.columns[columnOf(label, x)];
    Piece& part = s.cut[label - 1];
    ++part.cells;
    part.box = unite(part.box, {x, y, 1, 1});
  });
  pieces.swap(s.cut);
}

}  // namespace rg
