// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/pixel_runs.hpp"

#include <algorithm>

namespace rg {
namespace {

/// Root of a union-find forest whose parents have smaller indices; halves the path.
uint32_t findRoot(std::vector<uint32_t>& parents, uint32_t i) {
  while (parents[i] != i) i = parents[i] = parents[parents[i]];
  return i;
}

void unite(std::vector<uint32_t>& parents, uint32_t a, uint32_t b) {
  a = findRoot(parents, a);
  b = findRoot(parents, b);
  if (a < b)
    parents[b] = a;
  else
    parents[a] = b;
}

}  // namespace

void PixelRuns::build(const ColourLinks& links, const RunLimits& limits, const Executor& executor) {
  limits_ = limits;
  const int height = links.size().height;
  rowStarts_.assign(static_cast<size_t>(height) + 1, 0);
  executor.forRows(height, [&](int firstRow, int lastRow) {
    for (int y = firstRow; y < lastRow; ++y) {
      const Span span = links.span(y);
      const uint8_t* row = links.links(y);
      uint32_t starts = 0;
      for (int x = span.first; x < span.last; ++x) starts += startsRun(row, x);
      rowStarts_[static_cast<size_t>(y) + 1] = starts;
    }
  });
  for (size_t y = 1; y < rowStarts_.size(); ++y) rowStarts_[y] += rowStarts_[y - 1];

  runs_.resize(rowStarts_.back());
  parents_.resize(rowStarts_.back());
  const int tiles = (height + limits_.tilePx - 1) / limits_.tilePx;
  executor.forEach(tiles, [&](int tile) {
    const int first = tile * limits_.tilePx, last = std::min(first + limits_.tilePx, height);
    for (int y = first; y < last; ++y) findRuns(links, y);
    for (int y = first + 1; y < last; ++y) joinRows(links, y, parents_);
    for (uint32_t i = rowStart(first); i < rowStart(last); ++i) parents_[i] = findRoot(parents_, i);
  });
  joinTiles(links);
  numberComponents();
}

bool PixelRuns::startsRun(const uint8_t* links, int x) const {
  return (links[x] & kInScope) != 0 && ((links[x] & kLinkedLeft) == 0 || x % limits_.tilePx == 0);
}

void PixelRuns::findRuns(const ColourLinks& links, int y) {
  const Span span = links.span(y);
  const uint8_t* row = links.links(y);
  uint32_t next = rowStart(y);
  for (int x = span.first; x < span.last;) {
    if ((row[x] & kInScope) == 0) {
      ++x;
      continue;
    }
    const int first = x;
    const int end = std::min(span.last, (x / limits_.tilePx + 1) * limits_.tilePx);
    do ++x;
    while (x < end && (row[x] & kLinkedLeft) != 0);
    runs_[next] = {first, x};
    parents_[next] = next;
    ++next;
  }
}

void PixelRuns::joinRows(const ColourLinks& links, int y, std::vector<uint32_t>& parents) const {
  const uint8_t* row = links.links(y);
  forOverlaps(*this, y, [&](uint32_t i, uint32_t j, int first, int last) {
    if (std::any_of(row + first, row + last, [](uint8_t l) { return (l & kLinkedUp) != 0; }))
      unite(parents, i, j);
  });
}

void PixelRuns::joinTiles(const ColourLinks& links) {
  whole_ = parents_;
  const int height = links.size().height;
  for (int y = limits_.tilePx; y < height; y += limits_.tilePx) joinRows(links, y, whole_);
  for (int y = 0; y < height; ++y) {
    const uint8_t* row = links.links(y);
    for (uint32_t j = rowStart(y) + 1; j < rowStart(y + 1); ++j) {
      const int x = runs_[j].first;
      if (x % limits_.tilePx == 0 && runs_[j - 1].last == x && (row[x] & kLinkedLeft) != 0)
        unite(whole_, j - 1, j);
    }
  }
  areas_.assign(whole_.size(), 0);
  for (uint32_t i = 0; i < count(); ++i) {
    whole_[i] = whole_[whole_[i]];
    areas_[whole_[i]] += static_cast<uint32_t>(runs_[i].last - runs_[i].first);
  }
}

// Parents precede their children, so one sweep in raster order sees each root first.
void PixelRuns::numberComponents() {
  components_.resize(parents_.size());
  componentCount_ = 0;
  for (uint32_t i = 0; i < count(); ++i) {
    const uint32_t root = areas_[whole_[i]] > limits_.maxAreaPx ? parents_[i] : whole_[i];
    components_[i] = root == i ? componentCount_++ : components_[root];
  }
}

}  // namespace rg
