// SPDX-License-Identifier: LGPL-2.1-or-later
// mrfmerge latency=…: frames are held back, and none is lost.
#include "core/objects.hpp"
#include "gst/meta/result_meta.hpp"
#include "tests/support/harness.hpp"

#include <gtest/gtest.h>

#include <algorithm>
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
    EXPECT_TRUE(findResult<Objects>(buffers[i].get()));
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
    const auto objects = findResult<Objects>(buffers[i].get());
    if (std::any_of(objects->objects.begin(), objects->objects.end(),
                    [](const Object& object) { return isListed(object.state); }))
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
