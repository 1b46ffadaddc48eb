// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/matched_blocks.hpp"

#include "core/simd/run_rows.hpp"

#include <algorithm>
#include <numeric>

namespace rg {
namespace {

constexpr size_t kMostChunks = 64;
constexpr uint64_t kBlockBits = 0x1111111111111111;

}  // namespace

void MatchedBlocks::find(const Graph& graph, const Executor& executor) {
  size_ = graph.size;
  findSteady(graph.labels->ids, executor);
  cutChunks(graph.runs);
  starts_.assign(graph.regions.size() + 1, 0);
  executor.forEach(static_cast<int>(chunks_.size()),
                   [&](int i) { collect(graph, chunks_[static_cast<size_t>(i)]); });
  joinChunks(graph.regions.size(), executor);
}

// A column has one label from n rows above to n below when all pairs of neighbours between agree.
void MatchedBlocks::findSteady(ImageView<const uint16_t> labels, const Executor& executor) {
  const int width = labels.width(), height = labels.height(), words = (width + 63) / 64;
  same_.resize({words, height});
  steady_.resize({words, height});
  executor.forRows(height, [&](int first, int last) {
    for (int y = std::max(first, 1); y < last; ++y)
      simd::compareLabels(labels.row(y - 1), labels.row(y), width, same_.row(y));
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
void MatchedBlocks::cutChunks(const RegionRuns& runs) {
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

void MatchedBlocks::collect(const Graph& graph, Chunk& chunk) {
  chunk.parts.clear();
  chunk.places.resize(static_cast<size_t>(size_.width / kPartWidth) + 1);
  for (uint32_t region = chunk.first; region < chunk.last; ++region) {
    const size_t begin = chunk.stripFirst = chunk.parts.size();
    const auto label = static_cast<uint16_t>(region + 1);
    const auto runs = graph.runs.of(region);
    for (const RegionRun& run : runs) addInner(run, label, chunk);
    closeStrip(chunk);
    uint32_t inner = 0;
    for (size_t i = begin; i < chunk.parts.size(); ++i) inner += chunk.parts[i].pixels();
    if (inner < kLeastInnerPx || inner < graph.regions[region].areaPx / kInnerShare) {
      chunk.parts.resize(begin);
      chunk.stripFirst = begin;
      std::pair<int, int> open{-1, 0};
      for (const RegionRun& run : runs) addHalves(run, label, open, chunk);
      closeStrip(chunk);
    }
    starts_[region] = static_cast<uint32_t>(chunk.parts.size() - begin);
  }
}

void MatchedBlocks::addInner(const RegionRun& run, uint16_t label, Chunk& chunk) const {
  const int begin = run.begin == 0 ? 0 : run.begin + kBorderReach;
  const int end = run.end == size_.width ? run.end : run.end - kBorderReach;
  const int first = (begin + kBlockWidth - 1) / kBlockWidth * kBlockWidth;
  const int last = end / kBlockWidth * kBlockWidth;
  const uint64_t* steady = steady_.row(run.y);
  for (int x = first / kPartWidth * kPartWidth; x < last; x += kPartWidth) {
    const uint64_t bits = steady[x / 64] >> (x % 64);
    const uint64_t left = x >= first ? bits & 1 : 0;
    const uint64_t right = x + kBlockWidth < last ? bits >> kBlockWidth & 1 : 0;
    if ((left | right) != 0) add(run, x / kPartWidth, left | right << 1, label, chunk);
  }
}

/// open: the block that the runs before ended in, as its number in a picture of whole blocks, and
/// how many of its pixels they hold.
void MatchedBlocks::addHalves(const RegionRun& run, uint16_t label, std::pair<int, int>& open,
                              Chunk& chunk) const {
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

void MatchedBlocks::add(const RegionRun& run, int column, uint64_t halves, uint16_t label,
                        Chunk& chunk) {
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

/// `starts_` holds the regions' numbers of parts before.
void MatchedBlocks::joinChunks(size_t labelCount, const Executor& executor) {
  uint32_t sum = 0;
  for (uint32_t& start : starts_) start = std::exchange(sum, sum + start);
  parts_.resize(starts_[labelCount]);
  executor.forEach(static_cast<int>(chunks_.size()), [&](int i) {
    const Chunk& chunk = chunks_[static_cast<size_t>(i)];
    std::copy(chunk.parts.begin(), chunk.parts.end(),
              parts_.begin() + static_cast<std::ptrdiff_t>(starts_[chunk.first]));
  });
}

}  // namespace rg
