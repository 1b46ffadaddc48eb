// SPDX-License-Identifier: LGPL-2.1-or-later
// Launches that come together, on a device that is the host (kernels/shim): what is launched, when,
// and what remains of it when a call fails.
#include "kernels/launch_queue.hpp"

#include "kernels/shim/block.hpp"
#include "kernels/shim/faults.hpp"
#include "kernels/start.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace rg::gpu {
namespace {

struct Digit {
  uint8_t value;
  int64_t scale;
};

/// Its arguments are of several sizes, and the result tells their order.
__global__ void append(uint8_t first, int64_t* number, Digit digit) {
  if (threadIdx.x == 0) *number = *number * digit.scale + digit.value + first;
}
__global__ void add(int64_t* number, int64_t by) {
  if (threadIdx.x == 0) *number += by;
}

constexpr Launch kOne{"append", {1, 1, 1}, {32, 1, 1}, {}};

class Queued : public ::testing::Test {
 protected:
  Queued() {
    shim::begin({});
    shim::plan(std::nullopt);
  }
  ~Queued() override { shim::plan(std::nullopt); }

  /// From 0 the digits of `digits`, and copies the number.
  void addDigits(int digits) {
    clear(&number_, sizeof number_, stream_);
    std::vector<int> list;
    for (const char digit : std::to_string(digits)) list.push_back(digit - '0');
    for (int& digit : list) {
      start(kOne, stream_, append, uint8_t{0}, &number_, Digit{static_cast<uint8_t>(digit), 10});
      digit = 0;  // What was added is a copy.
    }
    queue_->addCopy(&copied_, &number_, sizeof number_);
  }
  void expectDigits(int digits) {
    EXPECT_EQ(number_, digits);
    EXPECT_EQ(copied_, digits);
  }
  void showDigits(int digits) {
    addDigits(digits);
    queue_->submit();
    expectDigits(digits);
  }
  void expectCounts(uint64_t single, uint64_t made, uint64_t updated, uint64_t launched) const {
    const LaunchQueue::Counts counts = queue_->counts();
    EXPECT_EQ(counts.single, single);
    EXPECT_EQ(counts.made, made);
    EXPECT_EQ(counts.updated, updated);
    EXPECT_EQ(counts.launched, launched);
  }

  std::optional<LaunchQueue> queue_{std::in_place, nullptr};
  const Stream stream_{nullptr, &*queue_};
  int64_t number_ = 7, copied_ = 0;
};

TEST_F(Queued, NothingRunsBeforeItIsSubmitted) {
  for (int i = 0; i < 3; ++i) {
    number_ = 7;
    addDigits(123);
    EXPECT_EQ(number_, 7);
    queue_->submit();
    expectDigits(123);
  }
  queue_->submit();
  expectCounts(5, 1, 0, 2);
}

TEST_F(Queued, WhatComesAgainIsAGraphThatIsKeptUpToDate) {
  showDigits(123);
  expectCounts(5, 0, 0, 0);
  showDigits(123);
  expectCounts(5, 1, 0, 1);
  showDigits(143);
  expectCounts(5, 1, 1, 2);
  showDigits(143);
  expectCounts(5, 1, 1, 3);
  showDigits(856);
  expectCounts(5, 1, 4, 4);
  EXPECT_EQ(queue_->counts().inGraph, 20u);
}

/// Places of clears and copies, too, and grids.
TEST_F(Queued, BuffersAndGridsMayChange) {
  for (int i = 0; i < 6; ++i) {
    std::array<int64_t, 2> memory{9, 9};
    int64_t counted = 0, out = 0;
    int64_t* const to = &memory[static_cast<size_t>(i % 2)];
    clear(to, sizeof *to, stream_);
    for (int k = 0; k < 2; ++k)
      start({"add", {static_cast<unsigned>(i + 1), 1, 1}, {32, 1, 1}, {}}, stream_, add, &counted,
            int64_t{5});
    queue_->addCopy(&out, to, sizeof out);
    start(kOne, stream_, add, to, int64_t{3});
    queue_->submit();
    EXPECT_EQ(out, 0);
    EXPECT_EQ(*to, 3);
    EXPECT_EQ(memory[static_cast<size_t>(1 - i % 2)], 9);
    EXPECT_EQ(counted, 10 * (i + 1));
  }
  EXPECT_EQ(queue_->counts().made, 1u);
}

TEST_F(Queued, ASequenceOfAnotherShapeIsAnotherGraph) {
  for (int i = 0; i < 3; ++i)
    for (const int digits : {123, 1234, 12345}) showDigits(digits);
  expectCounts(5 + 6 + 7, 3, 0, 6);
}

TEST_F(Queued, AFewLaunchesAreNoGraph) {
  for (int i = 0; i < 5; ++i) showDigits(1);
  expectCounts(15, 0, 0, 0);
}

TEST_F(Queued, GraphsAreNotManyAndEndWithIt) {
  const int64_t before = shim::countGraphs();
  constexpr int kSequences = 2 * LaunchQueue::kMostGraphs;
  for (int i = 0; i < kSequences; ++i)
    for (int k = 0; k < 2; ++k) {
      for (int j = 0; j < static_cast<int>(LaunchQueue::kLeastInGraph) + i; ++j)
        start(kOne, stream_, add, &number_, int64_t{1});
      queue_->submit();
      EXPECT_LE(shim::countGraphs() - before, static_cast<int64_t>(LaunchQueue::kMostGraphs));
    }
  EXPECT_EQ(queue_->counts().made, static_cast<uint64_t>(kSequences));
  queue_.reset();
  EXPECT_EQ(shim::countGraphs(), before);
}

/// Each call of a sequence that is new, of one that comes the second time and of one that is kept.
TEST_F(Queued, OneFailedCallCostsNothingAndIsToldOnce) {
  for (int earlier = 0; earlier < 3; ++earlier) {
    uint64_t call = 0;
    for (bool hasFailed = true; hasFailed; ++call) {
      SCOPED_TRACE(std::to_string(earlier) + " before, call " + std::to_string(call));
      queue_.emplace(nullptr);
      for (int i = 0; i < earlier; ++i) showDigits(123);
      addDigits(456);
      shim::plan(shim::Fault{call});
      hasFailed = false;
      try {
        queue_->submit();
      } catch (const DeviceError& error) {
        hasFailed = true;
        EXPECT_FALSE(error.isLost());
      }
      shim::plan(std::nullopt);
      expectDigits(456);
      EXPECT_NO_THROW(queue_->submit());
      for (const int digits : {456, 789, 123}) showDigits(digits);
    }
    // Launches; a graph with its nodes; updates of three of them.
    EXPECT_EQ(call - 1, earlier == 0 ? 5u : earlier == 1 ? 8u : 4u);
  }
}

TEST_F(Queued, WhatFailsTwiceIsALostDeviceForEver) {
  for (int earlier = 0; earlier < 3; ++earlier) {
    queue_.emplace(nullptr);
    for (int i = 0; i < earlier; ++i) showDigits(123);
    addDigits(456);
    shim::plan(shim::Fault{0, DeviceError::Kind::Failed, false, 1000});
    for (int i = 0; i < 2; ++i) {
      try {
        queue_->submit();
        ADD_FAILURE() << "nothing was told";
      } catch (const DeviceError& error) {
        EXPECT_TRUE(error.isLost());
      }
      shim::plan(std::nullopt);
    }
  }
}

TEST_F(Queued, ALossIsToldFromThenOn) {
  for (const uint64_t call : {0u, 3u}) {
    queue_.emplace(nullptr);
    shim::plan(shim::Fault{call, DeviceError::Kind::Lost});
    addDigits(123);
    EXPECT_NO_THROW(queue_->submitQuietly());
    for (int i = 0; i < 2; ++i) EXPECT_THROW(queue_->submit(), DeviceError);
    shim::plan(std::nullopt);
    EXPECT_THROW(queue_->submit(), DeviceError);
  }
}

TEST_F(Queued, WhatFailsQuietlyIsToldLater) {
  addDigits(123);
  shim::plan(shim::Fault{2});
  queue_->submitQuietly();
  expectDigits(123);
  EXPECT_THROW(queue_->submit(), DeviceError);
  EXPECT_NO_THROW(queue_->submit());
}

}  // namespace
}  // namespace rg::gpu
