// SPDX-License-Identifier: LGPL-2.1-or-later
// One block's way through all rounds of absorption; for .cu files only.
#pragma once

#include "kernels/absorption.hpp"
#include "kernels/block_reduce.hpp"
#include "kernels/pair_sums.hpp"

#include <algorithm>

namespace rg::gpu::segmentation::one_block {

using rg::segmentation::AbsorbedBorder;
using rg::segmentation::AbsorbedRegion;
using rg::segmentation::AbsorptionLimits;

inline constexpr int kThreads = 512, kWarps = kThreads / kWarp, kDigits = 256;
inline constexpr unsigned long long kNoChoice = ~0ull;

struct Larger {
  template <class T>
  __device__ T operator()(T a, T b) const {
    return a > b ? a : b;
  }
};

/// Calls act(i) for all i < count, by the threads of the block, and waits for them.
template <class Act>
__device__ void forAll(uint32_t count, const Act& act) {
  for (uint32_t i = threadIdx.x; i < count; i += kThreads) act(i);
  __syncthreads();
}

template <class Array, class Test>
__device__ bool isAny(uint32_t count, Array& values, const Test& test) {
  uint32_t own = 0;
  for (uint32_t i = threadIdx.x; i < count; i += kThreads) own |= test(i) ? 1u : 0u;
  return reduceBlock<kWarps>(own, values, Larger{}) != 0;
}

/// Calls place(i, number, isChosen) for all, of which those that are chosen are numbered in their
/// order; place may write to what any of them that were asked together has read in `chosen`.
template <class Array, class Choice, class Place>
__device__ uint32_t numberChosen(uint32_t count, Array& sums, const Choice& chosen,
                                 const Place& place) {
  uint32_t numbered = 0;
  for (uint32_t first = 0; first < count; first += kThreads) {
    const uint32_t i = first + threadIdx.x;
    const auto found = chosen(i);
    uint32_t total = 0;
    const uint32_t before = sumBefore<kWarps>(found.isChosen ? 1u : 0u, sums, total);
    if (found.isChosen) place(i, numbered + before, found);
    numbered += total;
  }
  __syncthreads();
  return numbered;
}

/// The key of rank `rank`, which counts from 1, of those that keyOf(i) gives; none: kNoChoice.
template <class Array, class KeyOf>
__device__ unsigned long long keyOfRank(uint32_t count, uint32_t rank, Array& digits,
                                        const KeyOf& keyOf) {
  unsigned long long prefix = 0;
  for (int shift = 56; shift >= 0; shift -= 8) {
    forAll(kDigits, [&](uint32_t i) { digits[i] = 0; });
    forAll(count, [&](uint32_t i) {
      const unsigned long long key = keyOf(i);
      const bool isLikePrefix = shift == 56 || key >> (shift + 8) == prefix;
      if (key != kNoChoice && isLikePrefix) atomicAdd(&digits[key >> shift & 255], 1u);
    });
    uint32_t digit = 0;
    for (uint32_t inDigit = digits[0]; inDigit < rank; inDigit = digits[++digit]) rank -= inDigit;
    prefix = prefix << 8 | digit;
    __syncthreads();
  }
  return prefix;
}

__device__ inline unsigned long long sizeKey(const AbsorbedRegion& region, uint32_t tie) {
  return static_cast<unsigned long long>(region.areaPx) << 32 | tie;
}

__device__ inline void addSum(uint64_t& to, uint64_t value) {
  atomicAdd(reinterpret_cast<unsigned long long*>(&to), static_cast<unsigned long long>(value));
}

/// A block's way through the rounds. Counts are the same in all threads.
template <class Sums, class Digits>
struct Absorber {
  const AbsorptionView& view;
  Sums& sums;
  Digits& digits;
  uint32_t regions, borders;

  __device__ void begin() {
    forAll(regions, [&](uint32_t i) {
      view.forest[i] = view.numbers[i] = i;
      view.regions[i].representative = i;
      view.means[i] = meanOf(view.regions[i]);
    });
    joinBorders();
  }

  /// What core does in three loops: here they are one, so that a round's code is there once.
  __device__ void run(const AbsorptionLimits& limits) {
    enum class Stage : uint8_t { Small, Thin, TooMany };
    Stage stage = Stage::Small;
    uint32_t area = limits.grainPx * limits.grainPx;
    for (bool hasMerged = false;; hasMerged = mergeRound()) {
      if (!hasMerged) {
        if (stage == Stage::Small && area < limits.minAreaPx)
          area = std::min(area * limits.growth, +limits.minAreaPx);
        else if (stage == Stage::TooMany)
          return;
        else
          stage = stage == Stage::Small && limits.minAreaPx > 1 ? Stage::Thin : Stage::TooMany;
      }
      if (stage == Stage::TooMany && regions <= limits.maxRegions) return;
      if (stage == Stage::Small) chooseBelow(area);
      if (stage == Stage::Thin) chooseThin(limits.grainPx);
      if (stage == Stage::TooMany) chooseSmallest(regions - limits.maxRegions);
    }
  }

 private:
  __device__ void chooseBelow(uint32_t areaPx) {
    forAll(regions, [&](uint32_t i) { view.chooses[i] = view.regions[i].areaPx < areaPx; });
  }

  __device__ void chooseThin(uint32_t grainPx) {
    forAll(regions, [&](uint32_t i) { view.perimeters[i] = 0; });
    forAll(borders, [&](uint32_t i) {
      const AbsorbedBorder& border = view.borders.list[i];
      atomicAdd(view.perimeters + border.a, border.borderPx);
      atomicAdd(view.perimeters + border.b, border.borderPx);
    });
    forAll(regions, [&](uint32_t i) {
      view.chooses[i] =
          rg::segmentation::isThin(view.regions[i].areaPx, view.perimeters[i], grainPx);
    });
  }

  __device__ void chooseSmallest(uint32_t count) {
    forAll(regions, [&](uint32_t i) { view.perimeters[i] = 0; });
    forAll(borders, [&](uint32_t i) {
      const AbsorbedBorder& border = view.borders.list[i];
      view.perimeters[border.a] = view.perimeters[border.b] = 1;
    });
    uint32_t own = 0;
    for (uint32_t i = threadIdx.x; i < regions; i += kThreads) own += view.perimeters[i];
    const uint32_t candidates =
        reduceBlock<kWarps>(own, sums, [](uint32_t a, uint32_t b) { return a + b; });
    const auto keyOf = [&](uint32_t i) {
      return view.perimeters[i] == 0 ? kNoChoice : sizeKey(view.regions[i], i);
    };
    const unsigned long long last =
        candidates <= count ? kNoChoice - 1 : keyOfRank(regions, count, digits, keyOf);
    forAll(regions, [&](uint32_t i) { view.chooses[i] = keyOf(i) <= last; });
  }

  /// Whether regions vanished.
  __device__ bool mergeRound() {
    if (!isAny(regions, sums, [&](uint32_t i) { return view.chooses[i] != 0; })) return false;
    findBest();
    if (!isAny(regions, sums, [&](uint32_t i) { return view.best[i] != kNoChoice; })) return false;
    findRoots();
    mergeIntoRoots();
    numberKept();
    joinBorders();
    return true;
  }

  __device__ void findBest() {
    forAll(regions, [&](uint32_t i) { view.best[i] = kNoChoice; });
    forAll(borders, [&](uint32_t i) {
      const AbsorbedBorder& border = view.borders.list[i];
      const bool asks = view.chooses[border.a] != 0, answers = view.chooses[border.b] != 0;
      if (!asks && !answers) return;
      const unsigned long long key =
          static_cast<unsigned long long>(rg::segmentation::distanceAcross(
              view.means[border.a], view.means[border.b], border.borderPx))
          << 32;
      if (asks) atomicMin(view.best + border.a, key | border.b);
      if (answers) atomicMin(view.best + border.b, key | border.a);
    });
  }

  __device__ uint32_t chosenBy(uint32_t i) const {
    return view.best[i] == kNoChoice ? i : static_cast<uint32_t>(view.best[i]);
  }
  /// Choices form trees, but for pairs that chose each other: see rg::segmentation::Absorption.
  __device__ uint32_t parentOf(uint32_t i) const {
    const uint32_t to = chosenBy(i);
    return chosenBy(to) == i && i < to ? i : to;
  }
  __device__ void findRoots() {
    forAll(regions, [&](uint32_t i) {
      uint32_t root = i;
      for (uint32_t next = parentOf(root); next != root; next = parentOf(root)) root = next;
      view.roots[i] = root;
    });
  }

  __device__ void mergeIntoRoots() {
    forAll(regions, [&](uint32_t i) {
      const uint32_t root = view.roots[i];
      if (root == i) return;
      const AbsorbedRegion& from = view.regions[i];
      AbsorbedRegion& to = view.regions[root];
      addSum(to.red, from.red);
      addSum(to.green, from.green);
      addSum(to.blue, from.blue);
      atomicAdd(&to.areaPx, from.areaPx);
      view.forest[from.representative] = to.representative;
    });
  }

  /// Roots move together in their order; none goes where one that was not read yet stands.
  __device__ void numberKept() {
    struct Kept {
      AbsorbedRegion region;
      bool isChosen;
    };
    const uint32_t before = regions;
    regions = numberChosen(
        before, sums,
        [&](uint32_t i) {
          const bool isRoot = i < before && view.roots[i] == i;
          return isRoot ? Kept{view.regions[i], true} : Kept{{}, false};
        },
        [&](uint32_t i, uint32_t number, const Kept& kept) {
          view.regions[number] = kept.region;
          view.means[number] = meanOf(kept.region);
          view.perimeters[i] = number;
        });
    forAll(before, [&](uint32_t i) { view.numbers[i] = view.perimeters[view.roots[i]]; });
  }

  /// Borders get their regions' new numbers; of equal pairs one is left, those within go.
  __device__ void joinBorders() {
    const uint32_t slots = slotsFor(borders);
    forAll(slots, [&](uint32_t i) { clearSlot(view.pairs, i); });
    forAll(borders, [&](uint32_t i) {
      const AbsorbedBorder& border = view.borders.list[i];
      const uint32_t a = view.numbers[border.a], b = view.numbers[border.b];
      if (a != b) addPair(view.pairs, slots, pairKey(a, b), border.borderPx);
    });
    struct Found {
      unsigned long long key;
      bool isChosen;
    };
    borders = numberChosen(
        slots, sums,
        [&](uint32_t i) {
          const unsigned long long key = i < slots ? view.pairs.keys[i] : 0;
          return Found{key, key != 0};
        },
        [&](uint32_t i, uint32_t number, const Found& found) {
          view.borders.list[number] = {static_cast<uint32_t>(found.key >> 32),
                                       static_cast<uint32_t>(found.key), view.pairs.sums[i]};
        });
  }
};

template <class Sums, class Digits>
__device__ uint32_t absorbAll(const AbsorptionLimits& limits, const AbsorptionView& view,
                              Sums& sums, Digits& digits) {
  Absorber<Sums, Digits> absorber{view, sums, digits, *view.count, *view.borders.count};
  absorber.begin();
  absorber.run(limits);
  if (threadIdx.x == 0) *view.left = absorber.regions;
  return absorber.regions;
}

/// A launch of the block; the model takes it that rounds halve the number of the components.
inline Launch launchOf(const char* name, double components) {
  return {name, {1, 1, 1}, {kThreads, 1, 1}, {400 * components, 400 * components}};
}

}  // namespace rg::gpu::segmentation::one_block
