// SPDX-License-Identifier: LGPL-2.1-or-later
// The operations of core's graph room on a device.
#pragma once

#include "core/graph/operations.hpp"

#include <memory>

namespace rg::gpu {
class GpuDevice;
}

namespace rg::gpu::graph {

/// All that they read is on the host, too: even a lost device costs nothing.
[[nodiscard]] std::unique_ptr<rg::graph::Operations> makeOperations(GpuDevice& device,
                                                                    const Executor& executor);

}  // namespace rg::gpu::graph
