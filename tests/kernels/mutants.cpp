// SPDX-License-Identifier: LGPL-2.1-or-later
// Whether the parity tests would see an error: kernels are compiled with errors in them, one of
// which is switched on, and the named operation's test has to fail.
#include "kernels/device.hpp"
#include "kernels/shim/block.hpp"
#include "tests/kernels/parity.hpp"

#include <gtest/gtest-spi.h>

namespace rg {
namespace {

using gpu::Mutant;
using gpu::shim::Order;

/// How many failures of the comparison and findings of the shim there are in all thread orders.
int complaintsOf(void (*parity)()) {
  int complaints = 0;
  for (const Order order : {Order::Natural, Order::Reversed, Order::Random}) {
    ::testing::TestPartResultArray results;
    {
      const ::testing::ScopedFakeTestPartResultReporter reporter(
          ::testing::ScopedFakeTestPartResultReporter::INTERCEPT_ONLY_CURRENT_THREAD, &results);
      gpu::shim::begin({order, 7});
      parity();
    }
    for (int i = 0; i < results.size(); ++i) complaints += results.GetTestPartResult(i).failed();
    complaints += static_cast<int>(gpu::shim::findings().size());
  }
  return complaints;
}

void expectCaught(Mutant mutant, void (*parity)()) {
  gpu::activeMutant = mutant;
  EXPECT_GT(complaintsOf(parity), 0);
  gpu::activeMutant = Mutant::None;
}

TEST(Mutants, AMissingBarrierIsCaughtBySmooth) {
  expectCaught(Mutant::MissingBarrier, test::parity_smooth);
}

TEST(Mutants, AStaleHaloIsCaughtBySmooth) {
  expectCaught(Mutant::StaleHalo, test::parity_smooth);
}

TEST(Mutants, AnOddWidthIsCaughtByLoadPlanes) {
  expectCaught(Mutant::OddWidth, test::parity_loadPlanes);
}

TEST(Mutants, ALostAtomicIsCaughtByCountLevels) {
  expectCaught(Mutant::LostAtomic, test::parity_countLevels);
}

TEST(Mutants, AWrongTieBreakIsCaughtByFindComponents) {
  expectCaught(Mutant::WrongTieBreak, test::parity_findComponents);
}

TEST(Mutants, AWrongTieBreakIsCaughtByMatchBlocks) {
  expectCaught(Mutant::WrongTieBreak, test::parity_matchBlocks);
}

TEST(Mutants, AMissingBarrierIsCaughtByKeepMajority) {
  expectCaught(Mutant::MissingBarrier, test::parity_keepMajority);
}

TEST(Mutants, NoErrorIsNotCaught) {
  EXPECT_EQ(complaintsOf(test::parity_smooth), 0);
  EXPECT_EQ(complaintsOf(test::parity_countLevels), 0);
}

}  // namespace
}  // namespace rg
