// SPDX-License-Identifier: LGPL-2.1-or-later
#include "kernels/backend/dispatcher.hpp"
#include "kernels/primitives.hpp"
#include "kernels/region_graph.hpp"

#include <algorithm>
#include <cstdint>

namespace rg::gpu::graph {
namespace {

using rg::graph::Arc;
using rg::graph::Graph;
using rg::graph::Region;
using rg::graph::RegionSums;
using Cpu = rg::graph::Operations;

class GpuOperations final : public Cpu, private Dispatcher {
 public:
  GpuOperations(GpuDevice& device, const Executor& executor) : Cpu(executor), Dispatcher(device) {}

  void build(const segmentation::Labels& labels, Connectivity connectivity, Graph& graph) override {
    const auto onCpu = [&] {
      graph.regions.clear();
      graph.arcs.clear();
      Cpu::build(labels, connectivity, graph);
    };
    if (labels.count == 0) return onCpu();
    runOrCatchUp([&] { buildOnDevice(labels, connectivity, graph); }, onCpu);
  }

 private:
  void buildOnDevice(const segmentation::Labels& labels, Connectivity connectivity, Graph& graph) {
    auto* count = scratch().take<uint32_t>(1);
    send(count, &labels.count, sizeof labels.count);
    const GraphView view = viewFor(labels);
    buildGraph({labels.ids.readOn(device()), count, on().readRed(*labels.picture)}, connectivity,
               view, stream());
    letBegin();
    // Meanwhile.
    listRuns(labels, graph.runs);
    // As a plane has them.
    const uint64_t expected =
        std::min(mostArcs(labels.size.area(), labels.count), uint64_t{3} * labels.count);
    fetchCounted(
        CountedList<Arc>{view.arcCount, view.arcs, static_cast<uint32_t>(expected), graph.arcs},
        FetchedList<Region>{view.regions, labels.count, graph.regions});
  }

  [[nodiscard]] GraphView viewFor(const segmentation::Labels& labels) const {
    const auto most = static_cast<int64_t>(mostArcs(labels.size.area(), labels.count));
    const int64_t slots = slotsFor(static_cast<uint64_t>(most));
    const int offsets = sortOffsetsOf(static_cast<int>(most));
    const auto numbers = [&](int64_t count) { return scratch().take<uint32_t>(count); };
    return {scratch().take<RegionSums>(labels.count),
            scratch().take<Region>(labels.count),
            {scratch().take<unsigned long long>(slots), numbers(slots)},
            numbers(slots),
            {numbers(most), numbers(most), numbers(most), numbers(most), numbers(offsets + 1),
             numbers(scanScratchOf(offsets))},
            scratch().take<Arc>(most),
            numbers(1),
            labels.count};
  }
};

}  // namespace
}  // namespace rg::gpu::graph

template <>
std::unique_ptr<rg::graph::Operations> rg::gpu::operationsOn(GpuDevice& device,
                                                             const Executor& executor) {
  return std::make_unique<graph::GpuOperations>(device, executor);
}
