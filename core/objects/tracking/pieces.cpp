// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/tracking/pieces.hpp"

#include "core/base/forest.hpp"

#include <algorithm>

namespace rg::objects {
namespace {

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

uint16_t groupOf(const Run& run, const GroupGrid& e) {
  return e.group[e.at(run.begin, run.y)];
}

/// The runs of the foreground that nobody owns.
void listFree(const GroupGrid& e, std::span<const uint16_t> owner, std::vector<Run>& runs) {
  if (owner.empty()) {
    runs = e.runs;
    return;
  }
  runs.clear();
  e.forParts(owner, [&](const Run& part, uint16_t track) {
    if (track == 0) runs.push_back(part);
  });
}

/// Joins the runs that touch, corners included; where groups are parted, those of one.
void joinRuns(const GroupGrid& e, bool areParted, const std::vector<Run>& runs,
              std::vector<uint32_t>& parent) {
  parent.resize(runs.size());
  const auto tryJoin = [&](uint32_t a, uint32_t b) {
    if (!areParted || groupOf(runs[a], e) == groupOf(runs[b], e)) join(parent, a, b);
  };
  uint32_t above = 0;  // None before it reaches down to the present run.
  for (uint32_t i = 0; i < runs.size(); ++i) {
    const Run& run = runs[i];
    parent[i] = i;
    if (i > 0 && runs[i - 1].y == run.y && runs[i - 1].end == run.begin) tryJoin(i - 1, i);
    while (runs[above].y + 1 < run.y || (runs[above].y < run.y && runs[above].end < run.begin))
      ++above;
    for (uint32_t n = above; runs[n].y < run.y && runs[n].begin <= run.end; ++n) tryJoin(n, i);
  }
}

}  // namespace

void findPieces(const GroupGrid& e, std::span<const uint16_t> owner, bool areParted,
                PieceScratch& s, std::vector<Piece>& pieces) {
  if (s.grid != e.grid) {
    s.grid = e.grid;
    s.label.assign(e.group.size(), 0);
    s.runs.clear();
  }
  const auto fill = [&](const Run& run, uint32_t label) {
    std::fill_n(s.label.data() + e.at(run.begin, run.y), run.end - run.begin, label);
  };
  for (const Run& run : s.runs) fill(run, 0);
  listFree(e, owner, s.runs);
  joinRuns(e, areParted, s.runs, s.parent);
  pieces.assign(numberSets(s.parent), {});
  for (size_t i = 0; i < s.runs.size(); ++i) {
    const Run& run = s.runs[i];
    const int width = run.end - run.begin;
    Piece& piece = pieces[s.parent[i]];
    fill(run, s.parent[i] + 1);
    piece.cells += static_cast<uint32_t>(width);
    piece.box = unite(piece.box, {run.begin, run.y, width, 1});
    piece.group = groupOf(run, e);
  }
}

void cutPieces(const GroupGrid& e, PieceScratch& s, std::vector<Piece>& pieces) {
  // Columns of all pieces one after another: their sum is at most the number of cells.
  s.firstColumn.assign(1, 0);
  for (const Piece& piece : pieces)
    s.firstColumn.push_back(s.firstColumn.back() + static_cast<uint32_t>(piece.box.width));
  s.columns.assign(s.firstColumn.back(), 0);
  const auto columnsOf = [&](const Run& run) {
    const uint32_t piece = s.label[e.at(run.begin, run.y)] - 1;
    const auto first = s.columns.begin() + s.firstColumn[piece] + run.begin - pieces[piece].box.x;
    return std::span(first, first + (run.end - run.begin));
  };
  for (const Run& run : s.runs)
    for (uint32_t& height : columnsOf(run)) ++height;
  const auto whole = static_cast<uint32_t>(pieces.size());
  uint32_t count = whole;
  for (uint32_t i = 0; i < whole; ++i) {
    const auto first = s.columns.begin() + s.firstColumn[i];
    count = labelParts({first, first + pieces[i].box.width}, i + 1, count, s.highest);
  }
  if (count == whole) return;
  s.cut.assign(count, {});
  for (const Run& run : s.runs) {
    const std::span<const uint32_t> labels = columnsOf(run);
    std::copy(labels.begin(), labels.end(),
              s.label.begin() + static_cast<std::ptrdiff_t>(e.at(run.begin, run.y)));
    for (size_t first = 0, last = 0; first < labels.size(); first = last) {
      while (last < labels.size() && labels[last] == labels[first]) ++last;
      Piece& part = s.cut[labels[first] - 1];
      part.cells += static_cast<uint32_t>(last - first);
      part.box = unite(part.box, {run.begin + static_cast<int>(first), run.y,
                                  static_cast<int>(last - first), 1});
      part.group = groupOf(run, e);
    }
  }
  pieces.swap(s.cut);
}

}  // namespace rg::objects
