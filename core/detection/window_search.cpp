// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/detection/window_search.hpp"

#include "core/detection/cascade_window.hpp"
#include "core/detection/integral.hpp"
#include "core/simd/detection/cascade_rows.hpp"

#include <algorithm>
#include <cassert>
#include <tuple>
#include <utility>

namespace rg::detection {
namespace {

/// Windows further apart are so few that to sort sums for them takes longer than they do.
constexpr int kMostPhases = 12;

bool isSorted(int step) {
  return step > 1 && step <= kMostPhases;
}

/// Columns of a block, with room for what a vector reads behind the last window.
int phaseColumns(Size frame, int phases) {
  return (frame.width + phases) / phases + simd::kMostLanes;
}

Size sumsOf(Size frame) {
  return {frame.width + 1 + simd::kMostLanes, frame.height + 1};
}

/// The widest that a step needs.
int sortedColumns(Size frame) {
  int most = 0;
  for (int step = 2; step <= kMostPhases; ++step)
    most = std::max(most, step * phaseColumns(frame, step));
  return most;
}

}  // namespace

WindowSearch::WindowSearch(std::shared_ptr<const Cascade> cascade, std::vector<Scale> scales,
                           Size frame)
    : cascade_(std::move(cascade)),
      scales_(std::move(scales)),
      frame_(frame),
      sums_(sumsOf(frame)),
      squares_({frame.width + 1, frame.height + 1}),
      sorted_({sortedColumns(frame), frame.height + 1}) {
  sums_.fill(0);
  sorted_.fill(0);
  const ptrdiff_t rowSums = sums_.view().strideBytes / ptrdiff_t{sizeof(uint32_t)};
  const ptrdiff_t rowSorted = sorted_.view().strideBytes / ptrdiff_t{sizeof(uint32_t)};
  const ptrdiff_t rowSquares = squares_.view().strideBytes / ptrdiff_t{sizeof(double)};
  scaled_.reserve(scales_.size());
  for (const Scale& scale : scales_) {
    const int step = scale.stepPx;
    const SumLayout layout = isSorted(step)
                                 ? SumLayout{step, phaseColumns(frame, step), rowSorted, rowSquares}
                                 : SumLayout{1, 0, rowSums, rowSquares};
    scaled_.emplace_back(*cascade_, scale, layout);
    if (std::find(steps_.begin(), steps_.end(), step) == steps_.end()) steps_.push_back(step);
  }
}

Result<std::span<const Box>> WindowSearch::find(ImageView<const uint8_t> luma,
                                                std::span<const Box> areas,
                                                const Executor& executor) {
  assert(luma.size == frame_);
  if (auto laid = windows_.lay(scales_, areas); !laid) return laid.error();
  threads_.resize(static_cast<size_t>(executor.threads()));
  for (Scratch& scratch : threads_) {
    scratch.stages.resize(static_cast<size_t>(frame_.width));
    scratch.found.clear();
  }
  sumAreas(luma, areas, executor);
  for (const int step : steps_) searchStep(step, areas, executor);
  collect();
  return std::span<const Box>(boxes_);
}

void WindowSearch::sumAreas(ImageView<const uint8_t> luma, std::span<const Box> areas,
                            const Executor& executor) {
  const Integrals to{sums_, squares_};
  executor.forEach(static_cast<int>(areas.size()),
                   [&](int i) { sumArea(luma, areas[static_cast<size_t>(i)], to); });
}

void WindowSearch::searchStep(int step, std::span<const Box> areas, const Executor& executor) {
  rows_.clear();
  for (size_t i = 0; i < windows_.ranges().size(); ++i) {
    const WindowRange& range = windows_.ranges()[i];
    if (range.stepPx != step) continue;
    for (int row = 0; row < range.rows; ++row) rows_.push_back({static_cast<int>(i), row});
  }
  if (rows_.empty()) return;
  if (isSorted(step)) {
    sumRows_.clear();
    for (size_t a = 0; a < areas.size(); ++a)
      for (int y = areas[a].y; y <= areas[a].bottom(); ++y)
        sumRows_.push_back({static_cast<int>(a), y});
    executor.forRows(static_cast<int>(sumRows_.size()), [&](int first, int last) {
      for (int i = first; i < last; ++i) {
        const SumRow& row = sumRows_[static_cast<size_t>(i)];
        sortColumns(areas[static_cast<size_t>(row.area)], row.y, step);
      }
    });
  }
  executor.forEach(static_cast<int>(rows_.size()), [&](int i, int thread) {
    judge(rows_[static_cast<size_t>(i)], threads_[static_cast<size_t>(thread)]);
  });
}

void WindowSearch::sortColumns(const Box& area, int y, int phases) {
  const uint32_t* from = sums_.view().row(y);
  uint32_t* to = sorted_.view().row(y);
  const int columns = phaseColumns(frame_, phases), end = area.right() + 1;
  for (int phase = 0; phase < phases; ++phase) {
    int x = (area.x + phases - 1 - phase) / phases * phases + phase;
    for (uint32_t* sum = to + phase * columns + x / phases; x < end; x += phases) *sum++ = from[x];
  }
}

void WindowSearch::judge(const Row& row, Scratch& scratch) const {
  const WindowRange& range = windows_.ranges()[static_cast<size_t>(row.range)];
  const int y = range.origin.y + row.row * range.stepPx;
  uint16_t* stages = scratch.stages.data();
  if (isSorted(range.stepPx) || range.stepPx == 1) {
    const auto& sums = range.stepPx == 1 ? sums_ : sorted_;
    simd::judgeRow(scaled_[static_cast<size_t>(range.scale)].view(),
                   {sums.row(y) + range.origin.x / range.stepPx, squares_.row(y) + range.origin.x,
                    range.stepPx, range.columns},
                   stages);
  } else {
    judgeOneByOne(range, y, stages);
  }
  const size_t all = cascade_->stages.size();
  for (int column = 0; column < range.columns; ++column)
    if (stages[column] == all)
      scratch.found.push_back({range.scale, {range.origin.x + column * range.stepPx, y}});
}

void WindowSearch::judgeOneByOne(const WindowRange& range, int y, uint16_t* stages) const {
  const CascadeView cascade = scaled_[static_cast<size_t>(range.scale)].view();
  for (int column = 0; column < range.columns; ++column) {
    const int x = range.origin.x + column * range.stepPx;
    stages[column] = judgeWindow(cascade, sums_.row(y) + x, squares_.row(y) + x);
  }
}

void WindowSearch::collect() {
  found_.clear();
  for (const Scratch& scratch : threads_)
    found_.insert(found_.end(), scratch.found.begin(), scratch.found.end());
  std::sort(found_.begin(), found_.end(), [](const Found& a, const Found& b) {
    return std::tie(a.scale, a.at.y, a.at.x) < std::tie(b.scale, b.at.y, b.at.x);
  });
  boxes_.clear();
  for (const Found& found : found_) {
    const Size window = scales_[static_cast<size_t>(found.scale)].window;
    boxes_.push_back({found.at.x, found.at.y, window.width, window.height});
  }
}

}  // namespace rg::detection
