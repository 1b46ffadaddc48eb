// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/support/stream_clock.hpp"
#include "tests/support/harness.hpp"

#include <gtest/gtest.h>

namespace rg {
namespace {

Tick advance(StreamClock& clock, GstClockTime pts, bool isDiscont = false) {
  const testing::BufferPtr buffer(gst_buffer_new());
  GST_BUFFER_PTS(buffer.get()) = pts;
  if (isDiscont) GST_BUFFER_FLAG_SET(buffer.get(), GST_BUFFER_FLAG_DISCONT);
  return clock.advance(buffer.get());
}

TEST(StreamClock, TheFirstFrameResetsNothing) {
  StreamClock clock;
  const Tick tick = advance(clock, 5 * GST_SECOND, true);
  EXPECT_FALSE(tick.reset);
  EXPECT_TRUE(tick.time.isKnown);
  EXPECT_EQ(tick.time.ns, int64_t{5 * GST_SECOND});
}

TEST(StreamClock, TimeRunningBackwardsIsAFlush) {
  StreamClock clock;
  (void)advance(clock, GST_SECOND);
  EXPECT_EQ(advance(clock, GST_SECOND - 1).reset, Reset::Flush);
  EXPECT_FALSE(advance(clock, GST_SECOND - 1).reset);
}

TEST(StreamClock, MoreThanASecondIsAGap) {
  StreamClock clock;
  (void)advance(clock, 0);
  EXPECT_FALSE(advance(clock, GST_SECOND).reset);
  EXPECT_EQ(advance(clock, 2 * GST_SECOND + 1).reset, Reset::Gap);
}

TEST(StreamClock, ADiscontIsAGap) {
  StreamClock clock;
  (void)advance(clock, 0);
  EXPECT_EQ(advance(clock, 40 * GST_MSECOND, true).reset, Reset::Gap);
}

TEST(StreamClock, WithoutPtsTimeComesFromTheFramerate) {
  StreamClock clock;
  clock.setFramerate(10, 1);
  EXPECT_EQ(advance(clock, GST_CLOCK_TIME_NONE).time.ns, 0);
  const Tick tick = advance(clock, GST_CLOCK_TIME_NONE);
  EXPECT_EQ(tick.time.ns, int64_t{100 * GST_MSECOND});
  EXPECT_TRUE(tick.time.isKnown);
}

TEST(StreamClock, WithNeitherTimeIsUnknownAndStillRuns) {
  StreamClock clock;
  (void)advance(clock, GST_CLOCK_TIME_NONE);
  const Tick tick = advance(clock, GST_CLOCK_TIME_NONE);
  EXPECT_FALSE(tick.time.isKnown);
  EXPECT_EQ(tick.time.ns, int64_t{40 * GST_MSECOND});
}

TEST(StreamClock, AFrameAfterARestartHasNoPredecessor) {
  StreamClock clock;
  (void)advance(clock, 100 * GST_SECOND);
  clock.restart();
  EXPECT_FALSE(advance(clock, 0).reset);
}

}  // namespace
}  // namespace rg
