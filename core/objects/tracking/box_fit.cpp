// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/tracking/box_fit.hpp"

#include <algorithm>
#include <tuple>

namespace rg::objects {
namespace {

constexpr int kRounds = 3;

/// Adds `change` to the claims of the cells inside the box.
void claim(const GroupGrid& e, const Box& box, int change, std::vector<uint16_t>& claims) {
  const Box inside = intersect(box, boundsOf(e.grid));
  for (int y = inside.y; y < inside.bottom(); ++y) {
    uint16_t* row = claims.data() + e.at(inside.x, y);
    for (int x = 0; x < inside.width; ++x) row[x] = static_cast<uint16_t>(row[x] + change);
  }
}

/// What the prediction of the regions says of a cell.
int trustOf(const GroupGrid& e, const FitTask& task, size_t cell, int bonus) {
  if (e.expected[cell] == 0 || task.track == 0) return 0;
  return e.expected[cell] == task.track ? bonus : -bonus;
}

/// Sums of what the cells of `window` are worth to a task: at(x, y) covers all above and left.
class ValueSums {
 public:
  ValueSums(const GroupGrid& e, const FitTask& task, const Box& window, FitScratch& s,
            const Numbers::Fit& n)
      : window_(window),
        stride_(window.width + 1),
        foreground_(static_cast<int>(n.foreground.whole())),
        background_(static_cast<int>(n.background.whole())),
        expected_(static_cast<int>(n.expected.whole())),
        sums_(s.sums) {
    sums_.resize(static_cast<size_t>(stride_) * static_cast<size_t>(window.height + 1));
    std::fill_n(sums_.begin(), stride_, 0);
    const Box inside = intersect(window, boundsOf(e.grid));
    for (int y = window.y; y < window.bottom(); ++y) {
      const int32_t* above = sums_.data() + (y - window.y) * stride_;
      int32_t* to = sums_.data() + (y - window.y + 1) * stride_;
      if (y < inside.y || y >= inside.bottom()) {
        std::copy_n(above, stride_, to);
        continue;
      }
      const int first = inside.x - window.x, last = inside.right() - window.x;
      const size_t cell = e.at(inside.x, y);
      int32_t sum = 0;
      std::copy_n(above, first + 1, to);
      for (int x = first; x < last; ++x) {
        sum += value(e, task, cell + static_cast<size_t>(x - first), s.claims);
        to[x + 1] = above[x + 1] + sum;
      }
      for (int x = last; x < window.width; ++x) to[x + 1] = above[x + 1] + sum;
    }
  }
  [[nodiscard]] int32_t inside(const Box& box) const {
    const int left = box.x - window_.x, top = box.y - window_.y;
    return get(left + box.width, top + box.height) - get(left, top + box.height) -
           get(left + box.width, top) + get(left, top);
  }

 private:
  [[nodiscard]] int value(const GroupGrid& e, const FitTask& task, size_t cell,
                          const std::vector<uint16_t>& claims) const {
    if (e.group[cell] == 0) return -background_;
    return claims[cell] > 0
               ? 0
               : foreground_ + task.bonus[e.bin[cell]] + trustOf(e, task, cell, expected_);
  }
  [[nodiscard]] int32_t get(int x, int y) const {
    return sums_[static_cast<size_t>(y * stride_ + x)];
  }
  Box window_;
  int stride_;
  int foreground_, background_, expected_;
  std::vector<int32_t>& sums_;
};

/// All that a task may cover.
Box windowOf(const FitTask& task) {
  const Box& box = task.expected;
  return {box.x - task.reachX, box.y - task.reachY, box.width + 2 * task.reachX,
          box.height + 2 * task.reachY};
}

Box bestPlace(const GroupGrid& e, const FitTask& task, FitScratch& s, const Numbers::Fit& n) {
  const Box& box = task.expected;
  const ValueSums sums(e, task, windowOf(task), s, n);
  const auto margin = static_cast<int>(n.core.of(box.width));
  const int64_t foreground = n.foreground.whole(), lift = n.lift.whole();
  Box best = box;
  std::tuple<int64_t, int, int, int> bestKey{INT64_MAX, 0, 0, 0};
  for (int dy = -task.reachY; dy <= task.reachY; ++dy)
    for (int dx = -task.reachX; dx <= task.reachX; ++dx) {
      const Box place{box.x + dx, box.y + dy, box.width, box.height};
      const Box core{place.x + margin, place.y, place.width - 2 * margin, place.height};
      const int64_t gain = int64_t{sums.inside(place)} + sums.inside(core);
      if (gain < -std::get<0>(bestKey)) continue;
      // A shift by half the width costs a quarter of what a full box gains.
      const int64_t far = foreground *
                          (int64_t{dx} * dx * box.height * box.height +
                           int64_t{dy} * dy * box.width * box.width * lift) /
                          std::max<int64_t>(box.area(), 1);
      const std::tuple key{far - gain, dx * dx + dy * dy, dy, dx};
      if (key < bestKey) {
        bestKey = key;
        best = place;
      }
    }
  return best;
}

void takeTurn(const GroupGrid& e, std::span<FitTask> tier, size_t index, FitScratch& s,
              const Numbers::Fit& n) {
  FitTask& task = tier[index];
  const Box before = task.fitted;
  claim(e, before, -1, s.claims);
  task.fitted = bestPlace(e, task, s, n);
  claim(e, task.fitted, 1, s.claims);
  s.isSettled[index] = 1;
  if (task.fitted == before) return;
  for (size_t i = 0; i < tier.size(); ++i) {
    const Box window = windowOf(tier[i]);
    const bool isNear =
        !intersect(window, before).isEmpty() || !intersect(window, task.fitted).isEmpty();
    if (i != index && isNear) s.isSettled[i] = 0;
  }
}

}  // namespace

void fitBoxes(const GroupGrid& e, std::span<FitTask> tasks, FitScratch& s,
              const Numbers::Fit& numbers) {
  s.claims.assign(e.group.size(), 0);
  for (size_t first = 0, last = 0; first < tasks.size(); first = last) {
    while (last < tasks.size() && tasks[last].tier == tasks[first].tier) ++last;
    const auto tier = tasks.subspan(first, last - first);
    for (FitTask& task : tier) {
      task.fitted = task.expected;
      claim(e, task.fitted, 1, s.claims);
    }
    s.isSettled.assign(tier.size(), 0);
    for (int round = 0; round < kRounds; ++round)
      for (size_t i = 0; i < tier.size(); ++i)
        if (s.isSettled[i] == 0) takeTurn(e, tier, i, s, numbers);
  }
}

void assignCells(const GroupGrid& e, std::span<const FitTask> tasks, std::vector<uint16_t>& owner,
                 const Numbers::Fit& numbers) {
  const auto expected = static_cast<int>(numbers.expected.whole());
  owner.assign(e.group.size(), 0);
  for (size_t i = 0; i < tasks.size(); ++i) {
    const FitTask& task = tasks[i];
    const Box box = intersect(task.fitted, boundsOf(e.grid));
    for (int y = box.y; y < box.bottom(); ++y)
      for (int x = box.x; x < box.right(); ++x) {
        const size_t cell = e.at(x, y);
        if (e.group[cell] == 0) continue;
        uint16_t& mine = owner[cell];
        if (mine != 0) {
          const FitTask& other = tasks[mine - 1u];
          const auto claimOf = [&](const FitTask& t) {
            return std::tuple(trustOf(e, t, cell, expected), -t.tier, int{t.bonus[e.bin[cell]]});
          };
          if (claimOf(other) >= claimOf(task)) continue;
        }
        mine = static_cast<uint16_t>(i + 1);
      }
  }
}

}  // namespace rg::objects
