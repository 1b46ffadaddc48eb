// SPDX-License-Identifier: LGPL-2.1-or-later
// Merging regions that move alike: U = U1 (motion) + U2 (geometry) + U3 (broken arcs) + prediction,
// minimised over the arcs of the region graph (paper, section 2.3 phase 2.2).
//
// Up to a constant, U is minus the sum of the weights of the arcs that are kept, where an arc
// between regions s and t with border L weighs
//   w = border L 16 / (16 + contrast) + arc √frame / 16 · 30 / (30 + |colour s − colour t|)
//       + min(√As, √At) (prediction [same object predicted] − motion r excess),
//   excess = clamp(|vs − vt|² − T², 0, 6 T²) / T²,  r = the lesser reliability of the two.
// Regions that show no reliable motion are thus joined by geometry alone. It is cheap to part them
// where an edge is seen (U2: along the border, U3: between their colours as a whole), as the ends
// of things mostly show one.
//
// Where the camera moves, the ground is one more node, with an arc to every region: that weighs by
// how much better the camera's motion explains the region's pixels than another (U1,
// core/objects/merge/own_motion.hpp), and by the prediction: for the ground where no object is
// expected in the region, against it where one is seen that has stopped
// (core/objects/tracking/standing_tracks.hpp). What ends up in the ground's group is background. So
// the same sum decides what moves at all.
//
// Determinism: integers; every choice has a key (weight, then a hash of the two labels, then the
// labels), so the result depends on the graph alone. Groups count from 0 in the order of their
// first regions.
#pragma once

#include "core/motion/motion.hpp"
#include "core/objects/indices.hpp"
#include "core/objects/merge/arc_energy.hpp"
#include "core/objects/numbers.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace rg::objects {

struct Params;

/// Weights in 1/256; what they weigh is in pixels.
struct MergeWeights {
  int32_t motion = 256;
  int32_t border = 512;
  int32_t arc = 256;
  int32_t prediction = 512;
  int32_t motionThreshold = motion::kMotionUnit;  ///< T, in 1/16 px per step, at least a pixel.
  Numbers::Energy numbers{};
};

/// Where frames of that size are stepNs apart.
[[nodiscard]] MergeWeights weightsOf(const Params& params, Size frame, int64_t stepNs);

/// How long it takes until what moves at the threshold's speed has moved by a pixel; at most a
/// second.
[[nodiscard]] int64_t nsPerPixel(const Params& params, Size frame);

/// An arc between nodes a < b that count from 0.
struct WeightedArc {
  uint32_t a = 0;
  uint32_t b = 0;
  int64_t weight = 0;
  friend constexpr bool operator==(const WeightedArc&, const WeightedArc&) = default;
};

/// The weight of an arc between two that are never in one group: more than all others together say.
inline constexpr int64_t kNever = -(int64_t{1} << 40);

/// Working memory that keeps its capacity from frame to frame.
struct MergeScratch {
  std::vector<uint32_t> alternative;  ///< A second partition, to compare with.
  std::vector<uint32_t> firstArc;  ///< Neighbours of node i: firstArc[i] … firstArc[i + 1] − 1.
  std::vector<WeightedArc> neighbours;  ///< a = the node, b = its neighbour.

  // Groups while they are contracted, each called by its smallest node.
  std::vector<uint32_t> groupName;             ///< The smallest of its numbers.
  std::vector<uint32_t> parent;                ///< What it was merged into.
  std::vector<uint32_t> best;                  ///< The neighbour that it likes best.
  std::vector<WeightedArc> links;              ///< As neighbours, of groups.
  std::vector<uint32_t> linkCount;             ///< Of each node's place in `links`.
  std::vector<uint32_t> nextPlace, lastPlace;  ///< Of a group.
  std::vector<uint32_t> linkAt, seen;          ///< Of a neighbour, at a time.
  std::vector<uint32_t> changed, joined;
  uint32_t time = 0;
  uint64_t contractionVisits = 0;  ///< Of links.

  // The local search.
  std::vector<int64_t> pull;       ///< Of a node towards each group.
  std::vector<int64_t> hubWeight;  ///< Of each node's arcs to the node that has most.
  std::vector<uint32_t> emptied;   ///< Of EmptyGroups.
  std::vector<uint8_t> isSettled;  ///< Of each node: nothing changed around it since its last turn.
  std::vector<uint32_t> groupSize;
  std::vector<uint32_t> touched;
  std::vector<uint8_t> notedAt;  ///< Of each node the length of the chain that it was met at, or 0.
  std::vector<int64_t> gain;     ///< Of those, by changing between the chain's two groups.
  std::vector<uint32_t> noted;
  std::vector<uint32_t> searched;   ///< The partition that chains left, empty before the first.
  std::vector<uint32_t> triedAt;    ///< When no chain from a node gained anything; 0: never.
  std::vector<uint32_t> changedAt;  ///< When a group last got or lost a node.
  uint32_t chainTime = 0;
  uint64_t visits = 0;               ///< Of arcs, by the chains.
  uint64_t visitLimit = UINT64_MAX;  ///< No chain begins beyond it.
  bool isCutShort = false;           ///< Chains were left out for that, or the contraction was
                                     ///< hurried (core/objects/merge/merge_contraction.hpp).

  [[nodiscard]] std::span<const WeightedArc> arcsOf(uint32_t node) const {
    return {neighbours.data() + firstArc[node], neighbours.data() + firstArc[node + 1]};
  }
};

/// Merged regions.
struct Group {
  uint32_t areaPx = 0;
  uint32_t regionCount = 0;
  Box box;
  int32_t dx = 0;  ///< Mean of the members' motion by area and reliability, in 1/16 px.
  int32_t dy = 0;
  uint16_t reliability = 0;  ///< Mean of the members' by area.
  int64_t momentX = 0;       ///< Sum of area x reliability x motion, of which dx is the mean.
  int64_t momentY = 0;
  int64_t weight = 0;  ///< Sum of area x reliability.
  int64_t sumX = 0;    ///< Of the pixels' places, in 1/256 px.
  int64_t sumY = 0;
};

/// What arcs between things in frames of one size add to U.
class ArcWeigher {
 public:
  ArcWeigher(Size frame, const MergeWeights& weights);
  /// U1 of two that move so, the lesser of which has an area of that root, in pixels.
  [[nodiscard]] int64_t motion(const motion::RegionMotion& v, const motion::RegionMotion& u,
                               int64_t rootArea) const;
  /// U2 of a border.
  [[nodiscard]] int64_t border(uint32_t borderPx, uint32_t meanContrast) const;
  /// U3 of two of such colours.
  [[nodiscard]] int64_t arc(graph::Colour a, graph::Colour b) const;
  /// Of what is expected to be one object.
  [[nodiscard]] int64_t prediction(int64_t rootArea) const {
    return weights_.prediction * rootArea;
  }

 private:
  const MergeWeights& weights_;
  int64_t threshold2_, mostExcess_, halfContrast_, halfColour_, arcUnit_;
};

/// What each of the graph's arcs adds to U. predicted: of each region the track that it is expected
/// to be, or none; an empty span = nothing is expected.
void weighArcs(const motion::Motion& motion, std::span<const TrackIndex> predicted,
               const MergeWeights& weights, std::vector<ArcEnergy>& energies);

inline constexpr int64_t kGainUnit = 256;

/// The arc between a region and the ground. gain: how much better another motion than the camera's
/// explains it, in 1/kGainUnit (OwnMotion). stoppedPx: of its pixels those that show a thing which
/// is known to stand there.
[[nodiscard]] GroundEnergy weighGround(int64_t gain, int64_t areaPx, bool isExpected,
                                       const MergeWeights& weights, int64_t stoppedPx = 0);

/// The arcs of the graph as minimise() takes them; `energies` as weighArcs() made them.
void listArcs(const graph::Graph& graph, std::span<const ArcEnergy> energies,
              std::vector<WeightedArc>& arcs);

/// Arcs that the chains of one call of minimise() look at, at most, but for the last chain of each
/// start. Frames of a thousand regions take a tenth to a half of it.
[[nodiscard]] constexpr uint64_t mostVisits(uint64_t nodes, uint64_t arcs) {
  return (uint64_t{1} << 22) + 16 * (nodes + arcs);
}

/// Sum of the weights of the arcs inside groups: what minimising U maximises.
[[nodiscard]] int64_t keptWeight(std::span<const WeightedArc> arcs,
                                 std::span<const uint32_t> groupOf);

/// Groups the nodes so that keptWeight is as large as contraction by mutual best choice and a local
/// search make it. If `groupOf` comes with an entry per node, that partition is a second start and
/// the better end is taken. Every group of the result is connected by arcs.
/// Time: O(E) for each round of the contraction and each sweep of the search; both are limited, and
/// so are the arcs that chains look at (mostVisits) and those that mutual choice takes. Something
/// like a wall that tens of thousands of specks touch would take their square. Where a limit is
/// reached, the other nodes are moved one by one only, groups join whom they like best unasked, and
/// scratch.isCutShort is set.
void minimise(uint32_t nodeCount, std::span<const WeightedArc> arcs, MergeScratch& scratch,
              std::vector<uint32_t>& groupOf);

/// What the groups of a partition have in common.
void describeGroups(const motion::Motion& motion, std::span<const GroupIndex> groupOf,
                    std::vector<Group>& groups);

/// The group with the most pixels, of equal ones the first; none where more pixels of the frame
/// have no region.
[[nodiscard]] GroupIndex largestGroup(std::span<const Group> groups, Size frame);

}  // namespace rg::objects
