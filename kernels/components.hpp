// SPDX-License-Identifier: LGPL-2.1-or-later
// Counterpart of core/base/components.hpp: the same runs, the same numbers, in the same order.
//
// Runs are numbered by the raster as they are counted and summed up word by word; sets are joined
// by atomicMin on the least run, so that any order of joins ends in the same forest.
#pragma once

#include "core/base/components.hpp"
#include "kernels/launch.hpp"
#include "kernels/primitives.hpp"
#include "kernels/views.hpp"

#include <cstdint>

namespace rg::gpu {

/// rg::Components in device memory, sized for the worst mask of a frame.
struct ComponentsView {
  ComponentRun* runs;   ///< mostRuns().
  Component* list;      ///< mostRuns().
  uint32_t* parents;    ///< mostRuns(): of each run, the first run of its component.
  uint32_t* numbers;    ///< mostRuns(): of a component's first run, its number.
  uint32_t* firstRun;   ///< A number more than words: runs that begin before each word.
  uint32_t* firstRoot;  ///< The same of components.
  uint32_t* scratch;    ///< scanScratchOf(words).
};
[[nodiscard]] constexpr int64_t mostRuns(Size size) {
  return int64_t{size.width + 1} / 2 * size.height;
}

/// How many runs there are is firstRun's last number, how many components firstRoot's.
void findComponents(const BitView& mask, bool value, Connectivity connectivity,
                    const ComponentsView& found, Stream stream);

}  // namespace rg::gpu
