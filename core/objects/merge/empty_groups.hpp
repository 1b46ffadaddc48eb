// SPDX-License-Identifier: LGPL-2.1-or-later
// The smallest group that no node is in, while nodes change groups
// (core/objects/merge/mrf_merge.hpp).
//
// Cost: all together what the groups and O(log) of each that was emptied take, whatever the order.
#pragma once

#include <algorithm>
#include <cstdint>
#include <functional>
#include <vector>

namespace rg::objects {

class EmptyGroups {
 public:
  /// sizes: nodes of each group, which the caller keeps up to date. emptied: scratch.
  EmptyGroups(const std::vector<uint32_t>& sizes, std::vector<uint32_t>& emptied)
      : sizes_(sizes), emptied_(emptied) {
    emptied_.clear();
  }

  /// Has to be told of every group that gets empty.
  void add(uint32_t group) {
    if (group >= next_) return;
    emptied_.push_back(group);
    std::push_heap(emptied_.begin(), emptied_.end(), std::greater<>());
  }

  /// The number of groups where none is empty.
  [[nodiscard]] uint32_t first() {
    while (!emptied_.empty() && sizes_[emptied_.front()] != 0) {
      std::pop_heap(emptied_.begin(), emptied_.end(), std::greater<>());
      emptied_.pop_back();
    }
    if (!emptied_.empty()) return emptied_.front();
    while (next_ < sizes_.size() && sizes_[next_] != 0) ++next_;
    return next_;
  }

 private:
  const std::vector<uint32_t>& sizes_;
  std::vector<uint32_t>& emptied_;  ///< A heap; all below next_.
  uint32_t next_ = 0;               ///< Empty groups below it are in `emptied_`.
};

}  // namespace rg::objects
