// SPDX-License-Identifier: LGPL-2.1-or-later
// The way from an element to a GPU. Built without CUDA it leads nowhere, and says so.
#pragma once

#include "core/base/memory/device.hpp"
#include "core/base/result.hpp"

#include <memory>

namespace rg::gpu {

/// Number `device` of the machine's, or why it can't be used and what would help. It serves one
/// stage, on one thread at a time, and shares memory with `neighbour`, which is of the same number.
[[nodiscard]] Result<std::shared_ptr<Device>> openDevice(
    int device, const std::shared_ptr<Device>& neighbour = nullptr);

}  // namespace rg::gpu
