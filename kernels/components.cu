// SPDX-License-Identifier: LGPL-2.1-or-later
#include "kernels/components.hpp"
#include "kernels/forest.hpp"
#include "kernels/start.hpp"
#include "kernels/warp_runs.hpp"
#include "kernels/word_runs.hpp"

namespace rg::gpu {
namespace {

/// The mask, or what is not in it.
struct Wanted {
  BitView mask;
  bool value;
};

__device__ uint64_t bitsOf(const Wanted& wanted, Point at) {
  const uint64_t word = wanted.mask.words.at(at.x, at.y);
  return wanted.value ? word : ~word & columnsOf(wanted.mask.size.width, at.x);
}

/// The columns of a word where runs begin.
__device__ uint64_t beginsOf(const Wanted& wanted, Point at) {
  const uint64_t bits = bitsOf(wanted, at);
  const uint64_t before = at.x > 0 ? bitsOf(wanted, {at.x - 1, at.y}) >> (kWordColumns - 1) : 0;
  return bits & ~(bits << 1 | before);
}

__device__ int lowestBit(uint64_t bits) {
  return __ffsll(static_cast<long long>(bits)) - 1;
}

__global__ void countRuns(Wanted wanted, uint32_t* counts) {
  const WordOfThread word = wordOfThread(wanted.mask.words.size);
  if (word.isInside)
    counts[word.index] = static_cast<uint32_t>(__popcll(beginsOf(wanted, word.at)));
}

/// The first column from that of bit `first` on that is not wanted.
__device__ int endOf(const Wanted& wanted, Point at, int first) {
  uint64_t gaps = ~bitsOf(wanted, at) & ~uint64_t{0} << first;
  while (gaps == 0 && ++at.x < wanted.mask.words.width()) gaps = ~bitsOf(wanted, at);
  const int end = gaps == 0 ? wanted.mask.size.width : at.x * kWordColumns + lowestBit(gaps);
  return std::min(end, wanted.mask.size.width);
}

/// How many runs begin in the raster up to column x of row y.
__device__ uint32_t runsUpTo(const Wanted& wanted, const ComponentsView& found, int x, int y) {
  const Point at{x / kWordColumns, y};
  const uint64_t upTo = ~uint64_t{0} >> (kWordColumns - 1 - x % kWordColumns);
  return found.firstRun[y * wanted.mask.words.width() + at.x] +
         static_cast<uint32_t>(__popcll(beginsOf(wanted, at) & upTo));
}

/// The runs `first` to `last` - 1 of the row above that touch a run.
struct TouchedRuns {
  uint32_t first = 0, last = 0;
};
__device__ TouchedRuns runsAbove(const Wanted& wanted, int reach, const Run& run,
                                 const ComponentsView& found) {
  const int above = run.y - 1;
  if (above < 0) return {};
  const int left = std::max(0, run.begin - reach);
  const int right = std::min(wanted.mask.size.width, run.end + reach) - 1;
  const uint64_t bits = bitsOf(wanted, {left / kWordColumns, above});
  const bool isInRun = (bits >> left % kWordColumns & 1) != 0;
  return {runsUpTo(wanted, found, left, above) - (isInRun ? 1 : 0),
          runsUpTo(wanted, found, right, above)};
}

/// Each run hangs on the first one that it touches above it.
__global__ void listRuns(Wanted wanted, int reach, ComponentsView found) {
  const WordOfThread word = wordOfThread(wanted.mask.words.size);
  if (!word.isInside) return;
  uint32_t number = found.firstRun[word.index];
  for (uint64_t begins = beginsOf(wanted, word.at); begins != 0; begins &= begins - 1, ++number) {
    const int first = lowestBit(begins);
    const Run run =
        runOf(word.at.y, word.at.x * kWordColumns + first, endOf(wanted, word.at, first));
    found.runs[number] = {run, 0};
    const TouchedRuns above = runsAbove(wanted, reach, run, found);
    found.parents[number] = above.first < above.last ? above.first : number;
  }
}

/// How many runs there are.
__device__ uint32_t runsOf(Size words, const ComponentsView& found) {
  return found.firstRun[words.area()];
}

/// Joins what a run touches besides. All shorten their ways first: of a tall thing's runs one hangs
/// on the other, and to walk that way takes longer than all else.
__global__ void joinRows(Wanted wanted, int reach, ComponentsView found) {
  constexpr int kJumps = 8;
  const uint32_t runs = runsOf(wanted.mask.words.size, found);
  for (auto run = static_cast<uint32_t>(indexInGrid()); run < runs; run += threadsOfGrid()) {
    uint32_t parent = found.parents[run];
    for (int i = 0; i < kJumps; ++i) {
      const uint32_t next = found.parents[parent];
      if (next == parent) break;
      found.parents[run] = parent = next;
    }
    const TouchedRuns above = runsAbove(wanted, reach, found.runs[run], found);
    for (uint32_t other = above.first + 1; other < above.last; ++other)
      join(found.parents, run, other);
  }
}

/// Each run's parent is its component's first run from then on.
__global__ void flatten(Size words, ComponentsView found) {
  const WordOfThread word = wordOfThread(words);
  if (!word.isInside) return;
  uint32_t roots = 0;
  forRunsFrom(found, word.index, [&](uint32_t run) {
    const uint32_t root = rootOf(found.parents, run);
    found.parents[run] = root;
    roots += root == run;
  });
  found.firstRoot[word.index] = roots;
}

/// Until the sums are done, a box holds its right and bottom edges instead of its size.
__global__ void numberComponents(Size words, int width, ComponentsView found) {
  const WordOfThread word = wordOfThread(words);
  if (!word.isInside) return;
  uint32_t number = found.firstRoot[word.index];
  forRunsFrom(found, word.index, [&](uint32_t i) {
    if (found.parents[i] != i) return;
    const ComponentRun& run = found.runs[i];
    const auto first = static_cast<uint32_t>(int64_t{run.y} * width + run.begin);
    found.numbers[i] = number;
    found.list[number++] = {{run.begin, run.y, run.end, run.y + 1}, 0, first};
  });
}

/// Of runs that come in raster order.
struct RunSums {
  uint32_t areaPx;
  int left, right, bottom;
};

__device__ void addTo(Component& component, const RunSums& sums) {
  atomicAdd(&component.areaPx, sums.areaPx);
  atomicMin(&component.box.x, sums.left);
  atomicMax(&component.box.width, sums.right);
  atomicMax(&component.box.height, sums.bottom);
}

/// Runs that neighbour in the raster are mostly of few components: those that most lanes of a warp
/// would add to are added to once.
__global__ void sumComponents(Size words, ComponentsView found) {
  constexpr int kShared = 3;
  const uint32_t runs = runsOf(words, found);
  const unsigned lane = threadIdx.x % kWarp;
  for (uint32_t first = static_cast<uint32_t>(indexInGrid()) - lane; first < runs;
       first += threadsOfGrid()) {
    const uint32_t i = first + lane;
    uint32_t component = ~0u;
    RunSums own{0, INT32_MAX, 0, 0};
    if (i < runs) {
      ComponentRun& run = found.runs[i];
      component = run.component = found.numbers[found.parents[i]];
      own = {static_cast<uint32_t>(run.end - run.begin), run.begin, run.end, run.y + 1};
    }
    unsigned left = __ballot_sync(kFullWarp, i < runs);
    for (int turn = 0; turn < kShared && left != 0; ++turn) {
      const uint32_t shared = __shfl_sync(kFullWarp, component, lowestBit(left));
      const bool isShared = component == shared;
      const RunSums sums{
          sumOfWarp(isShared ? own.areaPx : 0), leastOfWarp(isShared ? own.left : INT32_MAX),
          -leastOfWarp(isShared ? -own.right : 0), -leastOfWarp(isShared ? -own.bottom : 0)};
      if (lane == 0) addTo(found.list[shared], sums);
      left &= ~__ballot_sync(kFullWarp, isShared);
    }
    if ((left >> lane & 1) != 0) addTo(found.list[component], own);
  }
}

__global__ void closeBoxes(Size words, ComponentsView found) {
  const WordOfThread word = wordOfThread(words);
  if (!word.isInside) return;
  for (uint32_t i = found.firstRoot[word.index]; i < found.firstRoot[word.index + 1]; ++i) {
    Box& box = found.list[i].box;
    box.width -= box.x;
    box.height -= box.y;
  }
}

}  // namespace

void findComponents(const BitView& mask, bool value, Connectivity connectivity,
                    const ComponentsView& found, Stream stream) {
  const Size words = mask.words.size;
  const auto count = static_cast<int>(words.area());
  const Wanted wanted{mask, value};
  const int reach = connectivity == Connectivity::Eight ? 1 : 0;
  // A word, and the numbers of its runs; runs are few beside words.
  const auto over = [&](const char* name, double bytesOfWord) {
    return launchOverList(name, count, {bytesOfWord * count, 4.0 * count});
  };
  start(over("countRuns", 12), stream, countRuns, wanted, found.firstRun);
  scan(found.firstRun, count, found.firstRun, found.scratch, stream);
  start(over("listRuns", 12), stream, listRuns, wanted, reach, found);
  const auto overRuns = [&](const char* name, double bytesOfWord) {
    return launchInTurns(name, count, {bytesOfWord * count, 4.0 * count});
  };
  start(overRuns("joinRows", 12), stream, joinRows, wanted, reach, found);
  start(over("flatten", 8), stream, flatten, words, found);
  scan(found.firstRoot, count, found.firstRoot, found.scratch, stream);
  start(over("numberComponents", 8), stream, numberComponents, words, mask.size.width, found);
  start(overRuns("sumComponents", 4), stream, sumComponents, words, found);
  start(over("closeBoxes", 4), stream, closeBoxes, words, found);
}

}  // namespace rg::gpu
