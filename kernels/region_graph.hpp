// SPDX-License-Identifier: LGPL-2.1-or-later
// Counterpart of core/graph/graph.hpp (paper, section 2.3 phase 1.2). Runs are an artefact of the
// host.
#pragma once

#include "core/graph/graph.hpp"
#include "core/graph/region_sums.hpp"
#include "kernels/launch.hpp"
#include "kernels/pair_table.hpp"
#include "kernels/primitives.hpp"
#include "kernels/views.hpp"

#include <algorithm>
#include <cstdint>

namespace rg::gpu::graph {

/// No more pairs of `labels` regions touch in so many pixels.
[[nodiscard]] constexpr uint64_t mostArcs(int64_t pixels, uint32_t labels) {
  return std::clamp(uint64_t{labels} * labels / 2, uint64_t{1}, 4 * static_cast<uint64_t>(pixels));
}

/// rg::graph::Graph in device memory, for up to `mostLabels` labels.
struct GraphView {
  rg::graph::RegionSums* sums;  ///< mostLabels.
  rg::graph::Region* regions;   ///< mostLabels.
  PairTable pairs;              ///< slotsFor(mostArcs()): how long borders are,
  uint32_t* contrasts;          ///< and what they sum up to.
  SortView order;               ///< mostArcs().
  rg::graph::Arc* arcs;         ///< mostArcs().
  uint32_t* arcCount;
  uint32_t mostLabels;
};

/// labels: 1 … *count, which is in device memory; 0: none. Channels: red, green, blue.
struct LabelledPicture {
  ImageView<const uint16_t> labels;
  const uint32_t* count;
  Planes picture;
};
void buildGraph(const LabelledPicture& labelled, Connectivity connectivity, const GraphView& graph,
                Stream stream);

}  // namespace rg::gpu::graph
