// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/matched_blocks.hpp"

#include <algorithm>
#include <array>
#include <cstring>
#include <numeric>

namespace rg {
namespace {

constexpr uint8_t kSame = 0xFF;
/// Rows of left_ have so many columns before and after those of the frame, all kSame.
constexpr int kMargin = 8;

void compare(const uint16_t* a, const uint16_t* b, int count, uint8_t* same) {
  for (int i = 0; i < count; ++i) same[i] = a[i] == b[i] ? kSame : uint8_t{0};
}

void intersect(const uint8_t* with, int count, uint8_t* same) {
  for (int i = 0; i < count; ++i) same[i] &= with[i];
}

/// The parts of one tile, found by label.
class Tile {
 public:
  Tile(std::vector<MatchedPart>& parts, int column, int strip)
      : parts_(parts), first_(parts.size()), at_(first_), column_(column), strip_(strip) {}

  void add(uint16_t label, int bit) {
    if (at_ == parts_.size() || parts_[at_].label != label) {
      at_ = first_;
      while (at_ < parts_.size() && parts_[at_].label != label) ++at_;
      if (at_ == parts_.size())
        parts_.push_back({0, static_cast<uint16_t>(column_), static_cast<uint16_t>(strip_), label});
    }
    parts_[at_].blocks |= uint64_t{1} << bit;
  }

 private:
  std::vector<MatchedPart>& parts_;
  size_t first_, at_;
  int column_, strip_;
};

/// Calls visit(tile, x, y, bit) for each whole block of a strip, tile by tile.
template <class Visit>
void forTiles(Size size, int strip, std::vector<MatchedPart>& parts, Visit&& visit) {
  const int top = strip * kPartHeight;
  const int rows = std::min(kPartHeight, size.height - top);
  const int blocks = size.width / kBlockWidth;
  for (int column = 0; 2 * column < blocks; ++column) {
    Tile tile(parts, column, strip);
    const int halves = std::min(2, blocks - 2 * column);
    for (int row = 0; row < rows; ++row)
      for (int half = 0; half < halves; ++half)
        visit(tile, column * kPartWidth + half * kBlockWidth, top + row, 2 * row + half);
  }
}

}  // namespace

void MatchedBlocks::find(ImageView<const uint16_t> labels, std::span<const Region> regions,
                         const Executor& executor) {
  const int strips = (labels.height() + kPartHeight - 1) / kPartHeight;
  strips_.resize(static_cast<size_t>(strips));
  compareRows(labels, executor);
  executor.forEach(strips, [&](int strip) {
    const int last = std::min((strip + 1) * kPartHeight, labels.height());
    for (int y = strip * kPartHeight; y < last; ++y) findInner(y);
    collectInner(labels, strip);
  });
  if (findThin(regions)) executor.forEach(strips, [&](int strip) { collectThin(labels, strip); });
  sortParts(regions.size());
}

void MatchedBlocks::compareRows(ImageView<const uint16_t> labels, const Executor& executor) {
  const int width = labels.width(), height = labels.height();
  left_.resize({width + 2 * kMargin, height});
  up_.resize({width, height + 1});
  inner_.resize(labels.size);
  executor.forRows(height, [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      uint8_t* left = left_.row(y);
      std::memset(left, kSame, kMargin + 1);
      std::memset(left + kMargin + width, kSame, kMargin);
      const uint16_t* row = labels.row(y);
      compare(row, row + 1, width - 1, left + kMargin + 1);
      if (y > 0) compare(labels.row(y - 1), row, width, up_.row(y));
    }
  });
  std::memset(up_.row(0), kSame, static_cast<size_t>(width));
  std::memset(up_.row(height), kSame, static_cast<size_t>(width));
}

// A pixel has the label of those n to its left when all pairs of neighbours between them agree.
void MatchedBlocks::findInner(int y) {
  const int width = inner_.width();
  uint8_t* inner = inner_.row(y);
  const uint8_t* left = left_.row(y) + kMargin;
  std::memcpy(inner, left, static_cast<size_t>(width));
  for (int step = 1 - kBorderReach; step <= kBorderReach; ++step) {
    intersect(left + step, width, inner);
    const int row = y + step;
    if (row >= 0 && row <= inner_.height()) intersect(up_.row(row), width, inner);
  }
}

void MatchedBlocks::collectInner(ImageView<const uint16_t> labels, int strip) {
  std::vector<MatchedPart>& parts = strips_[static_cast<size_t>(strip)];
  parts.clear();
  forTiles(labels.size, strip, parts, [&](Tile& tile, int x, int y, int bit) {
    uint32_t inner = 0;
    std::memcpy(&inner, inner_.row(y) + x, sizeof inner);
    if (inner != ~uint32_t{0}) return;
    if (const uint16_t label = labels.row(y)[x]; label != kNoRegion) tile.add(label, bit);
  });
}

/// True if there is any.
bool MatchedBlocks::findThin(std::span<const Region> regions) {
  counts_.assign(regions.size() + 1, 0);
  for (const auto& parts : strips_)
    for (const MatchedPart& part : parts) counts_[part.label] += part.pixels();
  isThin_.assign(regions.size() + 1, 0);
  bool hasThin = false;
  for (size_t i = 0; i < regions.size(); ++i) {
    const uint32_t inner = counts_[i + 1];
    const bool isThin = inner < kLeastInnerPx || inner < regions[i].areaPx / kInnerShare;
    isThin_[i + 1] = isThin ? 1 : 0;
    hasThin = hasThin || isThin;
  }
  return hasThin;
}

void MatchedBlocks::collectThin(ImageView<const uint16_t> labels, int strip) {
  std::vector<MatchedPart>& parts = strips_[static_cast<size_t>(strip)];
  std::erase_if(parts, [&](const MatchedPart& part) { return isThin_[part.label] != 0; });
  forTiles(labels.size, strip, parts, [&](Tile& tile, int x, int y, int bit) {
    const uint16_t* ids = labels.row(y) + x;
    if ((isThin_[ids[0]] | isThin_[ids[1]] | isThin_[ids[2]] | isThin_[ids[3]]) == 0) return;
    for (int i = 0; i < kBlockWidth - 1; ++i) {
      const auto count = std::count(ids + i, ids + kBlockWidth, ids[i]);
      const bool isFirst = std::find(ids, ids + i, ids[i]) == ids + i;
      if (isFirst && 2 * count >= kBlockWidth && isThin_[ids[i]] != 0) tile.add(ids[i], bit);
    }
  });
}

void MatchedBlocks::sortParts(size_t labelCount) {
  starts_.assign(labelCount + 2, 0);
  for (const auto& parts : strips_)
    for (const MatchedPart& part : parts) ++starts_[part.label + 1u];
  std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
  parts_.resize(starts_.back());
  for (const auto& parts : strips_)
    for (const MatchedPart& part : parts) parts_[starts_[part.label]++] = part;
}

}  // namespace rg
