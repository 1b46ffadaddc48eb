// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/segmentation/absorption.hpp"

#include "core/base/forest.hpp"

#include <algorithm>
#include <numeric>

namespace rg::segmentation {
namespace {

constexpr uint64_t kNoChoice = ~uint64_t{0};
constexpr uint32_t kUnseen = ~uint32_t{0};
}  // namespace

void Absorption::run(const AbsorptionLimits& limits) {
  forest_.resize(regions_.size());
  std::iota(forest_.begin(), forest_.end(), 0u);
  numbers_ = forest_;
  means_.resize(regions_.size());
  for (uint32_t i = 0; i < regions_.size(); ++i) {
    regions_[i].representative = i;
    means_[i] = meanOf(regions_[i]);
  }
  joinBorders();

  for (uint32_t area = limits.grainPx * limits.grainPx; area < limits.minAreaPx;) {
    area = std::min(area * limits.growth, limits.minAreaPx);
    do chooseAllBelow(area);
    while (mergeRound() > 0);
  }
  if (limits.minAreaPx > 1) {
    do chooseThin(limits.grainPx);
    while (mergeRound() > 0);
  }
  while (regions_.size() > limits.maxRegions) {
    chooseSmallest(static_cast<uint32_t>(regions_.size()) - limits.maxRegions);
    if (mergeRound() == 0) break;
  }
}

uint32_t Absorption::representative(uint32_t i) {
  return rootOf(forest_, i);
}

void Absorption::chooseAllBelow(uint32_t areaPx) {
  chooses_.resize(regions_.size());
  for (size_t i = 0; i < regions_.size(); ++i) chooses_[i] = regions_[i].areaPx < areaPx;
}

void Absorption::chooseThin(uint32_t grainPx) {
  perimeters_.assign(regions_.size(), 0);
  for (const AbsorbedBorder& border : borders_) {
    perimeters_[border.a] += border.borderPx;
    perimeters_[border.b] += border.borderPx;
  }
  chooses_.resize(regions_.size());
  for (size_t i = 0; i < regions_.size(); ++i)
    chooses_[i] = isThin(regions_[i].areaPx, perimeters_[i], grainPx);
}

// Of regions with a neighbour only: the others can't merge and would use up the count.
void Absorption::chooseSmallest(uint32_t count) {
  chooses_.assign(regions_.size(), 0);
  for (const AbsorbedBorder& border : borders_) chooses_[border.a] = chooses_[border.b] = 1;
  order_.clear();
  for (uint32_t i = 0; i < regions_.size(); ++i)
    if (chooses_[i] != 0) order_.push_back(uint64_t{regions_[i].areaPx} << 32 | i);
  if (order_.size() <= count) return;
  std::nth_element(order_.begin(), order_.begin() + count, order_.end());
  for (size_t i = count; i < order_.size(); ++i) chooses_[static_cast<uint32_t>(order_[i])] = 0;
}

/// Returns how many regions vanished.
uint64_t Absorption::mergeRound() {
  const size_t before = regions_.size();
  if (std::find(chooses_.begin(), chooses_.end(), 1) == chooses_.end()) return 0;
  findBest();
  if (std::all_of(best_.begin(), best_.end(), [](uint64_t key) { return key == kNoChoice; }))
    return 0;
  contract();
  numberKept();
  joinBorders();
  return before - regions_.size();
}

void Absorption::findBest() {
  best_.assign(regions_.size(), kNoChoice);
  for (const AbsorbedBorder& border : borders_) {
    const bool asks = chooses_[border.a] != 0, answers = chooses_[border.b] != 0;
    if (!asks && !answers) continue;
    const uint64_t key =
        uint64_t{distanceAcross(means_[border.a], means_[border.b], border.borderPx)} << 32;
    if (asks) best_[border.a] = std::min(best_[border.a], key | border.b);
    if (answers) best_[border.b] = std::min(best_[border.b], key | border.a);
  }
}

// The choices form trees, but for pairs that chose each other: there the smaller number is the
// root. Longer cycles can't be, since distances are symmetric and ties go to the smaller number.
void Absorption::contract() {
  const auto count = static_cast<uint32_t>(regions_.size());
  parents_.resize(count);
  hasGrown_.assign(count, 0);
  const auto chosen = [&](uint32_t i) {
    return best_[i] == kNoChoice ? i : static_cast<uint32_t>(best_[i]);
  };
  for (uint32_t i = 0; i < count; ++i) {
    const uint32_t to = chosen(i);
    parents_[i] = chosen(to) == i && i < to ? i : to;
  }
  for (uint32_t i = 0; i < count; ++i) {
    const uint32_t r = rootOf(parents_, i);
    if (r == i) continue;
    regions_[r].red += regions_[i].red;
    regions_[r].green += regions_[i].green;
    regions_[r].blue += regions_[i].blue;
    regions_[r].areaPx += regions_[i].areaPx;
    hasGrown_[r] = 1;
    forest_[regions_[i].representative] = regions_[r].representative;
  }
}

/// Numbers the roots in their order, moves them together and gives every region its root's number.
void Absorption::numberKept() {
  const auto count = static_cast<uint32_t>(regions_.size());
  numbers_.resize(count);
  uint32_t kept = 0;
  for (uint32_t i = 0; i < count; ++i) {
    if (parents_[i] != i) continue;
    if (kept != i) regions_[kept] = regions_[i];
    means_[kept] = hasGrown_[i] != 0 ? meanOf(regions_[kept]) : means_[i];
    numbers_[i] = kept++;
  }
  for (uint32_t i = 0; i < count; ++i) {
    uint32_t root = i;
    while (parents_[root] != root) root = parents_[root];
    numbers_[i] = numbers_[root];
  }
  regions_.resize(kept);
}

// Sorts by the smaller number with one count, then joins equal pairs by remembering where the
// larger number was last seen. What is dropped or joined is hard to foretell: it is written and not
// counted.
void Absorption::joinBorders() {
  starts_.assign(regions_.size() + 1, 0);
  size_t open = 0;
  for (const AbsorbedBorder& border : borders_) {
    const uint32_t a = numbers_[border.a], b = numbers_[border.b];
    const uint32_t first = std::min(a, b);
    borders_[open] = {first, std::max(a, b), border.borderPx};
    starts_[first + 1] += a != b;
    open += a != b;
  }
  std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
  sorted_.resize(open);
  for (size_t i = 0; i < open; ++i) sorted_[starts_[borders_[i].a]++] = borders_[i];

  seenAt_.assign(regions_.size(), 0);  // One more than the place.
  borders_.resize(std::max(borders_.size(), open + 1));
  size_t kept = 0, firstOfA = 0;
  uint32_t a = kUnseen;
  for (const AbsorbedBorder& border : sorted_) {
    if (border.a != a) {
      a = border.a;
      firstOfA = kept;
    }
    const size_t seen = seenAt_[border.b];
    const bool isNew = seen <= firstOfA;
    const size_t at = isNew ? kept : seen - 1;
    const uint32_t joinedPx = isNew ? 0 : borders_[at].borderPx;
    borders_[at] = {border.a, border.b, joinedPx + border.borderPx};
    seenAt_[border.b] = static_cast<uint32_t>(at + 1);
    kept += isNew;
  }
  borders_.resize(kept);
}

}  // namespace rg::segmentation
