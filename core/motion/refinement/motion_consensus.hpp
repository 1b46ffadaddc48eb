// SPDX-License-Identifier: LGPL-2.1-or-later
// What a region's neighbours make of its motion (part of stage 4).
//
// A region without texture, or with an edge in one direction only, can't tell its motion, but what
// it belongs to can. Each region looks for the vector that agrees with what it saw itself and with
// its neighbours: those with a long common border, little contrast across it and a like colour
// count most, and those far from the vector that most agree on hardly at all. Vectors spread from
// the sure to the unsure in a few sweeps (core/motion/refinement/consensus_sweep.hpp).
// Determinism: integers; a sweep reads what the sweep before wrote.
#pragma once

#include "core/base/memory/executor.hpp"
#include "core/graph/graph.hpp"
#include "core/motion/refinement/consensus_sweep.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace rg::motion {

/// Of each region those that count most, at most kMostNeighbours.
class MotionNeighbours {
 public:
  void find(const graph::Graph& graph);

  /// Those of the label of index i: list()[starts()[i]] and counts()[i] − 1 behind it.
  [[nodiscard]] std::span<const uint32_t> starts() const { return starts_; }
  [[nodiscard]] std::span<const uint32_t> counts() const { return counts_; }
  [[nodiscard]] std::span<const MotionNeighbour> list() const { return list_; }

 private:
  void keepStrongest(size_t region);

  std::vector<uint32_t> starts_, counts_;
  std::vector<MotionNeighbour> list_;
};

class MotionConsensus {
 public:
  /// own[i] and the result's [i] are those of the label of index i. The result is what the
  /// neighbours alone expect, weight 0 where there are none.
  std::span<const MotionPrior> run(const graph::Graph& graph, std::span<const SeenMotion> own,
                                   const Executor& executor);

 private:
  MotionNeighbours neighbours_;
  std::vector<int32_t> ownTrust_;
  std::vector<MotionBelief> before_, after_;
  std::vector<MotionPrior> priors_;
};

}  // namespace rg::motion
