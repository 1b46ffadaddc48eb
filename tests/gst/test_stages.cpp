// SPDX-License-Identifier: LGPL-2.1-or-later
// What holds for each of the five stage elements alike.
#include "gst/meta/result_meta.hpp"
#include "tests/support/digest.hpp"
#include "tests/support/harness.hpp"

#include <gtest/gtest.h>

#include <atomic>
#include <cstring>
#include <optional>
#include <string>
#include <thread>
#include <utility>

namespace rg {
namespace {

using testing::BufferPtr;
using testing::Caps;
using testing::Chain;
using testing::paint;
using testing::square;

constexpr const char* kNames[] = {"bgremove", "hsvsegment", "srg", "prmmotion", "mrfmerge"};

/// The pipeline up to and including the n-th stage.
std::string stagesUpTo(int n) {
  std::string line = kNames[0];
  for (int i = 1; i <= n; ++i) line += std::string(" ! ") + kNames[i];
  return line;
}

/// Whether the n-th stage attached a result, and how far it can be relied on.
std::optional<Status> statusOf(GstBuffer* buffer, int n) {
  const auto status = [](const auto& result) {
    return result ? std::optional(result->status) : std::nullopt;
  };
  switch (n) {
    case 0:
      return status(findResult<background::Foreground>(buffer));
    case 1:
      return status(findResult<segmentation::Labels>(buffer));
    case 2:
      return status(findResult<graph::Graph>(buffer));
    case 3:
      return status(findResult<motion::Motion>(buffer));
    default:
      return status(findResult<objects::Objects>(buffer));
  }
}

class EveryStage : public ::testing::TestWithParam<int> {
 protected:
  [[nodiscard]] std::string line() const { return stagesUpTo(GetParam()); }
  [[nodiscard]] std::optional<Status> status(const BufferPtr& buffer) const {
    return buffer ? statusOf(buffer.get(), GetParam()) : std::nullopt;
  }
};

TEST_P(EveryStage, LeavesPixelsAndTimesAloneAndAttachesItsResult) {
  for (const char* format : testing::kAllFormats) {
    SCOPED_TRACE(format);
    const Caps caps{format, 66, 50};
    Chain chain(line(), caps);
    for (int i = 0; i < 4; ++i) {
      BufferPtr in = paint(caps, i, square(3 * i, 10, 16));
      const auto before = testing::bytesOf(in.get());
      const BufferPtr out = chain.pass(std::move(in));
      ASSERT_TRUE(out);
      EXPECT_EQ(testing::bytesOf(out.get()), before);
      EXPECT_EQ(GST_BUFFER_PTS(out.get()), static_cast<GstClockTime>(i) * 40 * GST_MSECOND);
      EXPECT_TRUE(status(out).has_value());
    }
    EXPECT_EQ(chain.complaint(GST_MESSAGE_ERROR), "");
    EXPECT_EQ(chain.complaint(GST_MESSAGE_WARNING), "");
  }
}

TEST_P(EveryStage, SharesTheMemoryOfAFrameThatOthersHold) {
  const Caps caps;
  Chain chain(line(), caps);
  const BufferPtr in = paint(caps, 0, square(5, 5, 9));
  const GstMemory* memory = gst_buffer_peek_memory(in.get(), 0);
  const BufferPtr out = chain.pass(BufferPtr(gst_buffer_ref(in.get())));
  ASSERT_TRUE(out);
  EXPECT_NE(out.get(), in.get());
  EXPECT_EQ(gst_buffer_peek_memory(out.get(), 0), memory);
  EXPECT_FALSE(statusOf(in.get(), GetParam()).has_value());
}

TEST_P(EveryStage, TakesOddAndTinySizes) {
  for (const char* format : testing::kAllFormats)
    for (const auto& [width, height] :
         {std::pair{1, 1}, {1, 37}, {41, 1}, {2, 2}, {3, 3}, {15, 17}, {127, 33}}) {
      SCOPED_TRACE(std::string(format) + " " + std::to_string(width) + "x" +
                   std::to_string(height));
      const Caps caps{format, width, height};
      Chain chain(line(), caps);
      for (int i = 0; i < 3; ++i)
        EXPECT_TRUE(status(chain.pass(paint(caps, i, square(i, i, 5)))).has_value());
      EXPECT_EQ(chain.complaint(GST_MESSAGE_ERROR), "");
    }
}

TEST_P(EveryStage, FollowsNewCapsMidStream) {
  Chain chain(line());
  int index = 0;
  for (const Caps& caps : {Caps{"GRAY8", 64, 48}, Caps{"I420", 127, 33}, Caps{"NV12", 1, 1},
                           Caps{"BGRx", 64, 48}, Caps{"BGRx", 64, 48, "5/1"}}) {
    chain.setCaps(caps);
    for (int i = 0; i < 3; ++i, ++index) {
      const BufferPtr out = chain.pass(paint(caps, index, square(4 * i, 8, 10)));
      ASSERT_TRUE(status(out).has_value()) << caps.text();
    }
  }
  EXPECT_EQ(chain.complaint(GST_MESSAGE_ERROR), "");
}

TEST_P(EveryStage, SurvivesAFlush) {
  const Caps caps;
  Chain chain(line(), caps);
  ASSERT_TRUE(chain.pass(paint(caps, 50, square(0, 0, 9))));
  gst_harness_push_event(chain.harness(), gst_event_new_flush_start());
  gst_harness_push_event(chain.harness(), gst_event_new_flush_stop(TRUE));
  GstSegment segment;
  gst_segment_init(&segment, GST_FORMAT_TIME);
  gst_harness_push_event(chain.harness(), gst_event_new_segment(&segment));
  for (int i = 0; i < 3; ++i)
    EXPECT_TRUE(status(chain.pass(paint(caps, i, square(i, 0, 9)))).has_value());
}

TEST_P(EveryStage, PassesEndOfStream) {
  const Caps caps;
  Chain chain(line(), caps);
  ASSERT_TRUE(chain.pass(paint(caps, 0, square(0, 0, 9))));
  ASSERT_TRUE(gst_harness_push_event(chain.harness(), gst_event_new_eos()));
  bool hasEnded = false;
  while (GstEvent* event = gst_harness_try_pull_event(chain.harness())) {
    hasEnded |= GST_EVENT_TYPE(event) == GST_EVENT_EOS;
    gst_event_unref(event);
  }
  EXPECT_TRUE(hasEnded);
  EXPECT_EQ(chain.push(paint(caps, 1, square(0, 0, 9))), GST_FLOW_EOS);
}

TEST_P(EveryStage, WorksWithoutTimes) {
  Caps caps;
  caps.framerate = "0/1";
  Chain chain(line(), caps);
  for (int i = 0; i < 4; ++i) {
    BufferPtr frame = paint(caps, i, square(3 * i, 8, 12));
    GST_BUFFER_PTS(frame.get()) = GST_BUFFER_DURATION(frame.get()) = GST_CLOCK_TIME_NONE;
    EXPECT_TRUE(status(chain.pass(std::move(frame))).has_value());
  }
}

TEST_P(EveryStage, SurvivesTimesThatJump) {
  const Caps caps;
  Chain chain(line(), caps);
  const GstClockTime times[] = {0,
                                GST_SECOND,
                                GST_SECOND,
                                3600 * GST_SECOND,
                                40 * GST_MSECOND,
                                10 * 365 * 86400 * GST_SECOND,
                                GST_CLOCK_TIME_NONE,
                                5};
  for (const GstClockTime time : times) {
    BufferPtr frame = paint(caps, 0, square(8, 8, 12));
    GST_BUFFER_PTS(frame.get()) = time;
    EXPECT_TRUE(status(chain.pass(std::move(frame))).has_value());
  }
}

TEST_P(EveryStage, SkipsGapAndCorruptedFrames) {
  const Caps caps;
  Chain chain(line(), caps);
  ASSERT_TRUE(chain.pass(paint(caps, 0, square(0, 0, 9))));
  for (const auto flag : {GST_BUFFER_FLAG_GAP, GST_BUFFER_FLAG_CORRUPTED}) {
    BufferPtr frame = paint(caps, 1, square(1, 0, 9));
    GST_BUFFER_FLAG_SET(frame.get(), flag);
    EXPECT_EQ(status(chain.pass(std::move(frame))), Status::Skipped);
  }
  EXPECT_EQ(chain.complaint(GST_MESSAGE_WARNING), "");
}

TEST_P(EveryStage, RestartsFromNullManyTimes) {
  const Caps caps;
  Chain chain(line(), caps);
  for (int round = 0; round < 30; ++round) {
    ASSERT_EQ(gst_element_set_state(chain.harness()->element, GST_STATE_NULL),
              GST_STATE_CHANGE_SUCCESS);
    ASSERT_NE(gst_element_set_state(chain.harness()->element, GST_STATE_PLAYING),
              GST_STATE_CHANGE_FAILURE);
    gst_harness_push_event(chain.harness(), gst_event_new_stream_start("again"));
    chain.setCaps(caps);
    GstSegment segment;
    gst_segment_init(&segment, GST_FORMAT_TIME);
    gst_harness_push_event(chain.harness(), gst_event_new_segment(&segment));
    for (int i = 0; i < 2; ++i)
      ASSERT_TRUE(status(chain.pass(paint(caps, i, square(i, 0, 9)))).has_value());
  }
}

TEST_P(EveryStage, TwoInstancesDoNotDisturbEachOther) {
  const Caps caps;
  Chain alone(line(), caps), one(line(), caps), other(line(), caps);
  for (int i = 0; i < 6; ++i) {
    const BufferPtr expected = alone.pass(paint(caps, i, square(3 * i, 4, 14)));
    const BufferPtr out = one.pass(paint(caps, i, square(3 * i, 4, 14)));
    ASSERT_TRUE(other.pass(paint(caps, i, square(40 - 5 * i, 20, 11))));
    EXPECT_EQ(status(out), status(expected));
    const auto a = findResult<background::Foreground>(out.get());
    const auto b = findResult<background::Foreground>(expected.get());
    EXPECT_EQ(testing::digestOf(*a), testing::digestOf(*b));
  }
}

TEST_P(EveryStage, PropertiesKeepTheirRangesAndValues) {
  Chain chain(line());
  GstElement* element = chain.element(kNames[GetParam()]);
  guint count = 0;
  GParamSpec** specs = g_object_class_list_properties(G_OBJECT_GET_CLASS(element), &count);
  for (guint i = 0; i < count; ++i) {
    if (specs[i]->owner_type != G_OBJECT_TYPE(element) || !(specs[i]->flags & G_PARAM_WRITABLE))
      continue;
    GValue value = G_VALUE_INIT, readBack = G_VALUE_INIT;
    g_value_init(&value, specs[i]->value_type);
    g_value_init(&readBack, specs[i]->value_type);
    g_param_value_set_default(specs[i], &value);
    g_object_get_property(G_OBJECT(element), specs[i]->name, &readBack);
    EXPECT_EQ(g_param_values_cmp(specs[i], &value, &readBack), 0) << specs[i]->name;
    EXPECT_GT(std::string(g_param_spec_get_blurb(specs[i])).size(), 20u) << specs[i]->name;
    g_value_unset(&value);
    g_value_unset(&readBack);
  }
  g_free(specs);
  gst_object_unref(element);
}

TEST_P(EveryStage, TakesNewPropertyValuesWhilePlaying) {
  const Caps caps;
  Chain chain(line(), caps);
  GstElement* element = chain.element(kNames[GetParam()]);
  std::atomic<bool> isDone = false;
  std::thread changer([&] {
    guint count = 0;
    GParamSpec** specs = g_object_class_list_properties(G_OBJECT_GET_CLASS(element), &count);
    while (!isDone)
      for (guint i = 0; i < count; ++i) {
        if (!(specs[i]->flags & GST_PARAM_MUTABLE_PLAYING)) continue;
        GValue value = G_VALUE_INIT;
        g_value_init(&value, specs[i]->value_type);
        if (G_IS_PARAM_SPEC_INT(specs[i])) g_value_set_int(&value, 1 << 28);
        if (G_IS_PARAM_SPEC_DOUBLE(specs[i])) g_value_set_double(&value, 1e30);
        if (G_IS_PARAM_SPEC_ENUM(specs[i])) g_value_set_enum(&value, 1);
        g_param_value_validate(specs[i], &value);
        g_object_set_property(G_OBJECT(element), specs[i]->name, &value);
        g_param_value_set_default(specs[i], &value);
        g_object_set_property(G_OBJECT(element), specs[i]->name, &value);
        g_object_get_property(G_OBJECT(element), specs[i]->name, &value);
        g_value_unset(&value);
      }
    g_free(specs);
  });
  for (int i = 0; i < 60; ++i)
    EXPECT_TRUE(status(chain.pass(paint(caps, i, square(i % 40, 8, 12)))).has_value());
  isDone = true;
  changer.join();
  gst_object_unref(element);
  EXPECT_EQ(chain.complaint(GST_MESSAGE_ERROR), "");
}

INSTANTIATE_TEST_SUITE_P(Stages, EveryStage, ::testing::Range(0, 5),
                         [](const auto& test) { return std::string(kNames[test.param]); });

/// Each element that needs a result, and who makes it.
class MissingUpstream : public ::testing::TestWithParam<std::pair<const char*, const char*>> {};

TEST_P(MissingUpstream, IsAnErrorThatNamesTheElementToAdd) {
  const auto& [line, producer] = GetParam();
  const Caps caps;
  Chain chain(line, caps);
  EXPECT_EQ(chain.push(paint(caps, 0, square(0, 0, 9))), GST_FLOW_ERROR);
  EXPECT_NE(chain.complaint(GST_MESSAGE_ERROR).find(std::string("add ") + producer),
            std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(Stages, MissingUpstream,
                         ::testing::Values(std::pair{"hsvsegment scope=foreground", "bgremove"},
                                           std::pair{"srg", "hsvsegment"},
                                           std::pair{"prmmotion", "srg"},
                                           std::pair{"mrfmerge", "prmmotion"}));

TEST(MissingUpstreamLater, GivesOneWarningAndSkippedResults) {
  const Caps caps;
  Chain segment("hsvsegment", caps);
  Chain graph("srg", caps);
  ASSERT_TRUE(graph.pass(segment.pass(paint(caps, 0, square(0, 0, 9)))));
  for (int i = 1; i < 4; ++i) {
    const BufferPtr out = graph.pass(paint(caps, i, square(0, 0, 9)));
    ASSERT_TRUE(out);
    EXPECT_EQ(findResult<graph::Graph>(out.get())->status, Status::Skipped);
  }
  EXPECT_NE(graph.complaint(GST_MESSAGE_WARNING).find("hsvsegment"), std::string::npos);
  EXPECT_EQ(graph.complaint(GST_MESSAGE_WARNING), "");
}

TEST(Scope, AutoIsTheForegroundBehindBgremoveAndTheFrameWithoutIt) {
  const Caps caps;
  Chain with("bgremove ! hsvsegment", caps), without("hsvsegment", caps);
  const BufferPtr a = with.pass(paint(caps, 0, square(0, 0, 9)));
  const BufferPtr b = without.pass(paint(caps, 0, square(0, 0, 9)));
  EXPECT_EQ(findResult<segmentation::Labels>(a.get())->scope, segmentation::Scope::Foreground);
  EXPECT_EQ(findResult<segmentation::Labels>(b.get())->scope, segmentation::Scope::Frame);
}

}  // namespace
}  // namespace rg
