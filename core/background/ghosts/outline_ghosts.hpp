// SPDX-License-Identifier: LGPL-2.1-or-later
// Is what stands still a thing, or the place that a thing has left while the memory shows it still?
#pragma once

#include "core/background/cell_search.hpp"
#include "core/background/scene_memory.hpp"

#include <cstdint>

namespace rg::background {

/// Whether the part's outline is an edge in the memory rather than in the picture. Sums over its
/// pixels: any order gives the same.
[[nodiscard]] bool isGhost(const CellSearch& search, uint32_t part, const ColourPlanes& now,
                           const SceneMemory& memory);

}  // namespace rg::background
