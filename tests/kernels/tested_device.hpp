// SPDX-License-Identifier: LGPL-2.1-or-later
// What kernels run on in a test: the host in a device's place (kernels/shim, tested_host.cpp), or a
// GPU (tested_gpu.cpp).
#pragma once

#include "core/base/memory/device.hpp"

#include <cstdint>
#include <memory>

namespace rg::test {

/// RUN_ALL_TESTS(); 77 where there is no device.
int runTests();

/// Calls check() in each order in which the device's threads can be told to come.
void checkInAllOrders(void (*check)());
/// The host's threads come in a random order from then on.
void shuffleThreads(uint32_t seed);
/// Adds a failure for all that kernels did since then that they must not do.
void expectNoFindings();

/// Nothing has failed on it, and nothing is planned to.
std::shared_ptr<Device> openTested(const std::shared_ptr<Device>& neighbour = nullptr);

/// Whether calls can be made to fail and allocations be counted: not a GPU's.
[[nodiscard]] bool isHost();
enum class Failure : uint8_t {
  Call,  ///< The call fails, and no other.
  Loss,  ///< The device is lost with it.
  Hang,  ///< Nothing that the device was given comes to an end from then on.
};
/// Of number `call` of the calls from then on.
void failCall(uint64_t call, Failure how);
/// Allocations that have not been released.
[[nodiscard]] int64_t countAllocations();

}  // namespace rg::test
