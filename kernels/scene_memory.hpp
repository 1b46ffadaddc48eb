// SPDX-License-Identifier: LGPL-2.1-or-later
// Counterpart of core/background/scene_memory.hpp: whether a frame shows the scene that is known,
// what of it is learnt, and whether outlines are the scene's (ghosts/outline_ghosts.hpp).
#pragma once

#include "core/background/ghosts/outline_ghosts.hpp"
#include "core/background/methods/difference_operations.hpp"
#include "kernels/launch.hpp"
#include "kernels/views.hpp"

#include <cstdint>

namespace rg::gpu::background {

/// rg::background::countScene.
void countScene(ImageView<const uint8_t> now, ImageView<const uint8_t> scene,
                ImageView<const uint8_t> isKnown, int threshold,
                rg::background::SceneCounts* counts, Stream stream);

/// rg::background::SceneMemory in device memory.
struct MemoryView {
  PlaneTargets seen;
  ImageView<uint8_t> known;
};
/// What rg::background::DifferenceOperations::learn does. cells: rg::background::markCells().
void learnScene(const Planes& now, rg::background::ScannedRows scanned,
                ImageView<const uint8_t> cells, const MemoryView& memory, Stream stream);

/// A cell of a part whose outline is read, and the part's place in the sums.
struct OutlineCell {
  uint16_t x = 0, y = 0;
  uint32_t part = 0;
};
struct OutlineCells {
  const OutlineCell* list;
  int count;
  int parts;
};
/// rg::background::sumOutline of each part. pixels: CellSearch::pixels().
void sumOutlines(const OutlineCells& cells, ImageView<const uint8_t> pixels,
                 const rg::background::OutlinePlanes& planes, rg::background::OutlineSums* sums,
                 Stream stream);

}  // namespace rg::gpu::background
