// SPDX-License-Identifier: LGPL-2.1-or-later
// Every operation of kernels/operations.hpp against core, bit for bit, with the threads and blocks
// in natural, reversed and random order where the host is the device.
#include "tests/kernels/parity.hpp"

#include "tests/kernels/tested_device.hpp"

namespace rg {
namespace {

// Both of a pair have a name, or this does not compile.
#define RG_NAME(name, core, gpu) \
  namespace core_##name {        \
    using core;                  \
  }                              \
  namespace gpu_##name {         \
    using gpu;                   \
  }
RG_GPU_OPERATIONS(RG_NAME)
#undef RG_NAME

#define RG_TEST(name, core, gpu)                 \
  TEST(Parity, name) {                           \
    test::checkInAllOrders(test::parity_##name); \
  }
RG_GPU_OPERATIONS(RG_TEST)
#undef RG_TEST

}  // namespace
}  // namespace rg
