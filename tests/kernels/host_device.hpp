// SPDX-License-Identifier: LGPL-2.1-or-later
// A device that is the host (kernels/shim), for tests of whole stages.
#pragma once

#include "kernels/backend/open_device.hpp"
#include "kernels/shim/block.hpp"
#include "kernels/shim/faults.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <optional>

namespace rg::test {

/// Nothing has failed on it, and nothing is planned to.
inline std::shared_ptr<Device> openHost(const std::shared_ptr<Device>& neighbour = nullptr) {
  gpu::shim::begin({});
  gpu::shim::plan(std::nullopt);
  auto device = gpu::openDevice(0, neighbour);
  EXPECT_TRUE(device);
  return *std::move(device);
}

}  // namespace rg::test
