// SPDX-License-Identifier: LGPL-2.1-or-later
// The loops over one row that core/graph/graph.cpp and core/motion/matched_blocks.cpp are
// made of, compiled for every instruction set.
// The same bits on every target.
#pragma once

#include <cstdint>

namespace rg::simd {

/// Where runs of equal labels begin in a row of `count` > 0 of them: the first is 0. Returns how
/// many there are; begins has place for count + 1 and gets `count` behind the last.
int findRuns(const uint16_t* labels, int count, uint16_t* begins);

/// Bit i of the words = a[i] == b[i]; the last word's other bits are 0.
void compareLabels(const uint16_t* a, const uint16_t* b, int count, uint64_t* words);

/// Sums of three rows of bytes over the same run.
struct ChannelSums {
  uint32_t sums[3] = {};
};
/// Over the runs begins[i] … begins[i + 1] − 1 for i = 0 … runs − 1, of rows that are read up to
/// begins[runs] only.
struct ChannelRows {
  const uint8_t* rows[3] = {};
};
void sumRuns(const ChannelRows& from, const uint16_t* begins, int runs, ChannelSums* to);

}  // namespace rg::simd
