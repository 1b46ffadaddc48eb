// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/tracking/assignment.hpp"

#include <limits>

namespace rg::objects {
namespace {

constexpr int64_t kFar = std::numeric_limits<int64_t>::max() / 4;

size_t at(int i) {
  return static_cast<size_t>(i);
}

}  // namespace

// Shortest augmenting paths with prices (Jonker and Volgenant). Each row has a column of its own at
// the end, which means "left out"; so a full assignment always exists.
void Assignment::solve(std::span<const int64_t> costs, int rows, int columns, int64_t leaveOut) {
  const int all = columns + rows;
  columnOf_.assign(at(rows), -1);
  rowOf_.assign(at(all), -1);
  rowPrice_.assign(at(rows), 0);
  columnPrice_.assign(at(all), 0);
  for (int row = 0; row < rows; ++row) augment(costs, row, columns, leaveOut);
  for (int column = 0; column < columns; ++column)
    if (rowOf_[at(column)] >= 0) columnOf_[at(rowOf_[at(column)])] = column;
}

void Assignment::augment(std::span<const int64_t> costs, int row, int columns, int64_t leaveOut) {
  const int all = static_cast<int>(rowOf_.size());
  slack_.assign(at(all), kFar);
  previous_.assign(at(all), -1);
  isDone_.assign(at(all), 0);
  int64_t distance = 0;
  int last = -1;  // The column by which the tree grew; the path starts at `row` itself.
  for (int current = row; current >= 0; current = rowOf_[at(last)]) {
    int nearest = -1;
    for (int column = 0; column < all; ++column) {
      if (isDone_[at(column)]) continue;
      const bool isOwn = column == columns + current;
      if (column < columns || isOwn) {
        const int64_t cost = isOwn ? leaveOut : costs[at(current * columns + column)];
        const int64_t reduced = distance + cost - rowPrice_[at(current)] - columnPrice_[at(column)];
        if (reduced < slack_[at(column)]) {
          slack_[at(column)] = reduced;
          previous_[at(column)] = last;
        }
      }
      if (nearest < 0 || slack_[at(column)] < slack_[at(nearest)]) nearest = column;
    }
    last = nearest;
    distance = slack_[at(last)];
    isDone_[at(last)] = 1;
  }
  rowPrice_[at(row)] += distance;
  for (int column = 0; column < all; ++column) {
    if (!isDone_[at(column)] || column == last) continue;
    rowPrice_[at(rowOf_[at(column)])] += distance - slack_[at(column)];
    columnPrice_[at(column)] -= distance - slack_[at(column)];
  }
  for (int column = last; column >= 0;) {
    const int before = previous_[at(column)];
    rowOf_[at(column)] = before >= 0 ? rowOf_[at(before)] : row;
    column = before;
  }
}

}  // namespace rg::objects
