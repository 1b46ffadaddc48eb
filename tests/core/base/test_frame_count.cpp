// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/time/frame_count.hpp"

#include <gtest/gtest.h>

namespace rg {
namespace {

TEST(FrameCount, GoesOnWhereItWouldWrap) {
  FrameCount count(UINT32_MAX - 5);
  for (uint32_t i = 0; i < 12; ++i, ++count) {
    EXPECT_GE(count.value(), uint32_t{1} << 31);
    EXPECT_EQ(count.value() % 256, (UINT32_MAX - 5 + i) % 256);
  }
}

TEST(FrameCount, BeginsAtNoughtAndCounts) {
  FrameCount count;
  EXPECT_EQ(count.value(), 0u);
  ++ ++count;
  EXPECT_EQ(count.value(), 2u);
}

TEST(FrameCount, CountsUpToWhatThereIsRoomFor) {
  uint32_t count = UINT32_MAX - 1;
  countUp(count);
  EXPECT_EQ(count, UINT32_MAX);
  countUp(count);
  EXPECT_EQ(count, UINT32_MAX);
}

}  // namespace
}  // namespace rg
