// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/detection/grouping.hpp"

#include "core/base/pixel.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

namespace rg::detection {
namespace {

constexpr int kNearness = 5;  ///< A fifth.

bool areNear(const Box& a, const Box& b) {
  const int side = std::min(a.width, b.width) + std::min(a.height, b.height);
  const auto isNear = [&](int p, int q) { return 2 * kNearness * absDiff(p, q) <= side; };
  return isNear(a.x, b.x) && isNear(a.y, b.y) && isNear(a.right(), b.right()) &&
         isNear(a.bottom(), b.bottom());
}

bool isInside(const Detection& small, const Detection& large) {
  const Box &a = small.box, &b = large.box;
  const int dx = b.width / kNearness, dy = b.height / kNearness;
  return a.x >= b.x - dx && a.y >= b.y - dy && a.right() <= b.right() + dx &&
         a.bottom() <= b.bottom() + dy;
}

bool before(const Detection& a, const Detection& b) {
  return std::tie(a.box.y, a.box.x, a.box.height, a.box.width, a.windows) <
         std::tie(b.box.y, b.box.x, b.box.height, b.box.width, b.windows);
}

class Groups {
 public:
  explicit Groups(std::span<const Box> windows) : windows_(windows), parents_(windows.size()) {
    std::iota(parents_.begin(), parents_.end(), 0U);
    std::vector<uint32_t> order(parents_);
    std::sort(order.begin(), order.end(),
              [&](uint32_t a, uint32_t b) { return windows[a].y < windows[b].y; });
    for (size_t i = 0; i < order.size(); ++i) uniteBelow(order, i);
  }

  /// Sums of the windows' sides.
  std::vector<Detection> means() {
    struct Sum {
      int64_t left = 0, top = 0, right = 0, bottom = 0;
      int windows = 0;
    };
    std::vector<Sum> sums(windows_.size());
    for (uint32_t i = 0; i < windows_.size(); ++i) {
      Sum& sum = sums[rootOf(i)];
      const Box& box = windows_[i];
      sum.left += box.x;
      sum.top += box.y;
      sum.right += box.right();
      sum.bottom += box.bottom();
      ++sum.windows;
    }
    std::vector<Detection> groups;
    for (const Sum& sum : sums) {
      if (sum.windows == 0) continue;
      const auto mean = [&](int64_t of) {
        return static_cast<int>(divideRounded(of, sum.windows));
      };
      const int x = mean(sum.left), y = mean(sum.top);
      groups.push_back({{x, y, mean(sum.right) - x, mean(sum.bottom) - y}, sum.windows});
    }
    return groups;
  }

 private:
  uint32_t rootOf(uint32_t i) {
    while (parents_[i] != i) i = parents_[i] = parents_[parents_[i]];
    return i;
  }
  /// Windows further down than a fifth of this one's sides are near to none of its size.
  void uniteBelow(const std::vector<uint32_t>& order, size_t i) {
    const Box& box = windows_[order[i]];
    const int lowest = box.y + (box.width + box.height) / (2 * kNearness);
    for (size_t j = i + 1; j < order.size() && windows_[order[j]].y <= lowest; ++j) {
      if (!areNear(box, windows_[order[j]])) continue;
      const uint32_t a = rootOf(order[i]), b = rootOf(order[j]);
      parents_[std::max(a, b)] = std::min(a, b);
    }
  }

  std::span<const Box> windows_;
  std::vector<uint32_t> parents_;
};

}  // namespace

void groupWindows(std::span<const Box> windows, int least, std::vector<Detection>& groups) {
  groups.clear();
  if (least <= 0) {
    for (const Box& window : windows) groups.push_back({window, 1});
  } else {
    auto all = Groups(windows.first(std::min(windows.size(), kMostGrouped))).means();
    std::erase_if(all, [&](const Detection& group) { return group.windows < least; });
    for (const Detection& group : all) {
      const bool isPart = std::any_of(all.begin(), all.end(), [&](const Detection& other) {
        return other.windows > group.windows && isInside(group, other);
      });
      if (!isPart) groups.push_back(group);
    }
  }
  std::sort(groups.begin(), groups.end(), before);
}

}  // namespace rg::detection
