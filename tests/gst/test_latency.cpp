// SPDX-License-Identifier: LGPL-2.1-or-later
// mrfmerge latency=…: frames are held back, and none is lost.
#include "core/objects/objects.hpp"
#include "gst/meta/result_meta.hpp"
#include "tests/support/harness.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace rg {
namespace {

using testing::BufferPtr;
using testing::Caps;
using testing::Chain;
using testing::paint;
using testing::square;

constexpr int kHeld = 5;  // 0.2 s at 25 Hz
const std::string kStages = "bgremove ! hsvsegment ! srg ! prmmotion ! mrfmerge ";
const Caps kCaps{"GRAY8", 160, 120};

BufferPtr frame(int index) {
  return paint(kCaps, index, square(3 * index - 40, 40, 24));
}

/// What is waiting at the end of the chain.
std::vector<BufferPtr> pulled(Chain& chain) {
  std::vector<BufferPtr> buffers;
  while (GstBuffer* buffer = gst_harness_try_pull(chain.harness())) buffers.emplace_back(buffer);
  return buffers;
}

std::vector<BufferPtr> pushed(Chain& chain, int frames) {
  std::vector<BufferPtr> all;
  for (int i = 0; i < frames; ++i) {
    EXPECT_EQ(chain.push(frame(i)), GST_FLOW_OK);
    for (BufferPtr& buffer : pulled(chain)) all.push_back(std::move(buffer));
  }
  return all;
}

void expectInOrder(const std::vector<BufferPtr>& buffers) {
  for (size_t i = 0; i < buffers.size(); ++i) {
    EXPECT_EQ(GST_BUFFER_PTS(buffers[i].get()), i * 40 * GST_MSECOND);
    EXPECT_TRUE(findResult<objects::Objects>(buffers[i].get()));
  }
}

TEST(Latency, HoldsFramesBackAndSendsThemAtTheEnd) {
  Chain chain(kStages + "latency=0.2", kCaps);
  EXPECT_TRUE(pushed(chain, kHeld).empty());
  std::vector<BufferPtr> buffers = pushed(chain, 0);
  for (int i = kHeld; i < 12; ++i) {
    buffers.push_back(chain.pass(frame(i)));
    ASSERT_TRUE(buffers.back());
  }
  gst_harness_push_event(chain.harness(), gst_event_new_eos());
  for (BufferPtr& buffer : pulled(chain)) buffers.push_back(std::move(buffer));
  ASSERT_EQ(buffers.size(), 12u);
  expectInOrder(buffers);
}

TEST(Latency, IsReportedInWholeFrames) {
  for (const auto& [property, expected] :
       {std::pair{"latency=0", 10}, {"latency=0.2", 210}, {"latency=0.19", 210}}) {
    Chain chain(kStages + property, kCaps);
    gst_harness_set_upstream_latency(chain.harness(), 10 * GST_MSECOND);
    gst_harness_set_live(chain.harness(), TRUE);
    EXPECT_EQ(gst_harness_query_latency(chain.harness()),
              static_cast<GstClockTime>(expected) * GST_MSECOND)
        << property;
  }
}

/// What an upstream element is asked to allocate at least, and may at most.
std::pair<guint, guint> poolOf(Chain& chain) {
  gst_harness_add_propose_allocation_meta(chain.harness(), GST_VIDEO_META_API_TYPE, nullptr);
  GstHarness* harness = chain.harness();
  GstCaps* caps = gst_caps_from_string(chain.caps().text().c_str());
  gst_harness_set_propose_allocator(harness, nullptr, nullptr);
  GstQuery* query = gst_query_new_allocation(caps, TRUE);
  GstBufferPool* pool = gst_video_buffer_pool_new();
  gst_query_add_allocation_pool(query, pool, 1000, 2, 3);
  gst_query_add_allocation_pool(query, nullptr, 1000, 2, 0);
  gst_query_add_allocation_pool(query, nullptr, 1000, G_MAXUINT, G_MAXUINT);
  EXPECT_TRUE(gst_pad_peer_query(harness->srcpad, query));
  guint least = 0, most = 0;
  gst_query_parse_nth_allocation_pool(query, 0, nullptr, nullptr, &least, &most);
  EXPECT_EQ(most, least + 1);
  gst_query_parse_nth_allocation_pool(query, 1, nullptr, nullptr, nullptr, &most);
  EXPECT_EQ(most, 0u);
  guint whole = 0;
  gst_query_parse_nth_allocation_pool(query, 2, nullptr, nullptr, &whole, &most);
  EXPECT_EQ(whole, G_MAXUINT);
  EXPECT_EQ(most, G_MAXUINT);
  gst_query_unref(query);
  gst_object_unref(pool);
  gst_caps_unref(caps);
  return {least, most};
}

TEST(Latency, AsksPoolsForWhatIsHeldButNeverForMoreThanTheBound) {
  for (const auto& [caps, held] :
       {std::pair{Caps{"GRAY8", 160, 120, "25/1"}, 250u},
        {Caps{"GRAY8", 160, 120, "0/1"}, 0u},
        {Caps{"GRAY8", 160, 120, "90000/1"}, 600u},
        {Caps{"I420", 1920, 1080, "90000/1"}, 295u},  // 2 GiB, 3.5 bytes a pixel.
        {Caps{"I420", 7680, 4320, "2147483647/1"}, 18u}}) {
    Chain chain(kStages + "latency=10", caps);
    EXPECT_EQ(poolOf(chain).first, 2 + held) << caps.text();
  }
}

constexpr int kMostHeld = 600;

TEST(Latency, HoldsNoMoreFramesThanTheBoundAndSaysSoOnce) {
  const Caps caps{"GRAY8", 16, 16, "90000/1"};
  Chain chain(kStages + "latency=10", caps);
  for (int i = 0; i < kMostHeld + 50; ++i) {
    BufferPtr buffer = paint(caps, 0, square(i % 16 - 4, 4, 6));
    GST_BUFFER_PTS(buffer.get()) = static_cast<GstClockTime>(i) * GST_SECOND / 90000;
    ASSERT_EQ(chain.push(std::move(buffer)), GST_FLOW_OK);
  }
  EXPECT_EQ(pulled(chain).size(), 50u);
  const std::string complaint = chain.complaint(GST_MESSAGE_WARNING);
  EXPECT_NE(complaint.find("lower latency"), std::string::npos) << complaint;
  EXPECT_EQ(chain.complaint(GST_MESSAGE_WARNING), "");
  gst_harness_push_event(chain.harness(), gst_event_new_eos());
  EXPECT_EQ(pulled(chain).size(), static_cast<size_t>(kMostHeld));
}

TEST(Latency, TimesThatStandStillReleaseAsIfTheyWentOnAndAreToldOnce) {
  for (const GstClockTime pts : {GstClockTime{0}, GST_CLOCK_TIME_NONE, GstClockTime{G_MAXINT64},
                                 GstClockTime{G_MAXUINT64 - 1}})
    for (const char* framerate : {"25/1", "0/1"}) {
      const Caps caps{"GRAY8", 160, 120, framerate};
      Chain chain(kStages + "latency=0.2", caps);
      size_t out = 0;
      for (int i = 0; i < 60; ++i) {
        BufferPtr buffer = paint(caps, i, square(3 * i - 40, 40, 24));
        GST_BUFFER_PTS(buffer.get()) = pts;
        ASSERT_EQ(chain.push(std::move(buffer)), GST_FLOW_OK);
        out += pulled(chain).size();
      }
      EXPECT_EQ(out, 60u - kHeld) << pts << ' ' << framerate;
      const bool standsStill = pts <= GstClockTime{G_MAXINT64};
      EXPECT_EQ(chain.complaint(GST_MESSAGE_WARNING).find("stand still") != std::string::npos,
                standsStill);
      EXPECT_EQ(chain.complaint(GST_MESSAGE_WARNING), "");
    }
}

TEST(Latency, AFlushDropsWhatIsHeld) {
  Chain chain(kStages + "latency=0.2", kCaps);
  EXPECT_TRUE(pushed(chain, 3).empty());
  gst_harness_push_event(chain.harness(), gst_event_new_flush_start());
  gst_harness_push_event(chain.harness(), gst_event_new_flush_stop(TRUE));
  GstSegment segment;
  gst_segment_init(&segment, GST_FORMAT_TIME);
  gst_harness_push_event(chain.harness(), gst_event_new_segment(&segment));
  gst_harness_push_event(chain.harness(), gst_event_new_eos());
  EXPECT_TRUE(pulled(chain).empty());
}

TEST(Latency, OtherCapsComeAfterTheFramesBeforeThem) {
  Chain chain(kStages + "latency=0.2", kCaps);
  EXPECT_TRUE(pushed(chain, 3).empty());
  chain.setCaps({"GRAY8", 80, 60});
  const std::vector<BufferPtr> buffers = pulled(chain);
  ASSERT_EQ(buffers.size(), 3u);
  expectInOrder(buffers);
}

TEST(Latency, AJumpInTimeLosesNoFrame) {
  Chain chain(kStages + "latency=0.2", kCaps);
  EXPECT_TRUE(pushed(chain, 3).empty());
  ASSERT_EQ(chain.push(paint(kCaps, 1000, square(1, 1, 9))), GST_FLOW_OK);
  EXPECT_EQ(pulled(chain).size(), 3u);
  ASSERT_EQ(chain.push(paint(kCaps, 2, square(1, 1, 9))), GST_FLOW_OK);  // Backwards.
  EXPECT_EQ(pulled(chain).size(), 1u);
}

/// The first frame in which an object is told.
int firstTold(const std::string& property) {
  Chain chain(kStages + property, kCaps);
  std::vector<BufferPtr> buffers = pushed(chain, 60);
  gst_harness_push_event(chain.harness(), gst_event_new_eos());
  for (BufferPtr& buffer : pulled(chain)) buffers.push_back(std::move(buffer));
  EXPECT_EQ(buffers.size(), 60u);
  for (size_t i = 0; i < buffers.size(); ++i) {
    const auto objects = findResult<objects::Objects>(buffers[i].get());
    if (std::any_of(objects->objects.begin(), objects->objects.end(),
                    [](const objects::Object& object) { return objects::isListed(object.state); }))
      return static_cast<int>(i);
  }
  return -1;
}

TEST(Latency, TellsAnObjectFromWhenItCame) {
  const int without = firstTold("latency=0"), with = firstTold("latency=0.4");
  EXPECT_GT(without, 0);
  EXPECT_GT(with, 0);
  EXPECT_LE(with, without - 2);
}

}  // namespace
}  // namespace rg
