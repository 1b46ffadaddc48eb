// SPDX-License-Identifier: LGPL-2.1-or-later
// Every operation of kernels/operations.hpp against core, bit for bit, with the threads and blocks
// in natural, reversed and random order, on the host (kernels/shim).
#include "kernels/shim/block.hpp"
#include "tests/kernels/parity.hpp"

namespace rg {
namespace {

using gpu::shim::Order;

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

void checkInAllOrders(void (*parity)()) {
  constexpr uint32_t kSeed = 7;
  for (const Order order : {Order::Natural, Order::Reversed, Order::Random}) {
    SCOPED_TRACE("order " + std::to_string(static_cast<int>(order)) + ", seed " +
                 std::to_string(kSeed));
    gpu::shim::begin({order, kSeed});
    parity();
    for (const std::string& finding : gpu::shim::findings()) ADD_FAILURE() << finding;
  }
}

#define RG_TEST(name, core, gpu)           \
  TEST(Parity, name) {                     \
    checkInAllOrders(test::parity_##name); \
  }
RG_GPU_OPERATIONS(RG_TEST)
#undef RG_TEST

}  // namespace
}  // namespace rg

/// A filter that matches nothing is an error: each operation's test is chosen by its name.
int main(int count, char** arguments) {
  testing::InitGoogleTest(&count, arguments);
  const int failed = RUN_ALL_TESTS();
  return testing::UnitTest::GetInstance()->test_to_run_count() > 0 ? failed : 1;
}
