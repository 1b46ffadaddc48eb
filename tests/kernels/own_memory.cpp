// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/kernels/gpu_memory.hpp"

namespace rg::test {

int callInGpuMemory(int (*run)()) {
  return run();
}

}  // namespace rg::test
