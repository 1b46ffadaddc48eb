// SPDX-License-Identifier: LGPL-2.1-or-later
// The operations of core's segmentation room on a device.
#pragma once

#include "core/segmentation/operations.hpp"

#include <memory>

namespace rg::gpu {
class GpuDevice;
}

namespace rg::gpu::segmentation {

[[nodiscard]] std::unique_ptr<rg::segmentation::Operations> makeOperations(
    GpuDevice& device, const Executor& executor);

}  // namespace rg::gpu::segmentation
