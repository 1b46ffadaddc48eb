// SPDX-License-Identifier: LGPL-2.1-or-later
// Copies to and from a device that is the host (kernels/shim), where time goes on while one waits.
#include "kernels/backend/staging.hpp"

#include "core/base/memory/device.hpp"
#include "kernels/backend/dispatcher.hpp"
#include "kernels/shim/faults.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <vector>

namespace rg::gpu {
namespace {

using Bytes = std::vector<uint8_t>;

Bytes counted(size_t bytes, int first) {
  Bytes values(bytes);
  std::iota(values.begin(), values.end(), static_cast<uint8_t>(first));
  return values;
}

TEST(Staging, CopiesOfAllSizesComeBack) {
  shim::plan(std::nullopt);
  const int64_t before = shim::countHostAllocations();
  {
    Staging staging(nullptr);
    for (const size_t bytes : {1u, 65536u, 65537u, 300000u})
      for (int i = 0; i < 40; ++i) {
        Bytes there(bytes), back(bytes);
        const Bytes sent = counted(bytes, i);
        staging.upload(there.data(), sent.data(), bytes);
        staging.download({{back.data(), there.data(), bytes}});
        ASSERT_EQ(back, sent);
      }
    EXPECT_GT(shim::countHostAllocations(), before);
  }
  EXPECT_EQ(shim::countHostAllocations(), before);
}

/// However many there are, some wait for others to be done.
TEST(Staging, CopiesOnTheWayTakeLittleMemory) {
  shim::plan(std::nullopt);
  const int64_t before = shim::countHostAllocations();
  Staging staging(nullptr);
  Bytes there(100);
  const Bytes sent = counted(100, 3);
  for (int i = 0; i < 100; ++i) staging.upload(there.data(), sent.data(), sent.size());
  EXPECT_EQ(there, sent);
  EXPECT_LE(shim::countHostAllocations() - before, 8);
}

TEST(Staging, CopiesTogetherComeEachToItsPlace) {
  shim::plan(std::nullopt);
  Staging staging(nullptr);
  const Bytes small = counted(3, 1), large = counted(70000, 2);
  Bytes first(3), second(70000), none(1, 7);
  staging.download({{first.data(), small.data(), 3},
                    {none.data(), small.data(), 0},
                    {second.data(), large.data(), 70000}});
  EXPECT_EQ(first, small);
  EXPECT_EQ(second, large);
  EXPECT_EQ(none[0], 7);
}

TEST(Staging, AListThatIsLongerThanExpectedComesWhole) {
  shim::plan(std::nullopt);
  GpuDevice device("host", std::make_shared<Lane>(0));
  const Dispatcher dispatcher(device);
  for (const uint32_t count : {0u, 3u, 4u, 5u, 900u}) {
    const Bytes list = counted(std::max(count, 4u), 5), other = counted(6, 9);
    Bytes found, beside;
    dispatcher.fetchCounted(CountedList<uint8_t>{&count, list.data(), 4, found},
                            FetchedList<uint8_t>{other.data(), 6, beside});
    EXPECT_EQ(found, Bytes(list.begin(), list.begin() + count));
    EXPECT_EQ(beside, other);
  }
}

TEST(Staging, WhatHangsIsALostDeviceAfterTenSeconds) {
  shim::plan(std::nullopt);
  Staging staging(nullptr);
  Bytes there(100), back(100);
  shim::plan(shim::Fault{0, {}, true});
  // Nothing waits for these.
  for (int i = 0; i < 8; ++i) staging.upload(there.data(), back.data(), back.size());
  EXPECT_NO_THROW(staging.expectAlive());
  const int64_t begin = runtime::clockNs();
  try {
    staging.upload(there.data(), back.data(), back.size());
    ADD_FAILURE() << "a ninth copy did not wait";
  } catch (const DeviceError& error) {
    EXPECT_TRUE(error.isLost());
    EXPECT_NE(std::string(error.what()).find("10 seconds"), std::string::npos) << error.what();
  }
  const int64_t waited = runtime::clockNs() - begin;
  EXPECT_GE(waited, kHangNs);
  EXPECT_LT(waited, kHangNs + kHangNs / 4);
  EXPECT_THROW(staging.expectAlive(), DeviceError);
  shim::plan(std::nullopt);
}

TEST(Staging, ADownloadThatHangsLeavesWhatWasThere) {
  shim::plan(std::nullopt);
  const int64_t before = shim::countHostAllocations();
  {
    Staging staging(nullptr);
    const Bytes there = counted(100, 9);
    Bytes back(100, 1);
    shim::plan(shim::Fault{0, {}, true});
    EXPECT_THROW(staging.download({{back.data(), there.data(), back.size()}}), DeviceError);
    EXPECT_EQ(back, Bytes(100, 1));
  }
  // The device may still write there.
  EXPECT_EQ(shim::countHostAllocations(), before + 1);
  shim::plan(std::nullopt);
}

}  // namespace
}  // namespace rg::gpu
