// SPDX-License-Identifier: LGPL-2.1-or-later
// The cheapest one-to-one assignment of rows to columns.
//
// Determinism: integers. Of several cheapest assignments one is chosen by the order of the rows
// and columns, which callers sort by explicit keys.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace rg::objects {

/// A pair that must not be made.
inline constexpr int64_t kForbidden = int64_t{1} << 40;

class Assignment {
 public:
  /// costs[row * columns + column], 0 … kForbidden. Afterwards columnOf(row) is the row's column,
  /// or −1 where leaving the row out is cheaper: that costs `leaveOut`. O(rows² columns).
  void solve(std::span<const int64_t> costs, int rows, int columns, int64_t leaveOut);
  [[nodiscard]] int columnOf(int row) const { return columnOf_[static_cast<size_t>(row)]; }

 private:
  void augment(std::span<const int64_t> costs, int row, int columns, int64_t leaveOut);
  std::vector<int> columnOf_;
  std::vector<int> rowOf_;  ///< Of each column, those for left out rows included; −1 = free.
  std::vector<int64_t> rowPrice_, columnPrice_, slack_;
  std::vector<int> previous_;
  std::vector<char> isDone_;
};

}  // namespace rg::objects
