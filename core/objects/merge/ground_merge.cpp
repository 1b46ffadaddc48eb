// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/merge/ground_merge.hpp"

#include <algorithm>

namespace rg::objects {
namespace {

/// Returns the number of nodes.
uint32_t listNodes(const GroundTies& ties, GroundScratch& s) {
  const auto ground = static_cast<uint32_t>(ties.isOpen.size()) -
                      static_cast<uint32_t>(std::count(ties.isOpen.begin(), ties.isOpen.end(), 0));
  s.nodeOf.clear();
  uint32_t count = 0;
  for (const uint8_t isOpen : ties.isOpen) s.nodeOf.push_back(isOpen != 0 ? count++ : ground);
  return ground + 1;
}

void listArcs(const graph::Graph& graph, std::span<const ArcEnergy> arcs, const GroundTies& ties,
              uint32_t ground, GroundScratch& s) {
  s.arcs.clear();
  s.arcs.reserve(graph.arcs.size() + ground);
  for (size_t i = 0; i < graph.arcs.size(); ++i) {
    const auto [low, high] =
        std::minmax(s.nodeOf[graph.arcs[i].a.index()], s.nodeOf[graph.arcs[i].b.index()]);
    if (low != high) s.arcs.push_back({low, high, arcs[i].weight()});
  }
  for (size_t r = 0; r < ties.isOpen.size(); ++r)
    if (ties.isOpen[r] != 0) s.arcs.push_back({s.nodeOf[r], ground, ties.energies[r].weight()});
}

}  // namespace

GroupIndex minimiseWithGround(const graph::Graph& graph, std::span<const ArcEnergy> arcs,
                              const GroundTies& ties, GroundScratch& s, MergeScratch& merging,
                              std::vector<uint32_t>& groupOf) {
  const uint32_t nodes = listNodes(ties, s), ground = nodes - 1;
  uint32_t startOfGround = 0;
  for (const uint32_t group : groupOf) startOfGround = std::max(startOfGround, group + 1);
  s.groupOfNode.assign(nodes, startOfGround);
  for (size_t r = 0; r < groupOf.size(); ++r)
    if (ties.isOpen[r] != 0 && ties.moves[r] != 0) s.groupOfNode[s.nodeOf[r]] = groupOf[r];
  listArcs(graph, arcs, ties, ground, s);
  minimise(nodes, s.arcs, merging, s.groupOfNode);
  s.numberOf.assign(nodes, {});
  uint32_t count = 0;
  for (size_t r = 0; r < groupOf.size(); ++r) {
    GroupIndex& number = s.numberOf[s.groupOfNode[s.nodeOf[r]]];
    if (!number) number = GroupIndex::ofIndex(count++);
    groupOf[r] = number.index();
  }
  return s.numberOf[s.groupOfNode[ground]];
}

}  // namespace rg::objects
