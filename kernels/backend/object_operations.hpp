// SPDX-License-Identifier: LGPL-2.1-or-later
// The operations of core's objects room on a device.
#pragma once

#include "core/objects/operations.hpp"

#include <memory>

namespace rg::gpu {
class GpuDevice;
}

namespace rg::gpu::objects {

/// All that they read is on the host, too: even a lost device costs nothing.
[[nodiscard]] std::unique_ptr<rg::objects::Operations> makeOperations(GpuDevice& device,
                                                                      const Executor& executor);

}  // namespace rg::gpu::objects
