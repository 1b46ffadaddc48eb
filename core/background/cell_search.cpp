// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/cell_search.hpp"

#include <algorithm>
#include <cstring>

namespace rg::background {
namespace {

constexpr int kCellsInTask = 64;

constexpr int cellsOver(int pixels) {
  return (pixels + kCellPx - 1) / kCellPx;
}

/// 1 for each of eight bytes that is 255, 0 for each that is 0.
constexpr uint64_t onesOf(uint64_t bytes) {
  return bytes & 0x0101010101010101ull;
}

}  // namespace

void CellSearch::prepare(Size frame) {
  if (frame == frame_) return;
  frame_ = frame;
  const Size grid{cellsOver(frame.width), cellsOver(frame.height)};
  // Whole cells, so that counting needs no special case at the right border.
  pixels_.resize({grid.width * kCellPx + 2, frame.height + 2});
  pixels_.fill(0);
  isHit_.assign(static_cast<size_t>(grid.width) * kCellPx, 0);
  for (Image<uint8_t>* image : {&found_, &moved_, &isOccupied_, &isSeed_, &isLooked_})
    image->resize(grid);
}

void CellSearch::begin() {
  for (Image<uint8_t>* image : {&found_, &moved_, &isOccupied_, &isSeed_, &isLooked_})
    image->fill(0);
  runs_.clear();
  tasks_.clear();
  hits_.clear();
}

void CellSearch::addArea(const Box& areaPx) {
  const Box box = intersect(areaPx, boundsOf(frame_));
  const size_t first = runs_.size();
  if (box.isEmpty()) return;
  const int left = box.x / kCellPx, right = cellsOver(box.right());
  for (int y = box.y / kCellPx; y < cellsOver(box.bottom()); ++y) {
    uint8_t* seeds = isSeed_.row(y);
    for (int x = left; x < right; ++x) {
      if (seeds[x] != 0) continue;
      seeds[x] = 1;
      const bool continues = runs_.size() > first && runs_.back().y == y && runs_.back().end == x;
      if (continues)
        ++runs_.back().end;
      else
        runs_.push_back(runOf(y, x, x + 1));
    }
  }
  if (runs_.size() > first) tasks_.push_back({first, runs_.size()});
}

void CellSearch::addHits(const uint8_t* changes, int y, int threshold) {
  const auto limit = static_cast<uint8_t>(threshold);
  const int width = frame_.width, cells = found_.width();
  uint8_t* isHit = isHit_.data();
  for (int x = 0; x < width; ++x) isHit[x] = static_cast<uint8_t>(changes[x] > limit ? 255 : 0);
  uint8_t* seeds = isSeed_.row(y / kCellPx);
  for (int x = 0; x < cells; ++x) {
    uint64_t word;
    std::memcpy(&word, isHit + x * kCellPx, sizeof word);
    if (word == 0 || seeds[x] != 0) continue;
    seeds[x] = 1;
    hits_.push_back({x, y / kCellPx});
  }
}

Run CellSearch::pixelsOf(const Run& cells, int row) const {
  return runOf(cells.y * kCellPx + row, cells.begin * kCellPx,
               std::min(cells.end * kCellPx, frame_.width));
}

void CellSearch::look(const Run& cells, const Comparison& what) {
  const int rows = std::min(kCellPx, frame_.height - cells.y * kCellPx);
  for (int row = 0; row < rows; ++row) {
    const Run at = pixelsOf(cells, row);
    uint8_t* out = pixels_.row(at.y + 1) + 1 + at.begin;
    if (what.before.green.data)
      markChange(what.now, what.before, at, what.threshold, out);
    else
      std::fill_n(out, at.end - at.begin, uint8_t{0});
  }
  count(cells);
  std::copy(found_.row(cells.y) + cells.begin, found_.row(cells.y) + cells.end,
            moved_.row(cells.y) + cells.begin);
}

void CellSearch::recall(const Run& cells, const Comparison& what) {
  const int rows = std::min(kCellPx, frame_.height - cells.y * kCellPx);
  for (int row = 0; row < rows; ++row) {
    const Run at = pixelsOf(cells, row);
    what.memory.addStrange(what.now, at, what.sceneThreshold, pixels_.row(at.y + 1) + 1 + at.begin);
  }
  count(cells);
}

void CellSearch::count(const Run& cells) {
  const int rows = std::min(kCellPx, frame_.height - cells.y * kCellPx);
  for (int x = cells.begin; x < cells.end; ++x) {
    uint64_t sums = 0;  // At most 8 in each byte.
    for (int row = 0; row < rows; ++row) {
      uint64_t word = 0;
      std::memcpy(&word, pixels_.row(cells.y * kCellPx + row + 1) + 1 + x * kCellPx, sizeof word);
      sums += onesOf(word);
    }
    const auto total = static_cast<uint8_t>(sums * 0x0101010101010101ull >> 56);
    found_.at(x, cells.y) = total;
    isOccupied_.at(x, cells.y) = total >= kLeastOccupied ? 255 : 0;
  }
}

void CellSearch::run(SearchScope search, const Comparison& what, const Executor& executor) {
  const int cells = static_cast<int>(found_.size().area());
  size_t seeds = hits_.size();
  for (const Run& run : runs_) seeds += static_cast<size_t>(run.end - run.begin);
  // From half of the frame on, going from cell to cell costs more than it saves.
  if (search == SearchScope::Frame || seeds * 2 > static_cast<size_t>(cells))
    lookEverywhere(what, executor);
  else
    lookInAreas(what, executor);
  findParts();
}

void CellSearch::take(std::span<const CellCounts> cells) {
  const auto width = static_cast<size_t>(found_.width());
  isSeed_.changeOnHost();
  for (int y = 0; y < found_.height(); ++y) {
    const auto row = cells.subspan(static_cast<size_t>(y) * width, width);
    for (size_t x = 0; x < width; ++x) {
      found_.row(y)[x] = row[x].found;
      moved_.row(y)[x] = row[x].moved;
      isOccupied_.row(y)[x] = row[x].found >= kLeastOccupied ? 255 : 0;
      if (row[x].hits > 0) isSeed_.row(y)[x] = 1;
    }
  }
  looked_ = static_cast<int>(cells.size());
  findParts();
}

void CellSearch::lookEverywhere(const Comparison& what, const Executor& executor) {
  executor.forRows(found_.height(), [&](int first, int last) {
    for (int y = first; y < last; ++y) look(runOf(y, 0, found_.width()), what);
  });
  executor.forEach(static_cast<int>(tasks_.size()), [&](int task) {
    const auto [first, last] = tasks_[static_cast<size_t>(task)];
    for (size_t i = first; i < last; ++i) recall(runs_[i], what);
  });
  looked_ = static_cast<int>(found_.size().area());
}

void CellSearch::lookInAreas(const Comparison& what, const Executor& executor) {
  executor.forEach(static_cast<int>(tasks_.size()), [&](int task) {
    const auto [first, last] = tasks_[static_cast<size_t>(task)];
    for (size_t i = first; i < last; ++i) {
      look(runs_[i], what);
      recall(runs_[i], what);
    }
  });
  looked_ = 0;
  frontier_.clear();
  for (const Run& run : runs_)
    for (int x = run.begin; x < run.end; ++x) note(x, run.y, frontier_);
  next_.clear();
  for (const Point& hit : hits_) note(hit.x, hit.y, next_);
  lookAtCells(next_, what, executor);
  frontier_.insert(frontier_.end(), next_.begin(), next_.end());
  follow(what, executor);
}

/// Looks around every occupied cell, until all cells around occupied ones have been looked at.
void CellSearch::follow(const Comparison& what, const Executor& executor) {
  const Box bounds = boundsOf(found_.size());
  while (!frontier_.empty()) {
    next_.clear();
    for (const Point& cell : frontier_) {
      if (isOccupied_.at(cell.x, cell.y) == 0) continue;
      for (int y = cell.y - 1; y <= cell.y + 1; ++y)
        for (int x = cell.x - 1; x <= cell.x + 1; ++x)
          if (bounds.contains({x, y}) && isLooked_.at(x, y) == 0) note(x, y, next_);
    }
    lookAtCells(next_, what, executor);
    std::swap(frontier_, next_);
  }
}

void CellSearch::lookAtCells(std::span<const Point> cells, const Comparison& what,
                             const Executor& executor) {
  const auto tasks = static_cast<int>((cells.size() + kCellsInTask - 1) / kCellsInTask);
  executor.forEach(tasks, [&](int task) {
    const size_t first = static_cast<size_t>(task) * kCellsInTask;
    for (const Point& cell :
         cells.subspan(first, std::min<size_t>(kCellsInTask, cells.size() - first)))
      look(runOf(cell.y, cell.x, cell.x + 1), what);
  });
}

void CellSearch::note(int x, int y, std::vector<Point>& cells) {
  isLooked_.at(x, y) = 1;
  cells.push_back({x, y});
  ++looked_;
}

void CellSearch::findParts() {
  findComponents(isOccupied_, 255, Connectivity::Eight, parts_);
  hasSeed_.assign(parts_.list.size(), 0);
  for (const ComponentRun& run : parts_.runs) {
    const uint8_t* seeds = isSeed_.row(run.y);
    if (std::any_of(seeds + run.begin, seeds + run.end, [](uint8_t seed) { return seed != 0; }))
      hasSeed_[run.component] = 1;
  }
}

}  // namespace rg::background
