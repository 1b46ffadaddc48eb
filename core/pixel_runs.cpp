// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/pixel_runs.hpp"

#include <algorithm>

namespace rg {
namespace {

constexpr bool startsRun(uint8_t links) {
  return (links & (kInScope | kLinkedLeft)) == kInScope;
}

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

void PixelRuns::build(const ColourLinks& links, const Executor& executor) {
  const int height = links.size().height;
  rowStarts_.assign(static_cast<size_t>(height) + 1, 0);
  executor.forRows(height, [&](int firstRow, int lastRow) {
    for (int y = firstRow; y < lastRow; ++y) {
      const Span span = links.span(y);
      const uint8_t* row = links.links(y);
      uint32_t starts = 0;
      for (int x = span.first; x < span.last; ++x) starts += startsRun(row[x]);
      rowStarts_[static_cast<size_t>(y) + 1] = starts;
    }
  });
  for (size_t y = 1; y < rowStarts_.size(); ++y) rowStarts_[y] += rowStarts_[y - 1];

  runs_.resize(rowStarts_.back());
  parents_.resize(rowStarts_.back());
  seams_.assign(static_cast<size_t>(height), 0);
  executor.forRows(height, [&](int first, int last) {
    for (int y = first; y < last; ++y) findRuns(links, y);
    seams_[static_cast<size_t>(first)] = first > 0;
    for (int y = first + 1; y < last; ++y) joinRows(links, y);
    for (uint32_t i = rowStart(first); i < rowStart(last); ++i) findRoot(parents_, i);
  });
  for (int y = 1; y < height; ++y)
    if (seams_[static_cast<size_t>(y)] != 0) joinRows(links, y);
  numberComponents();
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
    do ++x;
    while (x < span.last && (row[x] & kLinkedLeft) != 0);
    runs_[next] = {first, x};
    parents_[next] = next;
    ++next;
  }
}

void PixelRuns::joinRows(const ColourLinks& links, int y) {
  const uint8_t* row = links.links(y);
  forOverlaps(*this, y, [&](uint32_t i, uint32_t j, int first, int last) {
    if (std::any_of(row + first, row + last, [](uint8_t l) { return (l & kLinkedUp) != 0; }))
      unite(parents_, i, j);
  });
}

// Parents precede their children, so one sweep in raster order sees each root first.
void PixelRuns::numberComponents() {
  components_.resize(parents_.size());
  componentCount_ = 0;
  for (uint32_t i = 0; i < count(); ++i)
    components_[i] = parents_[i] == i ? componentCount_++ : components_[parents_[i]];
}

}  // namespace rg
