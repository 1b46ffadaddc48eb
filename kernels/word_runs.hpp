// SPDX-License-Identifier: LGPL-2.1-or-later
// The runs of a mask's words; for .cu files only.
#pragma once

#include "kernels/components.hpp"
#include "kernels/threads.hpp"

namespace rg::gpu {

/// A thread of launchOverList() for each word of a mask, in raster order.
struct WordOfThread {
  int index;  ///< In the raster of words.
  Point at;   ///< Word of the row, row.
  bool isInside;
};
__device__ inline WordOfThread wordOfThread(Size words) {
  const int index = indexInGrid();
  return {index, {index % words.width, index / words.width}, index < words.area()};
}

/// Calls visit(run) for each run that begins in the word.
template <class Visit>
__device__ void forRunsFrom(const ComponentsView& found, int word, const Visit& visit) {
  for (uint32_t run = found.firstRun[word]; run < found.firstRun[word + 1]; ++run) visit(run);
}

/// Calls visit(run, bits) for each run that has columns in the word, also if it begins before.
template <class Visit>
__device__ void forRunsIn(const ComponentsView& found, const WordOfThread& word,
                          const Visit& visit) {
  const int begin = word.at.x * kWordColumns;
  const auto bitsOf = [&](const ComponentRun& run) {
    const int first = run.begin > begin ? run.begin - begin : 0;
    const int last = run.end - begin < kWordColumns ? run.end - begin : kWordColumns;
    return ~uint64_t{0} >> (kWordColumns - (last - first)) << first;
  };
  const uint32_t first = found.firstRun[word.index];
  if (first > 0) {
    const ComponentRun& before = found.runs[first - 1];
    if (before.y == word.at.y && before.end > begin) visit(first - 1, bitsOf(before));
  }
  forRunsFrom(found, word.index, [&](uint32_t run) { visit(run, bitsOf(found.runs[run])); });
}

/// Sets or clears in `mask` the parts that isChosen(found, component) is true for.
template <class Choice>
__global__ void changeParts(BitTarget mask, bool value, Choice isChosen, ComponentsView found) {
  const WordOfThread word = wordOfThread(mask.words.size);
  if (!word.isInside) return;
  uint64_t changed = 0;
  forRunsIn(found, word, [&](uint32_t run, uint64_t bits) {
    if (isChosen(found, found.runs[run].component)) changed |= bits;
  });
  if (changed == 0) return;
  uint64_t& columns = mask.words.at(word.at.x, word.at.y);
  columns = value ? columns | changed : columns & ~changed;
}

/// The same of an empty mask; what is in `out` is written over.
template <class Choice>
__global__ void markParts(BitTarget out, Choice isChosen, ComponentsView found) {
  const WordOfThread word = wordOfThread(out.words.size);
  if (!word.isInside) return;
  uint64_t marked = 0;
  forRunsIn(found, word, [&](uint32_t run, uint64_t bits) {
    if (isChosen(found, found.runs[run].component)) marked |= bits;
  });
  out.words.at(word.at.x, word.at.y) = marked;
}

/// Sets what is known of each component to nothing.
template <class T>
__global__ void forgetParts(Size words, ComponentsView found, T* values) {
  const WordOfThread word = wordOfThread(words);
  if (!word.isInside) return;
  for (uint32_t i = found.firstRoot[word.index]; i < found.firstRoot[word.index + 1]; ++i)
    values[i] = {};
}

/// A launch of a thread for each word.
inline Launch overWords(const char* name, const BitView& mask, double bytesOfWord) {
  const auto words = static_cast<double>(mask.words.size.area());
  return launchOverList(name, mask.words.size.area(), {bytesOfWord * words, 4 * words});
}

}  // namespace rg::gpu
