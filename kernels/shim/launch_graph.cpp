// SPDX-License-Identifier: LGPL-2.1-or-later
#include "kernels/launch_graph.hpp"

#include "kernels/shim/block.hpp"
#include "kernels/shim/faults.hpp"

#include <atomic>
#include <cstring>
#include <memory>

namespace rg::gpu {

struct LaunchGraph {
  CommandList list;
};

namespace {

std::atomic<int64_t> graphs = 0;

const char* nameOf(const Command& command) {
  switch (command.kind) {
    case Command::Kind::Clear:
      return "clear";
    case Command::Kind::Copy:
      return "copy";
    case Command::Kind::Kernel:
      break;
  }
  return command.launch.name;
}

void runHere(const CommandList& list, const Command& command) {
  switch (command.kind) {
    case Command::Kind::Kernel:
      command.hostCall(command.launch, command.kernel, list.argumentsOf(command));
      break;
    case Command::Kind::Clear:
      shim::clear(command.to, command.bytes);
      break;
    case Command::Kind::Copy:
      std::memcpy(command.to, command.from, command.bytes);
  }
}

}  // namespace

int64_t shim::countGraphs() {
  return graphs;
}

namespace runtime {

void run(const CommandList& list, size_t index, Stream) {
  const Command& command = list[index];
  shim::call(nameOf(command));
  runHere(list, command);
}

LaunchGraph* makeGraph(const CommandList& list) {
  shim::call("cudaGraphCreate");
  for (size_t i = 0; i < list.size(); ++i) shim::call("cudaGraphAddNode");
  shim::call("cudaGraphInstantiate");
  auto made = std::make_unique<LaunchGraph>(LaunchGraph{list});
  ++graphs;
  return made.release();
}

void update(LaunchGraph& graph, const CommandList& list, size_t index) {
  shim::call("cudaGraphExecNodeSetParams");
  graph.list.take(list, index);
}

void launch(LaunchGraph& graph, Stream) {
  shim::call("cudaGraphLaunch");
  for (size_t i = 0; i < graph.list.size(); ++i) runHere(graph.list, graph.list[i]);
}

void endGraph(LaunchGraph* graph) noexcept {
  --graphs;
  delete graph;
}

}  // namespace runtime
}  // namespace rg::gpu
