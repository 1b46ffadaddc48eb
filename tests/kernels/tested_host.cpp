// SPDX-License-Identifier: LGPL-2.1-or-later
#include "kernels/backend/open_device.hpp"
#include "kernels/shim/block.hpp"
#include "kernels/shim/faults.hpp"
#include "tests/kernels/tested_device.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <string>

namespace rg::test {

using gpu::shim::Order;

int runTests() {
  return RUN_ALL_TESTS();
}

void checkInAllOrders(void (*check)()) {
  constexpr uint32_t kSeed = 7;
  for (const Order order : {Order::Natural, Order::Reversed, Order::Random}) {
    SCOPED_TRACE("order " + std::to_string(static_cast<int>(order)) + ", seed " +
                 std::to_string(kSeed));
    gpu::shim::begin({order, kSeed});
    check();
    expectNoFindings();
  }
}

void shuffleThreads(uint32_t seed) {
  gpu::shim::begin({Order::Random, seed});
}

void expectNoFindings() {
  for (const std::string& finding : gpu::shim::findings()) ADD_FAILURE() << finding;
}

std::shared_ptr<Device> openTested(const std::shared_ptr<Device>& neighbour) {
  gpu::shim::begin({});
  gpu::shim::plan(std::nullopt);
  auto device = gpu::openDevice(0, neighbour);
  EXPECT_TRUE(device);
  return *std::move(device);
}

bool isHost() {
  return true;
}

void failCall(uint64_t call, Failure how) {
  const auto kind = how == Failure::Loss ? DeviceError::Kind::Lost : DeviceError::Kind::Failed;
  gpu::shim::plan(gpu::shim::Fault{call, kind, how == Failure::Hang});
}

int64_t countAllocations() {
  return gpu::shim::countAllocations();
}

}  // namespace rg::test
