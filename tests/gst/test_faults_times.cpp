// SPDX-License-Identifier: LGPL-2.1-or-later
// Time stamps, durations and flags as a broken camera sends them, with objects in view.
#include "gst/meta/result_meta.hpp"
#include "tests/support/busy_scene.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace rg {
namespace {

using testing::BufferPtr;
using testing::busyFrame;
using testing::campaign;
using testing::Caps;
using testing::Chain;
using testing::Chance;
using testing::objectsOn;
using testing::showObjects;
using testing::Story;

const Caps kSmall{"I420", 96, 64};
constexpr GstClockTime kStep = 40 * GST_MSECOND;

class Times : public ::testing::TestWithParam<const char*> {};

/// A 90 kHz clock of 32 bits ends after 13:15:21.477, one of milliseconds after 49.7 days (24.8
/// with a sign), one of microseconds after 71.6 minutes. Nothing in the story depends on where it
/// begins.
TEST_P(Times, ALaterStartTellsTheSameStory) {
  constexpr GstClockTime kWrap90k = (uint64_t{1} << 32) * GST_SECOND / 90'000;
  for (const GstClockTime wrap :
       {kWrap90k, (GstClockTime{1} << 31) * GST_MSECOND, (GstClockTime{1} << 32) * GST_MSECOND,
        (GstClockTime{1} << 32) * GST_USECOND, GstClockTime{1} << 32,
        GstClockTime{G_MAXINT64} / 2}) {
    SCOPED_TRACE(wrap);
    Chain chain(GetParam(), kSmall), fresh(GetParam(), kSmall);
    Story story, expected;
    for (int i = 0; i < 24; ++i) {
      BufferPtr frame = busyFrame(kSmall, i);
      GST_BUFFER_PTS(frame.get()) += wrap - 12 * kStep;
      ASSERT_EQ(story.tell(chain.pass(std::move(frame)).get()),
                expected.tell(fresh.pass(busyFrame(kSmall, i)).get()))
          << "frame " << i;
    }
  }
}

/// Where such a clock begins again at 0, objects are soon in view again.
TEST_P(Times, AClockThatWrapsIsFollowed) {
  Chain chain(GetParam(), kSmall);
  int index = 0;
  for (int round = campaign(5); round > 0; --round) {
    const GstClockTime end = (uint64_t{1} << 32) * GST_SECOND / 90'000;
    for (int i = 0; i < 15; ++i) {
      BufferPtr frame = busyFrame(kSmall, index + i);
      GST_BUFFER_PTS(frame.get()) = end - static_cast<GstClockTime>(15 - i) * kStep;
      ASSERT_TRUE(chain.pass(std::move(frame)));
    }
    index = 0;
    ASSERT_TRUE(showObjects(chain, index));
  }
  EXPECT_EQ(chain.complaint(GST_MESSAGE_ERROR), "");
}

/// Forwards, backwards, equal, missing, at the ends of what 63 and 64 bits hold.
TEST_P(Times, MayBeAnything) {
  Chance chance;
  Chain chain(GetParam(), kSmall);
  constexpr GstClockTime kOdd[] = {0,
                                   1,
                                   GST_SECOND,
                                   GST_SECOND + 1,
                                   3600 * GST_SECOND,
                                   10ull * 365 * 86400 * GST_SECOND,
                                   G_MAXINT32,
                                   G_MAXUINT32,
                                   G_MAXINT64 - 1,
                                   G_MAXINT64,
                                   G_MAXINT64 + 1ull,
                                   G_MAXUINT64 - 1,
                                   GST_CLOCK_TIME_NONE};
  int index = 0;
  GstClockTime time = 0;
  for (int round = campaign(150); round > 0; --round) {
    const bool isJump = chance.isOneIn(4);
    time = isJump ? chance.pick(kOdd) : time + static_cast<GstClockTime>(chance.below(3)) * kStep;
    for (int i = chance.between(1, 6); i > 0; --i, time += isJump ? 0 : kStep) {
      BufferPtr frame = busyFrame(kSmall, index++);
      GST_BUFFER_PTS(frame.get()) = time;
      GST_BUFFER_DTS(frame.get()) = chance.pick(kOdd);
      GST_BUFFER_DURATION(frame.get()) = chance.pick(kOdd);
      GST_BUFFER_OFFSET(frame.get()) = chance.pick(kOdd);
      ASSERT_EQ(chain.push(std::move(frame)), GST_FLOW_OK);
    }
    while (GstBuffer* out = gst_harness_try_pull(chain.harness())) gst_buffer_unref(out);
    while (chain.message(GST_MESSAGE_ELEMENT)) continue;
  }
  testing::flush(chain);
  index = 0;
  EXPECT_TRUE(showObjects(chain, index));
  EXPECT_EQ(chain.complaint(GST_MESSAGE_ERROR), "");
}

INSTANTIATE_TEST_SUITE_P(Stages, Times,
                         ::testing::Values(testing::kQuickStages, testing::kFrameScopeStages,
                                           testing::kDifferenceStages, testing::kPaperStages));

TEST(HeldTimes, AllFramesComeInTheEndWhateverTheirTimes) {
  Chance chance;
  Chain chain(std::string(testing::kQuickStages) + " latency=0.2", kSmall);
  constexpr GstClockTime kOdd[] = {0, GST_SECOND, G_MAXINT64, G_MAXUINT64 - 1, GST_CLOCK_TIME_NONE};
  const int frames = campaign(150);
  GstClockTime time = 0;
  for (int i = 0; i < frames; ++i) {
    time = chance.isOneIn(10) ? chance.pick(kOdd) : time + kStep;
    BufferPtr frame = busyFrame(kSmall, i);
    GST_BUFFER_PTS(frame.get()) = time;
    GST_BUFFER_OFFSET(frame.get()) = static_cast<guint64>(i);
    ASSERT_EQ(chain.push(std::move(frame)), GST_FLOW_OK);
  }
  gst_harness_push_event(chain.harness(), gst_event_new_eos());
  int came = 0;
  while (const BufferPtr out{gst_harness_try_pull(chain.harness())}) {
    EXPECT_EQ(GST_BUFFER_OFFSET(out.get()), static_cast<guint64>(came));
    ++came;
  }
  EXPECT_EQ(came, frames);
}

/// Any flags, in any order, and gaps that are told by events; then objects are in view again.
TEST(Flags, MayComeInAnyOrder) {
  Chance chance;
  Chain chain(std::string(testing::kQuickStages) + " latency=0.1", kSmall);
  constexpr GstBufferFlags kFlags[] = {
      GST_BUFFER_FLAG_DISCONT,     GST_BUFFER_FLAG_GAP,        GST_BUFFER_FLAG_CORRUPTED,
      GST_BUFFER_FLAG_DROPPABLE,   GST_BUFFER_FLAG_DELTA_UNIT, GST_BUFFER_FLAG_RESYNC,
      GST_BUFFER_FLAG_DECODE_ONLY, GST_BUFFER_FLAG_LIVE,       GST_BUFFER_FLAG_HEADER};
  int sent = 0, came = 0;
  for (int index = 0; index < campaign(150); ++index, ++sent) {
    BufferPtr frame = busyFrame(kSmall, index);
    while (chance.isOneIn(2)) GST_BUFFER_FLAG_SET(frame.get(), chance.pick(kFlags));
    if (chance.isOneIn(10))
      gst_harness_push_event(chain.harness(),
                             gst_event_new_gap(GST_BUFFER_PTS(frame.get()), kStep));
    ASSERT_EQ(chain.push(std::move(frame)), GST_FLOW_OK);
  }
  gst_harness_push_event(chain.harness(), gst_event_new_eos());
  while (const BufferPtr out{gst_harness_try_pull(chain.harness())}) ++came;
  EXPECT_EQ(came, sent);
  testing::beginStream(chain, "after the flags");
  int inView = 0;
  for (int i = 0; i < 30; ++i)
    if (const BufferPtr out = chain.pass(busyFrame(kSmall, i))) inView += objectsOn(out.get());
  EXPECT_GT(inView, 0);
  EXPECT_EQ(chain.complaint(GST_MESSAGE_ERROR), "");
}

class Unusable : public ::testing::TestWithParam<const char*> {};

/// The pixels of a frame that is marked GAP or CORRUPTED change nothing: with noise in them the
/// story goes on as with the picture, and the objects stay.
TEST_P(Unusable, TheirPixelsAreNotLookedAt) {
  Chance chance;
  Chain chain(GetParam(), kSmall), other(GetParam(), kSmall);
  Story story, expected;
  int inView = 0;
  for (int i = 0; i < 40; ++i) {
    BufferPtr frame = busyFrame(kSmall, i), same = busyFrame(kSmall, i);
    if (i > 10 && chance.isOneIn(3)) {
      const auto flag = chance.isOneIn(2) ? GST_BUFFER_FLAG_GAP : GST_BUFFER_FLAG_CORRUPTED;
      gst_buffer_memset(frame.get(), 0, static_cast<guint8>(chance.below(256)),
                        gst_buffer_get_size(frame.get()));
      GST_BUFFER_FLAG_SET(frame.get(), flag);
      GST_BUFFER_FLAG_SET(same.get(), flag);
    }
    const BufferPtr out = chain.pass(std::move(frame));
    inView += objectsOn(out.get());
    ASSERT_EQ(story.tell(out.get()), expected.tell(other.pass(std::move(same)).get()))
        << "frame " << i;
  }
  EXPECT_GT(inView, 0);
}

INSTANTIATE_TEST_SUITE_P(Stages, Unusable,
                         ::testing::Values(testing::kQuickStages, testing::kFrameScopeStages,
                                           testing::kDifferenceStages, testing::kPaperStages));

}  // namespace
}  // namespace rg
