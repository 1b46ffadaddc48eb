// SPDX-License-Identifier: LGPL-2.1-or-later
// Merging regions with the ground as one more node of their graph, under a moving camera (part of
// stage 5, core/objects/merge/mrf_merge.hpp).
//
// Most regions are surely the ground's from the start, so the cost follows what moves. Determinism:
// as minimise(); groups count from 0 in the order of their first regions.
#pragma once

#include "core/objects/merge/mrf_merge.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace rg::objects {

/// What is known of each region.
struct GroundTies {
  std::span<const GroundEnergy> energies;
  std::span<const uint8_t> isOpen;  ///< 0 = surely the ground.
  std::span<const uint8_t> moves;   ///< A guess, where the search starts.
};

struct GroundScratch {
  std::vector<uint32_t> nodeOf;  ///< Of each region; the ground is the last node.
  std::vector<WeightedArc> arcs;
  std::vector<uint32_t> groupOfNode;
  std::vector<GroupIndex> numberOf;  ///< Of each of those groups.
};

/// arcs: of the graph, as weighArcs() made them. groupOf: a start on entry, one entry per region,
/// where things that don't move count as the ground whatever it says. Returns the ground's group,
/// none where it has no region.
GroupIndex minimiseWithGround(const graph::Graph& graph, std::span<const ArcEnergy> arcs,
                              const GroundTies& ties, GroundScratch& scratch, MergeScratch& merging,
                              std::vector<uint32_t>& groupOf);

}  // namespace rg::objects
