// SPDX-License-Identifier: LGPL-2.1-or-later
// What the stage does with pixels: by the functions of this room, or by a device's counterparts of
// them. Which of the two did it can't be seen in the result.
#pragma once

#include "core/base/memory/executor.hpp"
#include "core/graph/graph.hpp"

#include <memory>

namespace rg::graph {

/// This class does it on the CPU.
class Operations {
 public:
  explicit Operations(const Executor& executor);
  virtual ~Operations();
  Operations(const Operations&) = delete;
  Operations& operator=(const Operations&) = delete;

  /// Fills the regions, arcs and runs of labels that were not skipped.
  virtual void build(const segmentation::Labels& labels, Connectivity connectivity, Graph& graph);

 protected:
  /// Fills the runs only.
  void listRuns(const segmentation::Labels& labels, RegionRuns& runs);

 private:
  class Bands;
  std::unique_ptr<Bands> bands_;
};

}  // namespace rg::graph
