// SPDX-License-Identifier: LGPL-2.1-or-later
// Counts the pixel pairs between regions (part of stage 3).
//
// Determinism: sums commute; ArcSorter brings the result into its one order.
#pragma once

#include "core/graph/graph.hpp"

#include <cstdint>
#include <vector>

namespace rg::graph {

/// Sums by pair of labels: a hash table with open addresses that grows with the number of arcs.
class ArcTable {
 public:
  void clear();
  /// borderPx pairs of two different labels, neither of them none; contrast: over all pairs.
  void add(segmentation::RegionLabel a, segmentation::RegionLabel b, uint32_t borderPx,
           uint32_t contrast);
  /// In no promised order.
  void appendTo(std::vector<Arc>& arcs) const;

 private:
  [[nodiscard]] size_t slotOf(uint32_t key) const;
  void grow();

  std::vector<uint32_t> keys_;  ///< a << 16 | b with a < b; 0 = free.
  std::vector<Arc> arcs_;       ///< The sums, by slot.
  size_t used_ = 0;
};

/// Sorts by (a, b) and joins equal pairs, in time that follows labels and arcs.
class ArcSorter {
 public:
  void sortAndJoin(std::vector<Arc>& arcs, uint32_t labelCount);

 private:
  std::vector<uint32_t> starts_;
  std::vector<Arc> sorted_;
};

}  // namespace rg::graph
