// SPDX-License-Identifier: LGPL-2.1-or-later
// What elements say of mistakes: where metas were lost, stages in the wrong order, properties that
// are refused or belong to nobody.
#include "tests/support/busy_scene.hpp"
#include "tests/support/written_lines.hpp"

#include <gtest/gtest.h>

namespace rg {
namespace {

using testing::BusPtr;
using testing::busyFrame;
using testing::Caps;
using testing::Chain;
using testing::frameWith;
using testing::kQuickStages;
using testing::MessagePtr;

std::string textOf(GstMessage* message) {
  GError* error = nullptr;
  if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_ERROR)
    gst_message_parse_error(message, &error, nullptr);
  else
    gst_message_parse_warning(message, &error, nullptr);
  const std::string text = error->message;
  g_error_free(error);
  return text;
}

struct PipelineEnd {
  void operator()(GstElement* pipeline) const {
    gst_element_set_state(pipeline, GST_STATE_NULL);
    gst_object_unref(pipeline);
  }
};
using Pipeline = std::unique_ptr<GstElement, PipelineEnd>;

Pipeline parse(const std::string& line) {
  GError* error = nullptr;
  GstElement* pipeline = gst_parse_launch(line.c_str(), &error);
  EXPECT_FALSE(error) << error->message;
  g_clear_error(&error);
  return Pipeline(pipeline);
}

/// The first error or warning of a pipeline; "end" where it comes to its end without one.
std::string verdict(GstElement* pipeline) {
  gst_element_set_state(pipeline, GST_STATE_PLAYING);
  const BusPtr bus(gst_element_get_bus(pipeline));
  const MessagePtr message(gst_bus_timed_pop_filtered(
      bus.get(), GST_CLOCK_TIME_NONE,
      static_cast<GstMessageType>(GST_MESSAGE_ERROR | GST_MESSAGE_WARNING | GST_MESSAGE_EOS)));
  return GST_MESSAGE_TYPE(message.get()) == GST_MESSAGE_EOS ? "end" : textOf(message.get());
}

std::string verdictOf(const std::string& line) {
  const Pipeline pipeline =
      parse("videotestsrc num-buffers=3 ! video/x-raw,format=I420,width=96,height=64 ! " + line +
            " ! fakesink");
  return verdict(pipeline.get());
}

TEST(LostResults, AreToldWithTheElementThatLostThem) {
  const std::string write = " ! regionwrite location=/dev/null";
  EXPECT_EQ(verdictOf("regiontrack ! videocrop name=crop left=10" + write + " name=w"),
            "The results of mrfmerge were lost after mrfmerge, at crop, which makes new frames "
            "without them: put it in front of the first stage, or behind w.");
  EXPECT_NE(verdictOf("regiontrack ! videoflip name=flip video-direction=vert ! regiontext")
                .find("lost after mrfmerge, at flip,"),
            std::string::npos);
  EXPECT_NE(verdictOf("bgremove name=b ! queue ! videobox name=box left=10 ! identity ! "
                      "regionmask source=foreground")
                .find("results of bgremove were lost after b, at box,"),
            std::string::npos);
  EXPECT_EQ(verdictOf("bgremove ! queue ! videocrop left=10 ! identity ! regionmask"), "end");
  EXPECT_NE(verdictOf("hsvsegment ! srg name=s ! videocrop name=one left=2 ! videoflip name=two "
                      "video-direction=vert ! prmmotion")
                .find("lost after s, at one or two,"),
            std::string::npos);
  EXPECT_EQ(verdictOf("regiontrack ! videoscale ! videoconvert ! video/x-raw,width=48" + write),
            "end");
}

TEST(LostResults, OfAnElementThatIsNotThereAreMissing) {
  EXPECT_NE(verdictOf("hsvsegment ! videocrop left=10 ! regionwrite location=/dev/null")
                .find("add mrfmerge to the pipeline"),
            std::string::npos);
}

TEST(StageOrder, ThatIsWrongIsToldOnce) {
  for (const char* line : {"hsvsegment ! bgremove ! srg ! prmmotion ! mrfmerge",
                           "hsvsegment ! srg ! hsvsegment", "regiontrack ! bgremove"}) {
    SCOPED_TRACE(line);
    Chain chain(line, {"I420", 96, 64});
    for (int i = 0; i < 3; ++i) (void)chain.pass(busyFrame(chain.caps(), i));
    EXPECT_NE(chain.complaint(GST_MESSAGE_WARNING).find("in the order bgremove, hsvsegment, srg,"),
              std::string::npos);
    EXPECT_EQ(chain.complaint(GST_MESSAGE_WARNING), "");
  }
}

TEST(StageOrder, BehindMrfmergeIsTooLate) {
  EXPECT_NE(verdictOf("regiontrack ! srg").find("put this stage before mrfmerge"),
            std::string::npos);
}

TEST(StageOrder, ThatIsRightIsNoWarning) {
  EXPECT_EQ(verdictOf(std::string(kQuickStages)), "end");
  EXPECT_EQ(verdictOf(testing::kFrameScopeStages), "end");
  EXPECT_EQ(verdictOf("regiontrack"), "end");
}

TEST(UnknownChildren, AreAnErrorWhenTheBinStarts) {
  EXPECT_EQ(
      verdictOf("regiontrack brgemove::threshold=1"),
      "There is no child \"brgemove\" whose property could be set: the children are bgremove, "
      "hsvsegment, srg, prmmotion and mrfmerge.");
}

/// A value that is not the property's, as text.
const char* otherValue(GObject* object, const GParamSpec* spec) {
  if (G_IS_PARAM_SPEC_STRING(spec)) return "/dev/zero";
  GValue value = G_VALUE_INIT, number = G_VALUE_INIT;
  g_value_init(&number, G_TYPE_INT);
  g_object_get_property(object, spec->name, &value);
  g_value_transform(&value, &number);
  const bool isOne = g_value_get_int(&number) == 1;
  g_value_unset(&value);
  if (isOne) return G_IS_PARAM_SPEC_ENUM(spec) || G_IS_PARAM_SPEC_BOOLEAN(spec) ? "0" : "2";
  return "1";
}

std::string valueOf(GObject* object, const char* property) {
  GValue value = G_VALUE_INIT, text = G_VALUE_INIT;
  g_value_init(&text, G_TYPE_STRING);
  g_object_get_property(object, property, &value);
  g_value_transform(&value, &text);
  const std::string result = g_value_get_string(&text) ? g_value_get_string(&text) : "";
  g_value_unset(&value);
  g_value_unset(&text);
  return result;
}

/// Expects that what may only change before the start is refused behind it, with its name.
int expectRefusals(GstElement* element, GstBus* bus) {
  int refused = 0;
  guint count = 0;
  GParamSpec** specs = g_object_class_list_properties(G_OBJECT_GET_CLASS(element), &count);
  for (guint i = 0; i < count; ++i) {
    const GParamSpec* spec = specs[i];
    if (spec->owner_type != G_OBJECT_TYPE(element) || !(spec->flags & G_PARAM_WRITABLE) ||
        !(spec->flags & GST_PARAM_MUTABLE_READY))
      continue;
    SCOPED_TRACE(spec->name);
    const std::string before = valueOf(G_OBJECT(element), spec->name);
    gst_util_set_object_arg(G_OBJECT(element), spec->name, otherValue(G_OBJECT(element), spec));
    EXPECT_EQ(valueOf(G_OBJECT(element), spec->name), before);
    const MessagePtr message(gst_bus_pop_filtered(bus, GST_MESSAGE_WARNING));
    EXPECT_TRUE(message);
    if (!message) continue;
    EXPECT_EQ(textOf(message.get()), std::string(spec->name) +
                                         " stays as it was: it can change in the states NULL and "
                                         "READY only.");
    ++refused;
  }
  g_free(specs);
  return refused;
}

TEST(FixedProperties, RefuseWhileTheElementRunsAndReadWhatIsInForce) {
  for (const auto& [name, fixed] : {std::pair{"bgremove", 1},
                                    {"hsvsegment", 1},
                                    {"srg", 1},
                                    {"prmmotion", 1},
                                    {"mrfmerge", 2},
                                    {"regionmask", 1},
                                    {"regionwrite", 6},
                                    {"regiontrack", 2}}) {
    SCOPED_TRACE(name);
    GstElement* element = gst_element_factory_make(name, nullptr);
    gst_object_ref_sink(element);
    const BusPtr bus(gst_bus_new());
    gst_element_set_bus(element, bus.get());
    if (std::string(name) == "regionwrite") g_object_set(element, "location", "/dev/null", nullptr);
    ASSERT_EQ(gst_element_set_state(element, GST_STATE_PAUSED), GST_STATE_CHANGE_SUCCESS);
    EXPECT_GE(expectRefusals(element, bus.get()), fixed);
    gst_element_set_state(element, GST_STATE_READY);
    if (g_object_class_find_property(G_OBJECT_GET_CLASS(element), "threads")) {
      g_object_set(element, "threads", 3, nullptr);
      EXPECT_EQ(valueOf(G_OBJECT(element), "threads"), "3");
    }
    gst_element_set_state(element, GST_STATE_NULL);
    gst_element_set_bus(element, nullptr);
    gst_object_unref(element);
  }
}

TEST(RejectedTexts, ReadAsTheOneInUse) {
  struct Text {
    const char *element, *property, *good, *bad;
  };
  for (const Text& text : {Text{"bgremove", "areas-of-interest", "0,0 1,0 1,1 0,1", "0,0 nonsense"},
                           Text{"bgremove", "mask", "", "/nowhere.png"},
                           Text{"hsvsegment", "background-hue", "80-160", "green"},
                           Text{"hsvsegment", "object-hue", "350-10", "red"}}) {
    SCOPED_TRACE(text.property);
    Chain chain(kQuickStages, {"I420", 96, 64});
    GstElement* element = chain.element(text.element);
    int index = 0;
    for (const char* value : {text.good, text.bad}) {
      g_object_set(element, text.property, value, nullptr);
      EXPECT_EQ(chain.push(busyFrame(chain.caps(), index++)), GST_FLOW_OK);
      EXPECT_EQ(valueOf(G_OBJECT(element), text.property), text.good);
    }
    EXPECT_NE(chain.complaint(GST_MESSAGE_WARNING).find("what was set before stays in use"),
              std::string::npos);
    EXPECT_EQ(chain.push(busyFrame(chain.caps(), index++)), GST_FLOW_OK);
    EXPECT_EQ(chain.complaint(GST_MESSAGE_WARNING), "");
    gst_object_unref(element);
  }
}

}  // namespace
}  // namespace rg
