// SPDX-License-Identifier: LGPL-2.1-or-later
#include "kernels/backend/open_device.hpp"
#include "kernels/runtime.hpp"
#include "tests/kernels/gpu_memory.hpp"
#include "tests/kernels/tested_device.hpp"

#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <cuda_runtime.h>
#include <string>

namespace rg::test {

/// Tests look at what a kernel has left as soon as it is started.
int runTests() {
  constexpr int kSkipped = 77;  // As meson and automake know it.
  setenv("CUDA_LAUNCH_BLOCKING", "1", 1);
  if (gpu::runtime::countDevices() == 0) {
    std::printf("skipped: no CUDA device can be used: %s\n", gpu::runtime::whyNone().c_str());
    return kSkipped;
  }
  return callInGpuMemory([] { return RUN_ALL_TESTS(); });
}

void checkInAllOrders(void (*check)()) {
  check();
  expectNoFindings();
}

void shuffleThreads(uint32_t) {}

void expectNoFindings() {
  const cudaError_t code = cudaDeviceSynchronize();
  EXPECT_EQ(code, cudaSuccess) << cudaGetErrorString(code);
}

std::shared_ptr<Device> openTested(const std::shared_ptr<Device>& neighbour) {
  auto device = gpu::openDevice(0, neighbour);
  EXPECT_TRUE(device) << device.error().message;
  return *std::move(device);
}

bool isHost() {
  return false;
}

void failCall(uint64_t, Failure) {
  ADD_FAILURE() << "a GPU's calls can't be made to fail";
}

int64_t countAllocations() {
  ADD_FAILURE() << "a GPU's allocations are not counted";
  return 0;
}

}  // namespace rg::test
