// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/simd/detection/cascade_rows.hpp"

#include "core/simd/base/targets.hpp"

#include <algorithm>
#include <bit>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/simd/detection/cascade_rows.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace rg::detection::simd::HWY_NAMESPACE {
namespace {

#if HWY_TARGET == HWY_SCALAR

void judgeRow(const CascadeView& cascade, const WindowRow& row, uint16_t* stages) {
  for (int i = 0; i < row.count; ++i)
    stages[i] = judgeWindow(cascade, row.sums + i, row.squares + ptrdiff_t{i} * row.stepPx);
}

#else

namespace hn = hwy::HWY_NAMESPACE;
using Floats = hn::CappedTag<float, kMostLanes>;
using Ints = hn::RebindToSigned<Floats>;
using Words = hn::RebindToUnsigned<Floats>;
using Doubles = hn::Repartition<double, Floats>;
using HalfFloats = hn::Half<Floats>;
using F = hn::Vec<Floats>;

HWY_INLINE F weightedSums(const Lookup& lookup, int rect, const Corners*& rows,
                          const uint32_t* at) {
  const Words words;
  const Floats floats;
  const auto rowSum = [&](const Corners& corners) {
    const int32_t* c = corners.at;
    const auto left = hn::Sub(hn::LoadU(words, at + c[0]), hn::LoadU(words, at + c[2]));
    const auto right = hn::Sub(hn::LoadU(words, at + c[1]), hn::LoadU(words, at + c[3]));
    return hn::Sub(left, right);
  };
  auto sum = rowSum(*rows++);
  for (int32_t r = 1; r < lookup.rows[rect]; ++r) sum = hn::Add(sum, rowSum(*rows++));
  const auto unit = hn::Set(floats, 12582912.0F);  // As whole() does.
  const F scaled = hn::Mul(hn::ConvertTo(floats, hn::BitCast(Ints(), sum)),
                           hn::Set(floats, lookup.ratios[rect]));
  return hn::Mul(hn::Set(floats, lookup.weights[rect]), hn::Sub(hn::Add(scaled, unit), unit));
}

/// For each window, whether the feature's value is below the branch's threshold.
HWY_INLINE auto isLess(const CascadeView& cascade, int32_t node, const uint32_t* at, F factors) {
  const Lookup& lookup = cascade.lookups[node];
  const Corners* rows = cascade.rows + lookup.firstRow;
  F value = weightedSums(lookup, 0, rows, at);
  value = hn::Add(value, weightedSums(lookup, 1, rows, at));
  if (lookup.weights[2] != 0) value = hn::Add(value, weightedSums(lookup, 2, rows, at));
  return hn::Lt(hn::Mul(value, factors), hn::Set(Floats(), cascade.branches[node].threshold));
}

/// All windows go through all nodes; each takes what the nodes on its way say.
F leavesOfTree(const CascadeView& cascade, const Tree& tree, const uint32_t* at, F factors) {
  const Floats floats;
  const Ints ints;
  auto next = hn::Zero(ints);
  for (int32_t n = 0; n < tree.nodes; ++n) {
    const int32_t node = tree.firstNode + n;
    const auto isHere = hn::Eq(next, hn::Set(ints, n));
    if (hn::AllFalse(ints, isHere)) continue;
    const Branch& branch = cascade.branches[node];
    const auto less = hn::RebindMask(ints, isLess(cascade, node, at, factors));
    const auto led = hn::IfThenElse(less, hn::Set(ints, branch.less), hn::Set(ints, branch.other));
    next = hn::IfThenElse(isHere, led, next);
  }
  F leaf = hn::Zero(floats);
  for (int32_t k = 0; k <= tree.nodes; ++k) {
    const auto isIt = hn::RebindMask(floats, hn::Eq(next, hn::Set(ints, -1 - k)));
    leaf = hn::IfThenElse(isIt, hn::Set(floats, cascade.leaves[tree.firstLeaf + k]), leaf);
  }
  return leaf;
}

HWY_INLINE F leavesOf(const CascadeView& cascade, const Tree& tree, const uint32_t* at, F factors) {
  if (tree.nodes > 1) return leavesOfTree(cascade, tree, at, factors);
  const Floats floats;
  const Branch& branch = cascade.branches[tree.firstNode];
  const float* leaves = cascade.leaves + tree.firstLeaf - 1;
  return hn::IfThenElse(isLess(cascade, tree.firstNode, at, factors),
                        hn::Set(floats, leaves[-branch.less]),
                        hn::Set(floats, leaves[-branch.other]));
}

uint32_t bitsOf(hn::Mask<Doubles> mask) {
  uint8_t bits[8] = {};
  (void)hn::StoreMaskBits(Doubles(), mask, bits);
  return bits[0];
}

/// A bit for each window that passes the stage.
uint32_t passing(const CascadeView& cascade, const CascadeStage& stage, const uint32_t* at,
                 F factors) {
  const Doubles doubles;
  auto low = hn::Zero(doubles), high = hn::Zero(doubles);
  for (int32_t t = 0; t < stage.trees; ++t) {
    const F leaf = leavesOf(cascade, cascade.trees[stage.firstTree + t], at, factors);
    low = hn::Add(low, hn::PromoteTo(doubles, hn::LowerHalf(leaf)));
    high = hn::Add(high, hn::PromoteTo(doubles, hn::UpperHalf(HalfFloats(), leaf)));
  }
  const auto threshold = hn::Set(doubles, static_cast<double>(stage.threshold));
  return bitsOf(hn::Ge(low, threshold)) | bitsOf(hn::Ge(high, threshold)) << hn::Lanes(doubles);
}

/// `alive`: a bit for each window that goes on. All lanes take all steps, also when a single one is
/// left: its sums stand where theirs do, which is nearer than to look for them one by one.
void judgeLanes(const CascadeView& cascade, const uint32_t* sums, F factors, uint32_t alive,
                uint16_t* stages) {
  for (int32_t s = 0; s < cascade.stageCount && alive != 0; ++s) {
    const uint32_t passed = passing(cascade, cascade.stages[s], sums, factors) & alive;
    for (uint32_t gone = alive & ~passed; gone != 0; gone &= gone - 1)
      stages[std::countr_zero(gone)] = static_cast<uint16_t>(s);
    alive = passed;
  }
  for (; alive != 0; alive &= alive - 1)
    stages[std::countr_zero(alive)] = static_cast<uint16_t>(cascade.stageCount);
}

void judgeRow(const CascadeView& cascade, const WindowRow& row, uint16_t* stages) {
  const int lanes = static_cast<int>(hn::Lanes(Floats()));
  alignas(64) float factors[kMostLanes] = {};
  for (int x = 0; x < row.count; x += lanes) {
    const int count = std::min(lanes, row.count - x);
    const double* squares = row.squares + ptrdiff_t{x} * row.stepPx;
    uint32_t alive = 0;
    for (int i = 0; i < count; ++i) {
      factors[i] =
          contrastFactor(cascade.contrast, row.sums + x + i, squares + ptrdiff_t{i} * row.stepPx);
      stages[x + i] = kFlatWindow;
      alive |= (factors[i] != 0 ? 1U : 0U) << i;
    }
    judgeLanes(cascade, row.sums + x, hn::Load(Floats(), factors), alive, stages + x);
  }
}

#endif

}  // namespace
}  // namespace rg::detection::simd::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace rg::detection::simd {
namespace {
HWY_EXPORT(judgeRow);
}  // namespace

void judgeRow(const CascadeView& cascade, const WindowRow& row, uint16_t* stages) {
  HWY_DYNAMIC_DISPATCH(judgeRow)(cascade, row, stages);
}

}  // namespace rg::detection::simd
#endif
