// SPDX-License-Identifier: LGPL-2.1-or-later
#include "kernels/launch_graph.hpp"
#include "kernels/start.hpp"

#include <memory>
#include <vector>

namespace rg::gpu {

struct LaunchGraph {
  cudaGraph_t graph = nullptr;  ///< Whose nodes stand for those of what is launched.
  cudaGraphExec_t launched = nullptr;
  std::vector<cudaGraphNode_t> nodes;
};

namespace runtime {
namespace {

/// CUDA reads the arguments where `places` tells.
cudaKernelNodeParams kernelOf(const Command& command, CommandList::Places& places) {
  const Extent &grid = command.launch.grid, &block = command.launch.block;
  cudaKernelNodeParams kernel{};
  kernel.func = const_cast<void*>(command.kernel);
  kernel.gridDim = dim3(grid.x, grid.y, grid.z);
  kernel.blockDim = dim3(block.x, block.y, block.z);
  kernel.kernelParams = places.data();
  return kernel;
}

cudaMemsetParams clearOf(const Command& command) {
  cudaMemsetParams clear{};
  clear.dst = command.to;
  clear.elementSize = 1;
  clear.width = command.bytes;
  clear.height = 1;
  return clear;
}

/// After the last one.
cudaGraphNode_t add(const LaunchGraph& graph, const CommandList& list, const Command& command) {
  const cudaGraphNode_t* before = graph.nodes.empty() ? nullptr : &graph.nodes.back();
  const size_t count = graph.nodes.empty() ? 0 : 1;
  cudaGraphNode_t node = nullptr;
  switch (command.kind) {
    case Command::Kind::Kernel: {
      CommandList::Places places = list.placesOf(command);
      const cudaKernelNodeParams kernel = kernelOf(command, places);
      check(cudaGraphAddKernelNode(&node, graph.graph, before, count, &kernel),
            "cudaGraphAddKernelNode");
      break;
    }
    case Command::Kind::Clear: {
      const cudaMemsetParams clear = clearOf(command);
      check(cudaGraphAddMemsetNode(&node, graph.graph, before, count, &clear),
            "cudaGraphAddMemsetNode");
      break;
    }
    case Command::Kind::Copy:
      check(cudaGraphAddMemcpyNode1D(&node, graph.graph, before, count, command.to, command.from,
                                     command.bytes, cudaMemcpyDeviceToDevice),
            "cudaGraphAddMemcpyNode1D");
  }
  return node;
}

struct End {
  void operator()(LaunchGraph* graph) const noexcept { endGraph(graph); }
};

}  // namespace

void run(const CommandList& list, size_t index, Stream stream) {
  const Command& command = list[index];
  switch (command.kind) {
    case Command::Kind::Kernel: {
      CommandList::Places places = list.placesOf(command);
      const cudaKernelNodeParams kernel = kernelOf(command, places);
      check(cudaLaunchKernel(command.kernel, kernel.gridDim, kernel.blockDim, places.data(), 0,
                             stream.handle),
            command.launch.name);
      break;
    }
    case Command::Kind::Clear:
      runClear(command.to, command.bytes, stream);
      break;
    case Command::Kind::Copy:
      check(cudaMemcpyAsync(command.to, command.from, command.bytes, cudaMemcpyDeviceToDevice,
                            stream.handle),
            "copy");
  }
}

LaunchGraph* makeGraph(const CommandList& list) {
  std::unique_ptr<LaunchGraph, End> made(new LaunchGraph);
  check(cudaGraphCreate(&made->graph, 0), "cudaGraphCreate");
  for (size_t i = 0; i < list.size(); ++i) made->nodes.push_back(add(*made, list, list[i]));
  check(cudaGraphInstantiateWithFlags(&made->launched, made->graph, 0), "cudaGraphInstantiate");
  return made.release();
}

void update(LaunchGraph& graph, const CommandList& list, size_t index) {
  const Command& command = list[index];
  const cudaGraphNode_t node = graph.nodes[index];
  switch (command.kind) {
    case Command::Kind::Kernel: {
      CommandList::Places places = list.placesOf(command);
      const cudaKernelNodeParams kernel = kernelOf(command, places);
      check(cudaGraphExecKernelNodeSetParams(graph.launched, node, &kernel),
            "cudaGraphExecKernelNodeSetParams");
      break;
    }
    case Command::Kind::Clear: {
      const cudaMemsetParams clear = clearOf(command);
      check(cudaGraphExecMemsetNodeSetParams(graph.launched, node, &clear),
            "cudaGraphExecMemsetNodeSetParams");
      break;
    }
    case Command::Kind::Copy:
      check(cudaGraphExecMemcpyNodeSetParams1D(graph.launched, node, command.to, command.from,
                                               command.bytes, cudaMemcpyDeviceToDevice),
            "cudaGraphExecMemcpyNodeSetParams1D");
  }
}

void launch(LaunchGraph& graph, Stream stream) {
  check(cudaGraphLaunch(graph.launched, stream.handle), "cudaGraphLaunch");
}

void endGraph(LaunchGraph* graph) noexcept {
  if (graph->launched != nullptr) (void)cudaGraphExecDestroy(graph->launched);
  if (graph->graph != nullptr) (void)cudaGraphDestroy(graph->graph);
  delete graph;
}

}  // namespace runtime
}  // namespace rg::gpu
