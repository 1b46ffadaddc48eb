// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/graph/arc_table.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

namespace rg::graph {
namespace {

using segmentation::RegionLabel;

constexpr size_t kFirstCapacity = 1024;  // A power of two, as every capacity.

/// Never 0.
uint32_t keyOf(RegionLabel a, RegionLabel b) {
  return uint32_t{a.number()} << 16 | b.number();
}

}  // namespace

void ArcTable::clear() {
  if (keys_.empty()) {
    keys_.resize(kFirstCapacity);
    arcs_.resize(kFirstCapacity);
  }
  std::fill(keys_.begin(), keys_.end(), 0u);
  used_ = 0;
}

void ArcTable::add(RegionLabel a, RegionLabel b, uint32_t borderPx, uint32_t contrast) {
  if (a > b) std::swap(a, b);
  const uint32_t key = keyOf(a, b);
  size_t slot = slotOf(key);
  if (keys_[slot] == 0) {
    if (2 * (used_ + 1) > keys_.size()) {
      grow();
      slot = slotOf(key);
    }
    keys_[slot] = key;
    arcs_[slot] = {a, b, 0, 0};
    ++used_;
  }
  arcs_[slot].borderPx += borderPx;
  arcs_[slot].contrast += contrast;
}

// Neighbours have near numbers where there are many regions, and rows follow one another: so what
// is looked up next lies near what was.
size_t ArcTable::slotOf(uint32_t key) const {
  const size_t mask = keys_.size() - 1;
  size_t slot = (5 * (key >> 16) + 3 * (key & 0xFFFF)) & mask;
  while (keys_[slot] != 0 && keys_[slot] != key) slot = (slot + 1) & mask;
  return slot;
}

void ArcTable::grow() {
  std::vector<Arc> arcs;
  appendTo(arcs);
  keys_.assign(2 * keys_.size(), 0u);
  arcs_.resize(keys_.size());
  for (const Arc& arc : arcs) {
    const uint32_t key = keyOf(arc.a, arc.b);
    const size_t slot = slotOf(key);
    keys_[slot] = key;
    arcs_[slot] = arc;
  }
}

void ArcTable::appendTo(std::vector<Arc>& arcs) const {
  for (size_t slot = 0; slot < keys_.size(); ++slot)
    if (keys_[slot] != 0) arcs.push_back(arcs_[slot]);
}

void ArcSorter::sortAndJoin(std::vector<Arc>& arcs, uint32_t labelCount) {
  starts_.assign(size_t{labelCount} + 1, 0);
  for (const Arc& arc : arcs) ++starts_[arc.a.index() + 1];
  std::partial_sum(starts_.begin(), starts_.end(), starts_.begin());
  sorted_.resize(arcs.size());
  for (const Arc& arc : arcs) sorted_[starts_[arc.a.index()]++] = arc;
  arcs.clear();
  for (auto first = sorted_.begin(); first != sorted_.end();) {
    const auto last =
        std::find_if(first, sorted_.end(), [&](const Arc& arc) { return arc.a != first->a; });
    std::sort(first, last, [](const Arc& p, const Arc& q) { return p.b < q.b; });
    for (; first != last; ++first) {
      if (!arcs.empty() && arcs.back().a == first->a && arcs.back().b == first->b) {
        arcs.back().borderPx += first->borderPx;
        arcs.back().contrast += first->contrast;
      } else {
        arcs.push_back(*first);
      }
    }
  }
}

}  // namespace rg::graph
