// SPDX-License-Identifier: LGPL-2.1-or-later
// Whose the foreground is: a second minimum of the energy (core/objects/merge/mrf_merge.hpp), over
// parts of regions and terminals, one for each track that is looked for and one for nobody.
//
// Parts that touch have arcs as regions have: U1 + U2 + U3 + prediction. A part's arc to a track
// weighs, with √A the root of the part's area,
//   w = √A (prediction (place (P + most) + [its region is expected to be the track]) + look)
//       − U1 of the region's motion and the track's.
// P says how well the part fits into the track's fitted outline: 1 inside, less than 0 outside, the
// less the further away in deviations of the track's own size, −most at least; look, how well its
// pixels agree with the track's colours, and with its portrait where that was found. What is out of
// a track's reach has no arc to it. Nobody has one to each part, of √A prediction place most, so
// that all is as if that had been taken from the others. No two terminals are ever in one group: a
// group with a track's is what is seen of the track.
//
// Determinism: integers; terminals in the order of their tasks.
#pragma once

#include "core/objects/merge/mrf_merge.hpp"
#include "core/objects/tracking/ownership/region_parts.hpp"
#include "core/objects/tracking/tracker_state.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace rg::objects {

/// What a frame's regions were merged by.
struct MergeInput {
  const motion::Motion& motion;  ///< What regions show: their trends, or what moves this moment.
  MergeWeights weights;
  int64_t stepNs = 0;
};

class TrackTerminals {
 public:
  /// state.owner says which cells each track claims, and then which it owns; sightings say what is
  /// seen of it. partedFrom: of each cell the track that gave it up, as PartedTracks says.
  void decide(const GroupGrid& evidence, const MergeInput& input,
              std::span<const uint16_t> partedFrom, TrackerState& state);

 private:
  /// What a track finds in a part: sums over the cells in its reach, in 1/256.
  struct Agreement {
    uint32_t cells = 0;
    int64_t place = 0, look = 0;
  };
  /// Distances from a box along an axis, from cell `begin` on: squares, in 1/256 of a deviation's.
  struct Distances {
    int begin = 0;
    std::vector<int32_t> squared;

    [[nodiscard]] int size() const { return static_cast<int>(squared.size()); }
    /// Those below `most`, from low … low + length − 1 on an axis of `cells`.
    void list(int low, int length, int cells, int64_t deviation, int64_t most);
  };

  void linkParts(const GroupGrid& evidence, const MergeInput& input);
  void tieToTrack(uint32_t terminal, const GroupGrid& evidence, const MergeInput& input,
                  const FitTask& task, const TrackerState& state);
  void compareOutline(const GroupGrid& evidence, const FitTask& task, const TrackerState& state);
  void compareBlob(const GroupGrid& evidence, const FitTask& task, const TrackerState& state);
  void comparePortrait(const GroupGrid& evidence, const FitTask& task, const TrackerState& state);
  void compareCell(size_t cell, int64_t place, int64_t look);
  void tieToNobody(const GroupGrid& evidence, const MergeInput& input, const TrackerState& state);
  void keepApart(uint32_t nodes);
  void give(const GroupGrid& evidence, TrackerState& state);
  void sight(const GroupGrid& evidence, const graph::Graph& graph, TrackerState& state);

  RegionParts parts_;
  std::vector<WeightedArc> arcs_;    ///< Nodes: parts, then the tracks' terminals, then nobody's.
  std::vector<uint32_t> terminals_;  ///< Node of each track, by number; 0 = none.
  std::vector<uint32_t> groupOf_;
  std::vector<Agreement> agreement_;  ///< Of each part, with the track in turn.
  std::vector<uint32_t> met_;         ///< Parts that have one.
  Distances columns_, rows_;
  std::vector<uint32_t> component_;
  std::vector<uint16_t> trackOf_;  ///< Of each group: 1 + the track, 0 = none.
  std::vector<uint16_t> ownerOf_;  ///< Of each region the same, or kSeveral.
  MergeScratch scratch_;
};

}  // namespace rg::objects
