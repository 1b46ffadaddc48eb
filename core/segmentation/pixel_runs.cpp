// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/segmentation/pixel_runs.hpp"

#include "core/base/forest.hpp"
#include "core/simd/segmentation/cell_rows.hpp"
#include "core/simd/segmentation/link_rows.hpp"

#include <algorithm>
#include <bit>

namespace rg::segmentation {
namespace {

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
  labels_ = {};
  scopePlane_ = links.scope();
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

void PixelRuns::build(ImageView<const uint16_t> labels, ImageView<const uint8_t> scope,
                      const Executor& executor) {
  prepare(labels.size, {});
  labels_ = labels;
  scopePlane_ = scope;
  noLabels_.assign(static_cast<size_t>(size_.width), 0);
  executor.forRows(size_.height, [&](int firstRow, int lastRow) {
    for (int y = firstRow; y < lastRow; ++y) {
      const uint16_t* row = labels.row(y);
      uint64_t *isIn = scope_.row(y), *left = leftLinks_.row(y);
      simd::packEqual(row, noLabels_.data(), size_.width, isIn);
      for (int i = 0; i < scope_.width(); ++i) isIn[i] = ~isIn[i];
      if (const int rest = size_.width % kWordBits; rest != 0)
        isIn[scope_.width() - 1] &= ~(~uint64_t{0} << rest);
      // Bit i is that of pixel i + 1; the first pixel has no left neighbour.
      simd::packEqual(row + 1, row, size_.width - 1, left);
      if (size_.width % kWordBits == 1) left[scope_.width() - 1] = 0;
      for (int i = scope_.width() - 1; i >= 0; --i)
        left[i] = (left[i] << 1 | (i > 0 ? left[i - 1] >> (kWordBits - 1) : 0)) & isIn[i];
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
  for (auto* numbers : {&parents_, &areas_, &whole_, &wholeAreas_, &components_})
    numbers->resize(rowStarts_.back());
  bands_.resize(static_cast<size_t>((size_.height + limits_.tilePx - 1) / limits_.tilePx));
  scratch_.resize(static_cast<size_t>(executor.threads()));
  executor.forEach(bandCount(), [&](int band, int thread) {
    findParts(band, scratch_[static_cast<size_t>(thread)]);
  });
  joinBands();
  numberComponents();
}

// Rows are walked once: what touches without a link is looked at again when the parts are known.
void PixelRuns::findParts(int index, Scratch& scratch) {
  Band& band = bands_[static_cast<size_t>(index)];
  const Span rows = bandRows(index);
  const uint32_t firstRun = rowStart(rows.first), lastRun = rowStart(rows.last);
  band.cuts.clear();
  for (int y = rows.first; y < rows.last; ++y) findRuns(y, band.cuts);
  scratch.touching.makeRoomFor(2 * size_t{lastRun - firstRun});
  for (int y = rows.first + 1; y < rows.last; ++y) {
    collectOverlaps(y, scratch);
    for (const Overlap& pair : scratch.linked.all()) join(parents_, pair.upper, pair.lower);
  }
  band.parts.clear();
  band.parts.reserve(lastRun - firstRun);
  for (uint32_t i = firstRun; i < lastRun; ++i) {
    const uint32_t part = parents_[i] = parents_[parents_[i]];
    if (part == i) {
      band.parts.push_back(i);
      areas_[i] = 0;
    }
    areas_[part] += static_cast<uint32_t>(runs_[i].last - runs_[i].first);
  }
  band.inner.clear();
  for (const Overlap& pair : scratch.touching.all())
    if (const uint32_t a = parents_[pair.upper], b = parents_[pair.lower]; a != b)
      band.inner.add(a, b, pair.columns);
  for (int y = rows.first; y < rows.last; ++y) collectSides(y, band.inner);
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

// Whether two rows' runs are linked is hard to foretell, so each overlap is written to both lists
// and counted in one. There are fewer of them than runs in both rows.
void PixelRuns::collectOverlaps(int y, Scratch& scratch) const {
  const bool hasLabels = labels_.data != nullptr, hasScope = scopePlane_.data != nullptr;
  const uint16_t* labels = hasLabels ? labels_.row(y) : nullptr;
  const uint16_t* labelsAbove = hasLabels ? labels_.row(y - 1) : nullptr;
  const uint64_t* links = upLinks_.row(y);
  const uint8_t* scope = hasScope ? scopePlane_.row(y) : nullptr;
  const uint8_t* scopeAbove = hasScope ? scopePlane_.row(y - 1) : nullptr;
  const Span* runs = runs_.data();
  scratch.linked.makeRoomFor(rowStart(y + 1) - rowStart(y - 1));
  Overlap *linked = scratch.linked.list.data(), *firstLinked = linked;
  Overlap *touching = scratch.touching.list.data() + scratch.touching.count,
          *firstTouching = touching;
  uint32_t i = rowStart(y - 1), j = rowStart(y);
  const uint32_t iEnd = j, jEnd = rowStart(y + 1);
  while (i < iEnd && j < jEnd) {
    const Span upper = runs[i], lower = runs[j];
    const int first = std::max(upper.first, lower.first), last = std::min(upper.last, lower.last);
    if (first < last) {
      const bool isLinked =
          hasLabels ? labelsAbove[first] == labels[first] : isAnySet(links, first, last);
      const bool isAlike = !hasScope || scopeAbove[first] == scope[first];
      *linked = *touching = {i, j, static_cast<uint32_t>(last - first)};
      linked += isLinked;
      touching += !isLinked && isAlike;
    }
    i += upper.last <= lower.last;
    j += lower.last <= upper.last;
  }
  scratch.linked.count += static_cast<size_t>(linked - firstLinked);
  scratch.touching.count += static_cast<size_t>(touching - firstTouching);
}

void PixelRuns::collectSides(int y, BorderList& borders) const {
  const uint8_t* scope = scopePlane_.data != nullptr ? scopePlane_.row(y) : nullptr;
  for (uint32_t i = rowStart(y) + 1; i < rowStart(y + 1); ++i) {
    const uint32_t a = parents_[i - 1], b = parents_[i];
    const int x = runs_[i].first;
    if (a == b || runs_[i - 1].last != x) continue;
    if (scope == nullptr || scope[x - 1] == scope[x]) borders.add(a, b, 1);
  }
}

/// What is linked may be cut here: then it is a border, too.
void PixelRuns::joinSeam(const Scratch& scratch, BorderList& seam) {
  for (const Overlap& pair : scratch.linked.all())
    join(whole_, parents_[pair.upper], parents_[pair.lower]);
  for (const Overlaps* pairs : {&scratch.linked, &scratch.touching})
    for (const Overlap& pair : pairs->all())
      seam.add(parents_[pair.upper], parents_[pair.lower], pair.columns);
}

void PixelRuns::joinBands() {
  for (const Band& band : bands_)
    for (const uint32_t part : band.parts) {
      whole_[part] = part;
      wholeAreas_[part] = 0;
    }
  for (int index = 0; index < bandCount(); ++index) {
    Band& band = bands_[static_cast<size_t>(index)];
    band.seam.clear();
    if (const int y = bandRows(index).first; y > 0) {
      scratch_[0].touching.makeRoomFor(rowStart(y + 1) - rowStart(y - 1));
      collectOverlaps(y, scratch_[0]);
      joinSeam(scratch_[0], band.seam);
    }
    for (const uint32_t run : band.cuts) join(whole_, parents_[run - 1], parents_[run]);
  }
  for (const Band& band : bands_)
    for (const uint32_t part : band.parts) {
      const uint32_t whole = whole_[part] = rootOf(whole_, part);
      wholeAreas_[whole] += areas_[part];
    }
}

// The first run of a whole precedes its parts: one sweep in raster order sees it first.
void PixelRuns::numberComponents() {
  componentCount_ = 0;
  for (const Band& band : bands_)
    for (const uint32_t part : band.parts) {
      const uint32_t whole = whole_[part];
      const bool isCut = wholeAreas_[whole] > limits_.maxAreaPx;
      components_[part] = isCut || whole == part ? componentCount_++ : components_[whole];
    }
}

}  // namespace rg::segmentation
