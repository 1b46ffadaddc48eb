// SPDX-License-Identifier: LGPL-2.1-or-later
// CUDA's graphs: commands that a stream is given in one call. The host version (kernels/shim) has
// a list of copies.
//
// All of them throw DeviceError but where noexcept is said.
#pragma once

#include "kernels/command_list.hpp"

#include <cstddef>

namespace rg::gpu {
struct LaunchGraph;
}

namespace rg::gpu::runtime {

/// Gives the stream one of the commands by itself.
void run(const CommandList& list, size_t index, Stream stream);

/// Of all of them, each after the one before. Nothing of them runs.
[[nodiscard]] LaunchGraph* makeGraph(const CommandList& list);
/// From its next launch on the graph does what the list, which is of the same shape, says at
/// `index`; those that the stream has been given stay as they were.
void update(LaunchGraph& graph, const CommandList& list, size_t index);
void launch(LaunchGraph& graph, Stream stream);
/// The stream may still be at it.
void endGraph(LaunchGraph* graph) noexcept;

}  // namespace rg::gpu::runtime
