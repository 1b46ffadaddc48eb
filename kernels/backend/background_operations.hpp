// SPDX-License-Identifier: LGPL-2.1-or-later
// core/background/operations.hpp on a GPU.
#pragma once

#include "kernels/backend/gpu_device.hpp"

#include <memory>

namespace rg::gpu::background {

/// An operation that the device refuses is done by the CPU, as are all from then on. Throws
/// DeviceError when the device is lost, with what was on it.
[[nodiscard]] std::unique_ptr<rg::background::Operations> makeOperations(GpuDevice& device,
                                                                         const Executor& executor);

}  // namespace rg::gpu::background
