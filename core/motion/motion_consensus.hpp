// SPDX-License-Identifier: LGPL-2.1-or-later
// What a region's neighbours make of its motion (part of stage 4).
//
// A region without texture, or with an edge in one direction only, can't tell its motion, but what
// it belongs to can. Each region looks for the vector that agrees with what it saw itself and with
// its neighbours: those with a long common border, little contrast across it and a like colour
// count most, and those far from the vector that most agree on hardly at all. Vectors spread from
// the sure to the unsure in a few sweeps. Determinism: integers; a sweep reads what the sweep
// before wrote.
#pragma once

#include "core/base/memory/executor.hpp"
#include "core/graph/graph.hpp"
#include "core/motion/motion_fit.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace rg::motion {

/// What a region saw of its own motion.
struct SeenMotion {
  Point at;                 ///< 1/256 px.
  Information information;  ///< All 0: nothing.
};

class MotionConsensus {
 public:
  /// own[i] and the result's [i] are those of the label of index i. The result is what the
  /// neighbours alone expect, weight 0 where there are none.
  std::span<const MotionPrior> run(const graph::Graph& graph, std::span<const SeenMotion> own,
                                   const Executor& executor);

 private:
  struct Neighbour {
    uint32_t region = 0;
    int32_t weight = 0;
  };
  struct Belief {
    Point at;
    int32_t trust = 0;  ///< 0 … 256.
  };

  void findNeighbours(const graph::Graph& graph);
  void keepStrongest(size_t region);
  void sweep(size_t region, const SeenMotion& own);
  [[nodiscard]] Point findCentre(size_t region, const SeenMotion& own) const;
  [[nodiscard]] int64_t disagreement(size_t region, const SeenMotion& own, Point at) const;
  [[nodiscard]] std::span<const Neighbour> neighboursOf(size_t region) const {
    return {neighbours_.data() + starts_[region], counts_[region]};
  }

  std::vector<uint32_t> starts_, counts_;
  std::vector<Neighbour> neighbours_;
  std::vector<int32_t> ownTrust_;
  std::vector<Belief> before_, after_;
  std::vector<MotionPrior> priors_;
};

}  // namespace rg::motion
