// SPDX-License-Identifier: LGPL-2.1-or-later
// Segments, times and metas that no well-behaved source sends, with a thing that moves in view.
// A critical message of GLib fails any test here.
#include "core/objects/objects.hpp"
#include "gst/meta/result_meta.hpp"
#include "gst/support/foreign_enum.hpp"
#include "tests/support/harness.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <vector>

namespace rg {
namespace {

using testing::BufferPtr;
using testing::Caps;
using testing::Chain;
using testing::paint;
using testing::square;

const std::string kStages = "bgremove ! hsvsegment ! srg ! prmmotion ! mrfmerge ";
const Caps kCaps{"I420", 80, 48};

/// The elements that each test runs through: all nine, and what they do with time.
std::vector<std::string> lines() {
  std::vector<std::string> all{kStages + "! regionwrite location=/dev/null ! regionmask",
                               "bgremove method=frame-difference ! hsvsegment ! srg ! prmmotion ! "
                               "mrfmerge latency=0.2 ! regionmask source=objects",
                               "regiontrack ! regionmask source=labels"};
#ifdef REGIONGRAPH_HAS_OVERLAY
  all.push_back(kStages + "! regionoverlay graph=true contours=true background=black");
  all.emplace_back("hsvsegment ! srg ! prmmotion ! regionoverlay vectors=true");
#endif
  return all;
}

BufferPtr frameAt(const Caps& caps, int index, GstClockTime pts) {
  BufferPtr buffer = paint(caps, index, square(3 * index - 30, 14, 20));
  GST_BUFFER_PTS(buffer.get()) = pts;
  return buffer;
}

/// A segment whose format may be a number that is none of the enum's values.
void sendSegment(const Chain& chain, int format) {
  GstSegment segment;
  gst_segment_init(&segment, GST_FORMAT_BYTES);
  std::memcpy(&segment.format, &format, sizeof format);
  gst_harness_push_event(chain.harness(), gst_event_new_segment(&segment));
}

TEST(HostileSegment, NeedsNoTimes) {
  int own = 0;
  for (int i = 0; i < 4; ++i)
    own = numberIn(gst_format_register(("regiongraph-" + std::to_string(i)).c_str(), "For a test"));
  for (const int format : {int{GST_FORMAT_BYTES}, int{GST_FORMAT_DEFAULT}, own})
    for (const std::string& line : lines()) {
      SCOPED_TRACE(line);
      Chain chain(line, kCaps);
      sendSegment(chain, format);
      for (int i = 0; i < 30; ++i)
        ASSERT_EQ(chain.push(frameAt(kCaps, i, static_cast<GstClockTime>(i) * 40 * GST_MSECOND)),
                  GST_FLOW_OK);
    }
}

TEST(HostileSegment, MayRunBackwardsOrFarAway) {
  for (const double rate : {-1.0, 1000.0, 1e-6})
    for (const std::string& line : lines()) {
      SCOPED_TRACE(line);
      Chain chain(line, kCaps);
      GstSegment segment;
      gst_segment_init(&segment, GST_FORMAT_TIME);
      segment.rate = segment.applied_rate = rate;
      segment.start = GST_SECOND;
      segment.stop = G_MAXUINT64 - 2;
      segment.time = segment.base = G_MAXUINT64 - 1;
      gst_harness_push_event(chain.harness(), gst_event_new_segment(&segment));
      for (int i = 0; i < 10; ++i)
        ASSERT_EQ(chain.push(frameAt(kCaps, i, static_cast<GstClockTime>(i) * 200 * GST_MSECOND)),
                  GST_FLOW_OK);
    }
}

/// Times of a stream, by the number of the frame.
struct Times {
  const char* name;
  GstClockTime (*at)(guint64 index);
};
constexpr GstClockTime kFrame = 40 * GST_MSECOND;
constexpr Times kTimes[] = {
    {"0", [](guint64) -> GstClockTime { return 0; }},
    {"none", [](guint64) { return GST_CLOCK_TIME_NONE; }},
    {"the last signed one", [](guint64) -> GstClockTime { return G_MAXINT64; }},
    {"up to the last signed one and beyond",
     [](guint64 i) -> GstClockTime { return G_MAXINT64 - 20 * kFrame + i * kFrame; }},
    {"the last signed one, then none",
     [](guint64 i) { return i < 20 ? G_MAXINT64 - 1 : GST_CLOCK_TIME_NONE; }},
    {"the last one", [](guint64) -> GstClockTime { return G_MAXUINT64 - 1; }},
    {"from end to end", [](guint64 i) -> GstClockTime { return i % 2 == 0 ? 0 : G_MAXINT64; }},
    {"one jump to the end",
     [](guint64 i) -> GstClockTime { return i < 20 ? i * kFrame : G_MAXINT64 - 9 + i % 10; }},
    {"backwards", [](guint64 i) { return (100 - i) * kFrame; }},
    {"a nanosecond apart", [](guint64 i) -> GstClockTime { return i; }},
    {"years apart", [](guint64 i) -> GstClockTime { return i * (G_MAXINT64 / 50); }}};

void expectToPass(const Times& times, const char* framerate) {
  for (const std::string& line : lines()) {
    SCOPED_TRACE(std::string(times.name) + ", " + framerate + ": " + line);
    Caps caps = kCaps;
    caps.framerate = framerate;
    Chain chain(line, caps);
    for (int i = 0; i < 30; ++i)
      ASSERT_EQ(chain.push(frameAt(caps, i, times.at(static_cast<guint64>(i)))), GST_FLOW_OK);
    EXPECT_EQ(chain.complaint(GST_MESSAGE_ERROR), "");
  }
}

TEST(HostileTimes, PassWithAThingThatMoves) {
  for (const Times& times : kTimes) expectToPass(times, "25/1");
}

TEST(HostileTimes, PassAtAnyRate) {
  for (const char* framerate : {"0/1", "2147483647/1", "1/2147483647"})
    expectToPass(kTimes[4], framerate);
}

/// How many frames of a chain tell an object that is seen.
int framesWithObjects(Chain& chain, const Times& times) {
  int count = 0;
  for (int i = 0; i < 40; ++i) {
    const BufferPtr out = chain.pass(frameAt(kCaps, i, times.at(static_cast<guint64>(i))));
    const auto objects = out ? findResult<objects::Objects>(out.get()) : nullptr;
    count +=
        objects && std::any_of(objects->objects.begin(), objects->objects.end(),
                               [](const objects::Object& o) { return objects::isListed(o.state); })
            ? 1
            : 0;
  }
  return count;
}

TEST(HostileTimes, AreFollowedWhereTheyStandStill) {
  for (const Times& times : {kTimes[0], kTimes[1], kTimes[2], kTimes[4], kTimes[5]}) {
    Chain chain(kStages, kCaps);
    EXPECT_GT(framesWithObjects(chain, times), 20) << times.name;
  }
}

TEST(HostileMetas, AReferenceTimeWithoutAReferenceIsNoTime) {
  Chain chain(kStages + "! regionwrite location=/dev/null", kCaps);
  BufferPtr buffer = frameAt(kCaps, 0, 0);
  gst_buffer_add_meta(buffer.get(), GST_REFERENCE_TIMESTAMP_META_INFO, nullptr);
  // The harness frees the meta, which takes a reference for granted: it gets one afterwards.
  BufferPtr out = chain.pass(std::move(buffer));
  ASSERT_TRUE(out);
  gst_buffer_get_reference_timestamp_meta(out.get(), nullptr)->reference = gst_caps_new_any();
}

TEST(HostileMetas, AResultAddedByItsNameOnlySaysWhatASkippedFrameSays) {
  const BufferPtr buffer(gst_buffer_new());
  const auto add = [&](const GstMetaInfo* info) {
    return gst_buffer_add_meta(buffer.get(), info, nullptr);
  };
  auto* foreground =
      reinterpret_cast<GstRegionForegroundMeta*>(add(metaInfo<background::Foreground>()));
  auto* labels = reinterpret_cast<GstRegionLabelsMeta*>(add(metaInfo<segmentation::Labels>()));
  auto* objects = reinterpret_cast<GstRegionObjectsMeta*>(add(metaInfo<objects::Objects>()));
  EXPECT_EQ(gst_region_foreground_meta_get_status(foreground, nullptr, nullptr),
            GST_REGION_STATUS_SKIPPED);
  GstRegionPlane plane;
  EXPECT_FALSE(gst_region_foreground_meta_map(foreground, &plane, nullptr));
  EXPECT_FALSE(gst_region_labels_meta_map(labels, &plane, nullptr));
  EXPECT_EQ(gst_region_objects_meta_get_n_objects(objects), 0u);
}

}  // namespace
}  // namespace rg
