// SPDX-License-Identifier: LGPL-2.1-or-later
// Connected components of one value of a mask, as runs of pixels.
//
// Determinism: integers only. A component's canonical label is its smallest raster index
// y · width + x; components are numbered densely from 0 in the order of that index, runs are sorted
// by row and column. Memory and time: O(pixels + runs), whatever the picture.
#pragma once

#include "core/base/bit_mask.hpp"
#include "core/base/geometry.hpp"
#include "core/base/memory/image.hpp"
#include "core/base/run.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace rg {

/// Its pixels are all of one component.
struct ComponentRun : Run {
  uint32_t component = 0;  ///< Index into Components::list.
};

struct Component {
  Box box;
  uint32_t areaPx = 0;
  uint32_t firstPixel = 0;  ///< Canonical label: smallest y · width + x.
};

/// Result and scratch in one; keep it from frame to frame and nothing is allocated.
struct Components {
  std::vector<ComponentRun> runs;
  std::vector<Component> list;
  std::vector<uint32_t> parents;  ///< Scratch.
  BitMask bits;                   ///< Scratch.
};

/// Finds the components of the pixels that are set, or of those that are not.
void findComponents(const BitMask& mask, bool value, Connectivity connectivity, Components& found);
/// Finds the components of the pixels that equal `value`.
void findComponents(ImageView<const uint8_t> mask, uint8_t value, Connectivity connectivity,
                    Components& found);

/// Writes `value` into the pixels of every component that `isChosen[component]` is not 0 for.
void paintComponents(const Components& found, std::span<const uint8_t> isChosen, bool value,
                     BitMask& mask);
void paintComponents(const Components& found, std::span<const uint8_t> isChosen, uint8_t value,
                     ImageView<uint8_t> mask);

}  // namespace rg
