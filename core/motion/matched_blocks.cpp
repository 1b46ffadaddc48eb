// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/motion/matched_blocks.hpp"

#include "core/base/bit_mask.hpp"
#include "core/simd/base/run_rows.hpp"

#include <algorithm>
#include <functional>

namespace rg::motion {
namespace {

constexpr size_t kMostChunks = 64;
constexpr uint64_t kBlockBits = 0x1111111111111111;
constexpr uint64_t kPartBits = (uint64_t{1} << kPartWidth) - 1;

uint32_t countPixels(std::span<const MatchedPart> parts) {
  uint32_t pixels = 0;
  for (const MatchedPart& part : parts) pixels += part.pixels();
  return pixels;
}

/// Unequal for all regions.
uint64_t rankOf(size_t region, uint32_t pixels) {
  return uint64_t{pixels} << 32 | (UINT32_MAX - static_cast<uint32_t>(region));
}

}  // namespace

void MatchedBlocks::find(const graph::Graph& graph, const Executor& executor) {
  size_ = graph.size;
  findSteady(graph.labels->ids, executor);
  cutChunks(graph.runs);
  starts_.assign(graph.regions.size() + 1, 0);
  pixels_.resize(graph.regions.size());
  gradients_.resize(graph.regions.size());
  executor.forEach(static_cast<int>(chunks_.size()),
                   [&](int i) { collect(graph, chunks_[static_cast<size_t>(i)]); });
  dropSmallest();
  joinChunks(graph.regions.size(), executor);
}

// A column has one label from n rows above to n below when all pairs of neighbours between agree.
void MatchedBlocks::findSteady(ImageView<const uint16_t> labels, const Executor& executor) {
  const int width = labels.width(), height = labels.height(), words = (width + 63) / 64;
  same_.resize({words, height});
  steady_.resize({words, height});
  executor.forRows(height, [&](int first, int last) {
    for (int y = std::max(first, 1); y < last; ++y)
      rg::simd::compareLabels(labels.row(y - 1), labels.row(y), width, same_.row(y));
  });
  executor.forRows(height, [&](int first, int last) {
    for (int y = first; y < last; ++y) {
      uint64_t* steady = steady_.row(y);
      std::fill_n(steady, words, ~uint64_t{0});
      for (int row = std::max(y - kBorderReach + 1, 1);
           row <= std::min(y + kBorderReach, height - 1); ++row)
        for (int i = 0; i < words; ++i) steady[i] &= same_.row(row)[i];
      for (int i = 0; i < words; ++i) {
        const uint64_t pairs = steady[i] & steady[i] >> 1;
        steady[i] = pairs & pairs >> 2 & kBlockBits;
      }
    }
  });
}

/// About equal numbers of runs, whole regions.
void MatchedBlocks::cutChunks(const graph::RegionRuns& runs) {
  const size_t regions = runs.starts.size() - 1, least = runs.list.size() / kMostChunks + 1;
  chunks_.resize(kMostChunks);
  size_t first = 0;
  for (Chunk& chunk : chunks_) {
    const size_t end = runs.starts[first] + least;
    const auto from = runs.starts.begin() + static_cast<std::ptrdiff_t>(first);
    const auto last = static_cast<size_t>(std::lower_bound(from, runs.starts.end() - 1, end) -
                                          runs.starts.begin());
    chunk.first = static_cast<uint32_t>(first);
    chunk.last = static_cast<uint32_t>(last);
    first = last;
  }
  chunks_.back().last = static_cast<uint32_t>(regions);
}

void MatchedBlocks::collect(const graph::Graph& graph, Chunk& chunk) {
  chunk.parts.clear();
  chunk.places.resize(static_cast<size_t>(size_.width / kPartWidth) + 1);
  for (uint32_t region = chunk.first; region < chunk.last; ++region) {
    const size_t begin = chunk.stripFirst = chunk.parts.size();
    const auto label = segmentation::RegionLabel::ofIndex(region);
    const auto runs = graph.runs.of(region);
    for (const Run& run : runs) addInner(run, label, chunk);
    closeStrip(chunk);
    const uint32_t inner = countPixels(std::span(chunk.parts).subspan(begin));
    if (inner < kLeastInnerPx || inner < graph.regions[region].areaPx / kInnerShare) {
      chunk.parts.resize(begin);
      chunk.stripFirst = begin;
      std::pair<int, int> open{-1, 0};
      for (const Run& run : runs) addHalves(run, label, open, chunk);
      closeStrip(chunk);
    }
    gradients_[region] = keepEnough(graph.picture->luma(), chunk, begin);
    pixels_[region] = countPixels(std::span(chunk.parts).subspan(begin));
    starts_[region] = static_cast<uint32_t>(chunk.parts.size() - begin);
  }
}

/// Of the region whose parts begin there. Returns the sums over what is left.
GradientProducts MatchedBlocks::keepEnough(ImageView<const uint8_t> luma, Chunk& chunk,
                                           size_t begin) {
  const std::span<MatchedPart> parts = std::span(chunk.parts).subspan(begin);
  if (countPixels(parts) <= kEnoughPx) return sumGradients(parts, luma);
  const GradientProducts gradients = keepTextured(luma, parts, chunk.texture);
  const auto left = std::remove_if(parts.begin(), parts.end(),
                                   [](const MatchedPart& part) { return part.blocks == 0; });
  chunk.parts.resize(begin + static_cast<size_t>(left - parts.begin()));
  chunk.stripFirst = chunk.parts.size();
  return gradients;
}

void MatchedBlocks::addInner(const Run& run, segmentation::RegionLabel label, Chunk& chunk) const {
  const int begin = run.begin == 0 ? 0 : run.begin + kBorderReach;
  const int end = run.end == size_.width ? run.end : run.end - kBorderReach;
  const int first = (begin + kBlockWidth - 1) / kBlockWidth * kBlockWidth;
  const int last = end / kBlockWidth * kBlockWidth;
  const uint64_t* steady = steady_.row(run.y);
  for (int word = first / kWordColumns; word * kWordColumns < last; ++word) {
    const int x = word * kWordColumns;
    uint64_t bits = steady[word];
    if (x < first) bits &= ~uint64_t{0} << (first - x);
    if (last - x < kWordColumns) bits &= ~(~uint64_t{0} << (last - x));
    while (bits != 0) {
      const int column = std::countr_zero(bits) / kPartWidth;
      const uint64_t halves = bits >> (column * kPartWidth);
      add(run, x / kPartWidth + column, (halves | halves >> (kBlockWidth - 1)) & 3, label, chunk);
      bits &= ~(kPartBits << (column * kPartWidth));
    }
  }
}

/// open: the block that the runs before ended in, as its number in a picture of whole blocks, and
/// how many of its pixels they hold.
void MatchedBlocks::addHalves(const Run& run, segmentation::RegionLabel label,
                              std::pair<int, int>& open, Chunk& chunk) const {
  const int blocks = size_.width / kBlockWidth;
  for (int block = run.begin / kBlockWidth; block * kBlockWidth < run.end && block < blocks;
       ++block) {
    const int x = block * kBlockWidth;
    const int pixels = std::min(run.end - x, kBlockWidth) - std::max(run.begin - x, 0);
    const int number = run.y * blocks + block;
    open = {number, open.first == number ? open.second + pixels : pixels};
    if (2 * open.second >= kBlockWidth) add(run, block / 2, uint64_t{1} << block % 2, label, chunk);
  }
}

void MatchedBlocks::add(const Run& run, int column, uint64_t halves,
                        segmentation::RegionLabel label, Chunk& chunk) {
  const int strip = run.y / kPartHeight;
  if (chunk.parts.size() > chunk.stripFirst && chunk.parts[chunk.stripFirst].strip != strip)
    closeStrip(chunk);
  uint32_t& place = chunk.places[static_cast<size_t>(column)];
  if (place < chunk.stripFirst || place >= chunk.parts.size() ||
      chunk.parts[place].column != column) {
    place = static_cast<uint32_t>(chunk.parts.size());
    chunk.parts.push_back({0, static_cast<uint16_t>(column), static_cast<uint16_t>(strip), label});
  }
  chunk.parts[place].blocks |= halves << (2 * (run.y % kPartHeight));
}

void MatchedBlocks::closeStrip(Chunk& chunk) {
  std::sort(chunk.parts.begin() + static_cast<std::ptrdiff_t>(chunk.stripFirst), chunk.parts.end(),
            [](const MatchedPart& a, const MatchedPart& b) { return a.column < b.column; });
  chunk.stripFirst = chunk.parts.size();
}

void MatchedBlocks::dropSmallest() {
  const size_t most = mostMatched(size_);
  ranks_.clear();
  ranks_.reserve(pixels_.size());
  for (size_t i = 0; i < pixels_.size(); ++i)
    if (pixels_[i] > 0) ranks_.push_back(rankOf(i, pixels_[i]));
  if (ranks_.size() <= most) return;
  const auto last = ranks_.begin() + static_cast<std::ptrdiff_t>(most - 1);
  std::nth_element(ranks_.begin(), last, ranks_.end(), std::greater<>());
  const uint64_t least = *last;
  for (size_t i = 0; i < pixels_.size(); ++i)
    if (rankOf(i, pixels_[i]) < least) pixels_[i] = 0;
}

/// `starts_` holds the regions' numbers of parts before; those without pixels don't count.
void MatchedBlocks::joinChunks(size_t labelCount, const Executor& executor) {
  for (Chunk& chunk : chunks_) {
    size_t from = 0, kept = 0;
    for (uint32_t region = chunk.first; region < chunk.last; ++region) {
      const size_t count = starts_[region];
      if (pixels_[region] == 0) starts_[region] = 0;
      const auto first = chunk.parts.begin() + static_cast<std::ptrdiff_t>(from);
      if (kept != from && starts_[region] > 0)
        std::copy_n(first, count, chunk.parts.begin() + static_cast<std::ptrdiff_t>(kept));
      from += count;
      kept += starts_[region];
    }
    chunk.parts.resize(kept);
  }
  uint32_t sum = 0;
  for (uint32_t& start : starts_) start = std::exchange(sum, sum + start);
  parts_.resize(starts_[labelCount]);
  executor.forEach(static_cast<int>(chunks_.size()), [&](int i) {
    const Chunk& chunk = chunks_[static_cast<size_t>(i)];
    std::copy(chunk.parts.begin(), chunk.parts.end(),
              parts_.begin() + static_cast<std::ptrdiff_t>(starts_[chunk.first]));
  });
}

}  // namespace rg::motion
