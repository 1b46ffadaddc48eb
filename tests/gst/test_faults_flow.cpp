// SPDX-License-Identifier: LGPL-2.1-or-later
// Events and flow returns at the wrong moment, with objects in view: new streams, flushes, the end
// of a stream, segments, late frames, lost frames, and a downstream that refuses.
#include "gst/meta/result_meta.hpp"
#include "tests/support/busy_scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <string>
#include <thread>
#include <vector>

namespace rg {
namespace {

using testing::beginStream;
using testing::BufferPtr;
using testing::busyFrame;
using testing::campaign;
using testing::Caps;
using testing::Chain;
using testing::Chance;
using testing::flush;
using testing::HarnessPtr;
using testing::objectsOn;
using testing::showObjects;
using testing::Story;
using testing::Watchdog;

const Caps kSmall{"I420", 96, 64};
const std::string kLatent = std::string(testing::kQuickStages) + " latency=0.2";

void drain(Chain& chain) {
  while (GstBuffer* out = gst_harness_try_pull(chain.harness())) gst_buffer_unref(out);
  while (GstEvent* event = gst_harness_try_pull_event(chain.harness())) gst_event_unref(event);
  while (chain.message(GST_MESSAGE_ELEMENT)) continue;
}

void pushSegment(Chain& chain, const GstSegment& segment) {
  gst_harness_push_event(chain.harness(), gst_event_new_segment(&segment));
}

class NewStream : public ::testing::TestWithParam<const char*> {};

/// A camera that comes back under another stream-id, its times from 0: nothing of before is left.
TEST_P(NewStream, TheStoryBeginsAgain) {
  Chain chain(GetParam(), kSmall), fresh(GetParam(), kSmall);
  for (int i = 0; i < 70; ++i) (void)chain.pass(busyFrame(kSmall, i));
  beginStream(chain, "another");
  Story story, expected;
  int inView = 0;
  for (int i = 0; i < 70; ++i) {
    const BufferPtr out = chain.pass(busyFrame(kSmall, i));
    ASSERT_EQ(story.tell(out.get()), expected.tell(fresh.pass(busyFrame(kSmall, i)).get()))
        << "frame " << i;
    inView += objectsOn(out.get());
  }
  EXPECT_GT(inView, 0);
}

TEST_P(NewStream, ManyLeaveNothingOnTheHeap) {
  Chance chance;
  Chain chain(GetParam(), kSmall);
  std::vector<size_t> levels;
  for (int round = 0; round < campaign(30); ++round) {
    beginStream(chain, ("stream " + std::to_string(round)).c_str());
    for (int i = chance.between(5, 12); i > 0; --i) (void)chain.pass(busyFrame(kSmall, 20 - i));
    drain(chain);
    levels.push_back(testing::heapBytes());
  }
  testing::expectPlateau(levels, size_t{64} << 10);
}

INSTANTIATE_TEST_SUITE_P(Stages, NewStream,
                         ::testing::Values(testing::kQuickStages, testing::kFrameScopeStages,
                                           testing::kDifferenceStages, testing::kPaperStages));

/// Flush-start and flush-stop in any number and order, with a segment behind them or without.
TEST(Flush, InAnyOrderTheStreamGoesOn) {
  Chance chance;
  Chain chain(kLatent, kSmall);
  int index = 0;
  for (int round = campaign(60); round > 0; --round) {
    for (int i = chance.below(10); i > 0; --i)
      ASSERT_EQ(chain.push(busyFrame(kSmall, index++)), GST_FLOW_OK);
    for (int i = chance.between(1, 3); i > 0; --i)
      gst_harness_push_event(chain.harness(), gst_event_new_flush_start());
    (void)chain.push(busyFrame(kSmall, index));
    for (int i = chance.between(1, 3); i > 0; --i)
      gst_harness_push_event(chain.harness(), gst_event_new_flush_stop(chance.isOneIn(2)));
    if (chance.isOneIn(2)) index = chance.below(50);
    if (chance.isOneIn(4)) (void)chain.push(busyFrame(kSmall, index++));
    GstSegment segment;
    gst_segment_init(&segment, GST_FORMAT_TIME);
    pushSegment(chain, segment);
    drain(chain);
  }
  EXPECT_EQ(chain.complaint(GST_MESSAGE_ERROR), "");
  EXPECT_EQ(chain.push(busyFrame(kSmall, index)), GST_FLOW_OK);
}

TEST(Flush, WhileAnotherThreadPushes) {
  const Watchdog watchdog(120);
  Chance chance;
  Chain chain(kLatent, kSmall);
  gst_harness_set_drop_buffers(chain.harness(), TRUE);
  std::atomic<bool> isDone = false;
  std::thread pusher([&] {
    for (int i = 0; !isDone; ++i) (void)chain.push(busyFrame(kSmall, i));
  });
  for (int i = campaign(200); i > 0; --i) {
    g_usleep(static_cast<gulong>(chance.below(4000)));
    flush(chain);
  }
  isDone = true;
  pusher.join();
  gst_harness_set_drop_buffers(chain.harness(), FALSE);
  flush(chain);
  for (int i = 0; i < 10; ++i) EXPECT_EQ(chain.push(busyFrame(kSmall, i)), GST_FLOW_OK);
}

/// A push, or other caps, that wait for downstream are let go by a flush; what follows is
/// processed.
TEST(Flush, ReleasesWhatDownstreamBlocks) {
  const Watchdog watchdog(120);
  for (int round = campaign(10); round > 0; --round) {
    Chain chain(testing::kQuickStages, kSmall);
    int index = 0;
    ASSERT_TRUE(showObjects(chain, index));
    const gulong probe = gst_pad_add_probe(
        chain.harness()->sinkpad,
        static_cast<GstPadProbeType>(GST_PAD_PROBE_TYPE_BLOCK | GST_PAD_PROBE_TYPE_DATA_DOWNSTREAM),
        [](GstPad*, GstPadProbeInfo*, gpointer) { return GST_PAD_PROBE_OK; }, nullptr, nullptr);
    const Caps other{"GRAY8", 64, 48};
    std::thread pusher([&] {
      if (round % 2 == 0) (void)testing::sendCaps(chain, other.text());
      (void)chain.push(busyFrame(round % 2 == 0 ? other : kSmall, index));
    });
    while (!gst_pad_is_blocking(chain.harness()->sinkpad)) g_usleep(1000);
    gst_pad_push_event(chain.harness()->srcpad, gst_event_new_flush_start());
    pusher.join();
    gst_pad_remove_probe(chain.harness()->sinkpad, probe);
    gst_pad_push_event(chain.harness()->srcpad, gst_event_new_flush_stop(TRUE));
    beginStream(chain, "after the flush");
    EXPECT_TRUE(showObjects(chain, index));
  }
}

/// Of a harness that was told nothing yet.
TEST(EndOfStream, MayComeBeforeEverything) {
  for (int told = 0; told < 3; ++told) {
    const HarnessPtr harness(gst_harness_new_parse(kLatent.c_str()));
    gst_pad_push_event(harness->srcpad, gst_event_new_stream_start("early"));
    if (told > 0) {
      GstCaps* caps = gst_caps_from_string(kSmall.text().c_str());
      gst_pad_push_event(harness->srcpad, gst_event_new_caps(caps));
      gst_caps_unref(caps);
    }
    if (told > 1) {
      GstSegment segment;
      gst_segment_init(&segment, GST_FORMAT_TIME);
      gst_pad_push_event(harness->srcpad, gst_event_new_segment(&segment));
    }
    gst_pad_push_event(harness->srcpad, gst_event_new_eos());
    EXPECT_EQ(gst_pad_push(harness->srcpad, busyFrame(kSmall, 0).release()), GST_FLOW_EOS);
    gst_pad_push_event(harness->srcpad, gst_event_new_eos());
  }
}

/// Twice, with frames behind it, and again after a flush or a new stream.
TEST(EndOfStream, EndsOnceAndTheNextStreamBegins) {
  Chance chance;
  Chain chain(kLatent, kSmall);
  int index = 0;
  for (int round = campaign(20); round > 0; --round) {
    const int frames = chance.below(20);
    for (int i = 0; i < frames; ++i) ASSERT_EQ(chain.push(busyFrame(kSmall, index++)), GST_FLOW_OK);
    gst_harness_push_event(chain.harness(), gst_event_new_eos());
    int came = 0;
    while (GstBuffer* out = gst_harness_try_pull(chain.harness())) {
      ++came;
      gst_buffer_unref(out);
    }
    EXPECT_EQ(came, frames);
    EXPECT_EQ(chain.push(busyFrame(kSmall, index)), GST_FLOW_EOS);
    gst_harness_push_event(chain.harness(), gst_event_new_eos());
    if (chance.isOneIn(2))
      flush(chain);
    else
      beginStream(chain, ("stream " + std::to_string(round)).c_str());
    drain(chain);
  }
}

/// In other formats than time, backwards, slow and fast, beginning behind the frames or nowhere.
TEST(Segments, OfEveryKindMayCome) {
  Chance chance;
  Chain chain(kLatent, kSmall);
  int index = 0;
  constexpr GstFormat kFormats[] = {GST_FORMAT_BYTES, GST_FORMAT_TIME, GST_FORMAT_DEFAULT,
                                    GST_FORMAT_BUFFERS, GST_FORMAT_PERCENT};
  constexpr double kRates[] = {1, -1, 0.1, 16, 1e-9, -1e9};
  constexpr guint64 kPlaces[] = {0, 1, GST_SECOND, G_MAXINT64, G_MAXUINT64 - 1, G_MAXUINT64};
  for (int round = campaign(60); round > 0; --round) {
    GstSegment segment;
    gst_segment_init(&segment, chance.pick(kFormats));
    segment.rate = chance.pick(kRates);
    segment.applied_rate = chance.pick(kRates);
    segment.start = chance.pick(kPlaces) % G_MAXINT64;
    segment.stop = std::max(segment.start, chance.pick(kPlaces));
    segment.base = chance.pick(kPlaces);
    segment.time = chance.pick(kPlaces);
    segment.position = chance.pick(kPlaces);
    pushSegment(chain, segment);
    for (int i = chance.below(8); i > 0; --i)
      ASSERT_EQ(chain.push(busyFrame(kSmall, index++)), GST_FLOW_OK);
    drain(chain);
  }
  GstSegment segment;
  gst_segment_init(&segment, GST_FORMAT_TIME);
  pushSegment(chain, segment);
  gst_harness_push_event(chain.harness(), gst_event_new_eos());
  EXPECT_EQ(chain.complaint(GST_MESSAGE_ERROR), "");
}

/// Takes the pipeline to a state, and waits until it is there.
void reach(GstElement* pipeline, GstState state) {
  gst_element_set_state(pipeline, state);
  EXPECT_EQ(gst_element_get_state(pipeline, nullptr, nullptr, 60 * GST_SECOND),
            GST_STATE_CHANGE_SUCCESS);
}

/// Forwards and backwards, slow and fast, flushing or not, and step by step.
TEST(Seeks, OfEveryRateComeToTheirEnd) {
  const Watchdog watchdog(240);
  Chance chance;
  constexpr double kRates[] = {1, -1, 0.1, 16, -16};
  const std::string source =
      "videotestsrc pattern=ball num-buffers=2000 ! "
      "video/x-raw,format=I420,width=96,height=64,framerate=25/1 ! ";
  GstElement* pipeline =
      gst_parse_launch((source + kLatent + " ! fakesink sync=false").c_str(), nullptr);
  ASSERT_TRUE(pipeline);
  for (int round = campaign(25); round > 0; --round) {
    reach(pipeline, chance.isOneIn(2) ? GST_STATE_PLAYING : GST_STATE_PAUSED);
    const double rate = chance.pick(kRates);
    const gint64 from = chance.below(20) * GST_SECOND, to = from + 5 * GST_SECOND;
    EXPECT_TRUE(gst_element_seek(
        pipeline, rate, GST_FORMAT_TIME,
        static_cast<GstSeekFlags>(GST_SEEK_FLAG_FLUSH | chance.below(2) * GST_SEEK_FLAG_ACCURATE),
        GST_SEEK_TYPE_SET, from, GST_SEEK_TYPE_SET, to));
    reach(pipeline, GST_STATE_PAUSED);
    gst_element_send_event(pipeline, gst_event_new_step(GST_FORMAT_BUFFERS, 1, 1.0, TRUE, FALSE));
    if (chance.isOneIn(5)) reach(pipeline, GST_STATE_READY);
  }
  GstBus* bus = gst_element_get_bus(pipeline);
  GstMessage* error = gst_bus_pop_filtered(bus, GST_MESSAGE_ERROR);
  EXPECT_FALSE(error) << (error ? GST_OBJECT_NAME(GST_MESSAGE_SRC(error)) : "");
  if (error) gst_message_unref(error);
  gst_object_unref(bus);
  gst_element_set_state(pipeline, GST_STATE_NULL);
  gst_object_unref(pipeline);
}

/// Every element drops what is late; objects that were in view still are when frames come again.
TEST(LateFrames, AreDroppedAndTheObjectsStay) {
  Chain chain(
      "bgremove training-frames=2 qos=true ! hsvsegment qos=true ! srg qos=true ! prmmotion "
      "qos=true ! mrfmerge qos=true",
      kSmall);
  int index = 0;
  ASSERT_TRUE(showObjects(chain, index));
  for (int round = campaign(10); round > 0; --round) {
    const GstClockTime now = static_cast<GstClockTime>(index) * 40 * GST_MSECOND;
    gst_harness_push_upstream_event(
        chain.harness(), gst_event_new_qos(GST_QOS_TYPE_UNDERFLOW, 2.0, 160 * GST_MSECOND, now));
    int dropped = 0;
    for (const int end = index + 4; index < end; ++index)
      dropped += !chain.pass(busyFrame(kSmall, index));
    EXPECT_GT(dropped, 0);
    gst_harness_push_upstream_event(
        chain.harness(),
        gst_event_new_qos(GST_QOS_TYPE_OVERFLOW, 0.5, -40 * GstClockTimeDiff{GST_MSECOND}, now));
    ASSERT_TRUE(showObjects(chain, index));
  }
  EXPECT_EQ(chain.complaint(GST_MESSAGE_ERROR), "");
}

/// A third of the frames is lost, some come twice: objects are in view most of the time.
TEST(LostFrames, LeaveTheObjectsInView) {
  Chance chance;
  Chain chain(testing::kQuickStages, {"GRAY8", 160, 120});
  int index = 0, frames = 0, inView = 0;
  ASSERT_TRUE(showObjects(chain, index));
  for (; index < campaign(90); ++index) {
    if (chance.isOneIn(3)) continue;
    for (int times = chance.isOneIn(10) ? 2 : 1; times > 0; --times, ++frames) {
      const BufferPtr out = chain.pass(busyFrame(chain.caps(), index));
      ASSERT_TRUE(out);
      inView += objectsOn(out.get()) > 0;
    }
  }
  EXPECT_GT(2 * inView, frames);
}

std::atomic<GstFlowReturn> answer = GST_FLOW_OK;

GstFlowReturn refuse(GstPad*, GstObject*, GstBuffer* buffer) {
  gst_buffer_unref(buffer);
  return answer;
}

/// What downstream answers comes back unchanged, and nothing else is lost by it.
TEST(Downstream, ItsAnswerReachesUpstream) {
  for (const std::string& line : {std::string(testing::kQuickStages), kLatent,
                                  std::string("regiontrack ! regionwrite location=/dev/null")}) {
    SCOPED_TRACE(line);
    Chain chain(line, kSmall);
    gst_pad_set_chain_function_full(chain.harness()->sinkpad, refuse, nullptr, nullptr);
    int index = 0;
    for (; index < 15; ++index) ASSERT_EQ(chain.push(busyFrame(kSmall, index)), GST_FLOW_OK);
    for (const GstFlowReturn flow :
         {GST_FLOW_FLUSHING, GST_FLOW_NOT_LINKED, GST_FLOW_NOT_NEGOTIATED, GST_FLOW_ERROR,
          GST_FLOW_CUSTOM_ERROR, GST_FLOW_EOS}) {
      answer = flow;
      EXPECT_EQ(chain.push(busyFrame(kSmall, index++)), flow) << gst_flow_get_name(flow);
      answer = GST_FLOW_OK;
      flush(chain);
      EXPECT_EQ(chain.push(busyFrame(kSmall, index++)), GST_FLOW_OK);
      for (int i = 0; i < 8; ++i) (void)chain.push(busyFrame(kSmall, index++));
    }
    EXPECT_EQ(chain.complaint(GST_MESSAGE_ERROR), "");
  }
}

}  // namespace
}  // namespace rg
