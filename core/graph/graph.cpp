// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/graph/graph.hpp"

#include "core/base/memory/operations_source.hpp"
#include "core/base/memory/pool.hpp"
#include "core/base/renewed_stage.hpp"
#include "core/graph/operations.hpp"

#include <utility>

namespace rg::graph {
namespace {

class GraphStage final : public Stage {
 public:
  explicit GraphStage(const Context& context) : operations_(makeOperations<Operations>(context)) {}

  Result<std::shared_ptr<const Graph>> process(std::shared_ptr<const segmentation::Labels> labels,
                                               const Params& params) override;
  void reset(Reset) override {}

 private:
  std::unique_ptr<Operations> operations_;
  Pool<Graph> pool_;
};

Result<std::shared_ptr<const Graph>> GraphStage::process(
    std::shared_ptr<const segmentation::Labels> labels, const Params& params) {
  const auto graph = pool_.take();
  graph->size = labels->size;
  graph->status = labels->status;
  graph->regions.clear();
  graph->arcs.clear();
  graph->runs.list.clear();
  graph->runs.starts.assign(1, 0);
  if (labels->status != Status::Skipped) operations_->build(*labels, params.connectivity, *graph);
  graph->picture = labels->picture;
  graph->labels = std::move(labels);
  return std::shared_ptr<const Graph>(graph);
}

}  // namespace

std::unique_ptr<Stage> makeStage(Context context) {
  return std::make_unique<RenewedStage<Stage, GraphStage>>(std::move(context));
}

}  // namespace rg::graph
