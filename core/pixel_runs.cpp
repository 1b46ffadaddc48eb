// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/pixel_runs.hpp"

#include "core/simd/cell_rows.hpp"
#include "core/simd/link_rows.hpp"

#include <algorithm>
#include <bit>

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

constexpr int kWordBits = 64;

/// The word that holds the column, from the column's bit on.
uint64_t bitsFrom(const uint64_t* words, int x) {
  return words[x / kWordBits] >> (x % kWordBits);
}

bool isSet(const uint64_t* words, int x) {
  return (bitsFrom(words, x) & 1) != 0;
}

/// Whether any of the columns first … last − 1 is set.
bool isAnySet(const uint64_t* words, int first, int last) {
  for (int x = first; x < last;) {
    const int count = std::min(kWordBits - x % kWordBits, last - x);
    const uint64_t wanted = ~uint64_t{0} >> (kWordBits - count);
    if ((bitsFrom(words, x) & wanted) != 0) return true;
    x += count;
  }
  return false;
}

}  // namespace

void PixelRuns::build(const ColourLinks& links, const RunLimits& limits, const Executor& executor) {
  prepare(links.size(), limits);
  executor.forRows(size_.height, [&](int firstRow, int lastRow) {
    for (int y = firstRow; y < lastRow; ++y) {
      const uint8_t* row = links.links(y);
      simd::packRow(row, size_.width, kIsPixel, scope_.row(y));
      simd::packRow(row, size_.width, kLinkedLeft, leftLinks_.row(y));
      simd::packRow(row, size_.width, kLinkedUp, upLinks_.row(y));
      countRuns(y);
    }
  });
  findComponents(executor);
}

void PixelRuns::build(ImageView<const uint16_t> labels, const RunLimits& limits,
                      const Executor& executor) {
  prepare(labels.size, limits);
  noLabels_.assign(static_cast<size_t>(size_.width), 0);
  executor.forRows(size_.height, [&](int firstRow, int lastRow) {
    for (int y = firstRow; y < lastRow; ++y) {
      const uint16_t* row = labels.row(y);
      uint64_t *scope = scope_.row(y), *left = leftLinks_.row(y);
      simd::packEqual(row, noLabels_.data(), size_.width, scope);
      for (int i = 0; i < scope_.width(); ++i) scope[i] = ~scope[i];
      if (const int rest = size_.width % kWordBits; rest != 0)
        scope[scope_.width() - 1] &= ~(~uint64_t{0} << rest);
      // Bit i is that of pixel i + 1; the first pixel has no left neighbour.
      simd::packEqual(row + 1, row, size_.width - 1, left);
      if (size_.width % kWordBits == 1) left[scope_.width() - 1] = 0;
      for (int i = scope_.width() - 1; i >= 0; --i)
        left[i] = (left[i] << 1 | (i > 0 ? left[i - 1] >> (kWordBits - 1) : 0)) & scope[i];
      simd::packEqual(row, labels.row(std::max(y - 1, 0)), size_.width, upLinks_.row(y));
      countRuns(y);
    }
  });
  findComponents(executor);
}

void PixelRuns::prepare(Size size, const RunLimits& limits) {
  limits_ = limits;
  size_ = size;
  const Size words{(size_.width + kWordBits - 1) / kWordBits, size_.height};
  for (Image<uint64_t>* bits : {&scope_, &leftLinks_, &upLinks_}) bits->resize(words);
  tileStarts_.assign(static_cast<size_t>(words.width), 0);
  const bool cuts = limits.maxAreaPx < size.area();
  for (int x = 0; cuts && x < size_.width; x += limits_.tilePx)
    tileStarts_[static_cast<size_t>(x / kWordBits)] |= uint64_t{1} << (x % kWordBits);
  rowStarts_.assign(static_cast<size_t>(size_.height) + 1, 0);
}

void PixelRuns::findComponents(const Executor& executor) {
  for (size_t y = 1; y < rowStarts_.size(); ++y) rowStarts_[y] += rowStarts_[y - 1];
  runs_.resize(rowStarts_.back());
  parents_.resize(rowStarts_.back());
  areas_.resize(rowStarts_.back());
  cuts_.resize(static_cast<size_t>((size_.height + limits_.tilePx - 1) / limits_.tilePx));
  executor.forEach(bandCount(), [&](int band) {
    const Span rows = bandRows(band);
    std::vector<uint32_t>& cuts = cuts_[static_cast<size_t>(band)];
    cuts.clear();
    for (int y = rows.first; y < rows.last; ++y) findRuns(y, cuts);
    for (int y = rows.first + 1; y < rows.last; ++y) joinRows(y, parents_);
    for (uint32_t i = rowStart(rows.first); i < rowStart(rows.last); ++i) {
      parents_[i] = findRoot(parents_, i);
      areas_[i] = 0;
      areas_[parents_[i]] += static_cast<uint32_t>(runs_[i].last - runs_[i].first);
    }
  });
  joinTiles();
  numberComponents();
}

/// Runs begin where the scope does or where no link leads on.
void PixelRuns::countRuns(int y) {
  int starts = 0;
  for (int i = 0; i < scope_.width(); ++i)
    starts += std::popcount(scope_.row(y)[i] &
                            (~leftLinks_.row(y)[i] | tileStarts_[static_cast<size_t>(i)]));
  rowStarts_[static_cast<size_t>(y) + 1] = static_cast<uint32_t>(starts);
}

// A run ends before a pixel that is not linked to it. What is out of scope has no links.
void PixelRuns::findRuns(int y, std::vector<uint32_t>& cuts) {
  uint32_t next = rowStart(y);
  bool isOpen = false;
  uint64_t lastOfWord = 0;
  for (int i = 0; i < scope_.width(); ++i) {
    const uint64_t scope = scope_.row(y)[i];
    uint64_t ends = (~leftLinks_.row(y)[i] | tileStarts_[static_cast<size_t>(i)]) &
                    (scope | scope << 1 | lastOfWord);
    lastOfWord = scope >> (kWordBits - 1);
    for (; ends != 0; ends &= ends - 1) {
      const int bit = std::countr_zero(ends);
      const int x = i * kWordBits + bit;
      if (isOpen) runs_[next++].last = x;
      isOpen = (scope >> bit & 1) != 0;
      if (!isOpen) continue;
      runs_[next].first = x;
      parents_[next] = next;
      if (isSet(leftLinks_.row(y), x)) cuts.push_back(next);
    }
  }
  if (isOpen) runs_[next].last = size_.width;
}

void PixelRuns::joinRows(int y, std::vector<uint32_t>& parents) const {
  const uint64_t* links = upLinks_.row(y);
  forOverlaps(*this, y, [&](uint32_t i, uint32_t j, int first, int last) {
    if (isAnySet(links, first, last)) unite(parents, i, j);
  });
}

void PixelRuns::joinTiles() {
  whole_ = parents_;
  for (int band = 1; band < bandCount(); ++band) joinRows(bandRows(band).first, whole_);
  for (const std::vector<uint32_t>& cuts : cuts_)
    for (const uint32_t run : cuts) unite(whole_, run - 1, run);
  for (uint32_t i = 0; i < count(); ++i) {
    if (parents_[i] != i) continue;
    whole_[i] = findRoot(whole_, i);
    if (whole_[i] != i) areas_[whole_[i]] += areas_[i];
  }
}

// The first run of a whole precedes its parts, and that of a part its runs: one sweep in raster
// order sees each of them first.
void PixelRuns::numberComponents() {
  components_.resize(parents_.size());
  componentCount_ = 0;
  for (uint32_t i = 0; i < count(); ++i) {
    uint32_t first = parents_[i];
    if (first == i && areas_[whole_[i]] <= limits_.maxAreaPx) first = whole_[i];
    components_[i] = first == i ? componentCount_++ : components_[first];
  }
}

}  // namespace rg
