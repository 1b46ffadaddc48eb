// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/text/json.hpp"
#include "gst/elements.hpp"
#include "tests/support/harness.hpp"
#include "tests/support/results.hpp"

#include <gtest/gtest.h>

#include <string_view>

namespace rg {
namespace {

using testing::BufferPtr;
using testing::Caps;
using testing::Chain;
using testing::paint;
using testing::square;

constexpr const char* kNames[] = {"bgremove", "hsvsegment", "srg", "prmmotion", "mrfmerge"};

/// What the element or elements say of a square that crosses the picture.
std::string story(const std::string& line) {
  const Caps caps{"I420", 96, 64};
  Chain chain(line, caps);
  std::string text;
  for (int i = 0; i < 40; ++i) {
    const BufferPtr out =
        chain.pass(paint(caps, i, i < 10 ? square(0, 0, 0) : square(2 * (i - 10), 20, 18)));
    const auto objects = out ? findResult<objects::Objects>(out.get()) : nullptr;
    if (!objects) return "no objects on frame " + std::to_string(i);
    text::appendJson(text, *objects, {static_cast<uint64_t>(i) + 1, {96, 64}, {}, {}},
                     text::Contours::Write);
  }
  return text;
}

TEST(RegionTrack, SaysWhatTheFiveElementsSay) {
  const std::string five = story("bgremove ! hsvsegment ! srg ! prmmotion ! mrfmerge");
  EXPECT_NE(five.find("\"id\":"), std::string::npos) << five.substr(0, 300);
  EXPECT_EQ(story("regiontrack"), five);
}

TEST(RegionTrack, DecidesByItselfWhetherTheCameraMoves) {
  GstElement* bin = gst_element_factory_make("regiontrack", nullptr);
  GstElement* alone = gst_element_factory_make("bgremove", nullptr);
  auto* spec = g_object_class_find_property(G_OBJECT_GET_CLASS(bin), "camera");
  ASSERT_TRUE(spec);
  int camera = -1, ofChild = -1, byItself = -1;
  g_object_get(bin, "camera", &camera, nullptr);
  gst_child_proxy_get(GST_CHILD_PROXY(bin), "bgremove::camera", &ofChild, nullptr);
  g_object_get(alone, "camera", &byItself, nullptr);
  EXPECT_EQ(camera, static_cast<int>(background::Camera::Auto));
  EXPECT_EQ(ofChild, camera);
  EXPECT_EQ(G_PARAM_SPEC_ENUM(spec)->default_value, camera);
  EXPECT_EQ(byItself, static_cast<int>(background::Camera::Still));
  gst_object_unref(alone);
  gst_object_unref(bin);
}

TEST(RegionTrack, HasAChildForEachElementUnderItsName) {
  GstElement* bin = gst_element_factory_make("regiontrack", nullptr);
  auto* proxy = GST_CHILD_PROXY(bin);
  EXPECT_EQ(gst_child_proxy_get_children_count(proxy), 5u);
  for (const char* name : kNames) {
    GObject* child = gst_child_proxy_get_child_by_name(proxy, name);
    ASSERT_TRUE(child) << name;
    EXPECT_STREQ(GST_OBJECT_NAME(gst_element_get_factory(GST_ELEMENT(child))), name);
    g_object_unref(child);
  }
  gst_child_proxy_set(proxy, "bgremove::threshold", 30, nullptr);
  int threshold = 0;
  gst_child_proxy_get(proxy, "bgremove::threshold", &threshold, nullptr);
  EXPECT_EQ(threshold, 30);
  gst_object_unref(bin);
}

TEST(RegionTrack, PassesThreadsToEachChild) {
  GstElement* bin = gst_element_factory_make("regiontrack", nullptr);
  g_object_set(bin, "threads", 3, nullptr);
  int threads = 0;
  g_object_get(bin, "threads", &threads, nullptr);
  EXPECT_EQ(threads, 3);
  for (const char* name : kNames) {
    gst_child_proxy_get(GST_CHILD_PROXY(bin), (std::string(name) + "::threads").c_str(), &threads,
                        nullptr);
    EXPECT_EQ(threads, 3) << name;
  }
  gst_object_unref(bin);
}

/// gst_parse_launch() of GStreamer 1.22 keeps a reference to each child that it sets, whatever the
/// bin. Gives back what the child has more of than one that was not set.
void giveBackWhatParsingKept(GstElement* bin, const char* name) {
  GstElement* child = gst_bin_get_by_name(GST_BIN(bin), name);
  GstElement* other = gst_bin_get_by_name(GST_BIN(bin), "srg");
  while (GST_OBJECT_REFCOUNT_VALUE(child) > GST_OBJECT_REFCOUNT_VALUE(other))
    gst_object_unref(child);
  gst_object_unref(child);
  gst_object_unref(other);
}

TEST(RegionTrack, SetsChildrenFromALaunchLine) {
  GError* error = nullptr;
  GstElement* pipeline = gst_parse_launch(
      "fakesrc ! regiontrack name=t bgremove::threshold=42 mrfmerge::max-lost-time=4.5 ! fakesink",
      &error);
  ASSERT_FALSE(error) << error->message;
  GstElement* bin = gst_bin_get_by_name(GST_BIN(pipeline), "t");
  int threshold = 0;
  double seconds = 0;
  auto* proxy = GST_CHILD_PROXY(bin);
  gst_child_proxy_get(proxy, "bgremove::threshold", &threshold, nullptr);
  gst_child_proxy_get(proxy, "mrfmerge::max-lost-time", &seconds, nullptr);
  EXPECT_EQ(threshold, 42);
  EXPECT_EQ(seconds, 4.5);
  giveBackWhatParsingKept(bin, "bgremove");
  giveBackWhatParsingKept(bin, "mrfmerge");
  gst_object_unref(bin);
  gst_object_unref(pipeline);
}

TEST(RegionTrack, HasTheChildrensPropertiesUnderTheirOwnNames) {
  GstElement* bin = gst_element_factory_make("regiontrack", nullptr);
  auto* proxy = GST_CHILD_PROXY(bin);
  for (const char* name : kNames) {
    SCOPED_TRACE(name);
    GObject* child = gst_child_proxy_get_child_by_name(proxy, name);
    guint count = 0;
    GParamSpec** specs = g_object_class_list_properties(G_OBJECT_GET_CLASS(child), &count);
    for (guint i = 0; i < count; ++i) {
      if (specs[i]->owner_type != G_OBJECT_TYPE(child) || !(specs[i]->flags & G_PARAM_WRITABLE))
        continue;
      const GParamSpec* own = g_object_class_find_property(G_OBJECT_GET_CLASS(bin), specs[i]->name);
      ASSERT_TRUE(own) << specs[i]->name;
      // Three children choose a method, each of its own kind: the bin's is the first one's.
      const bool isFirst = std::string_view(name) == "bgremove";
      const bool isOther = std::string_view(specs[i]->name) == "method" && !isFirst;
      EXPECT_EQ(own->value_type != specs[i]->value_type, isOther) << specs[i]->name;
    }
    g_free(specs);
    g_object_unref(child);
  }
  g_object_set(bin, "threshold", 30, "max-lost-time", 4.5, "object-hue", "350-10", nullptr);
  int threshold = 0;
  double seconds = 0;
  gst_child_proxy_get(proxy, "bgremove::threshold", &threshold, "mrfmerge::max-lost-time", &seconds,
                      nullptr);
  EXPECT_EQ(threshold, 30);
  EXPECT_EQ(seconds, 4.5);
  gst_child_proxy_set(proxy, "hsvsegment::object-hue", "80-160", nullptr);
  gchar* hue = nullptr;
  g_object_get(bin, "object-hue", &hue, nullptr);
  EXPECT_STREQ(hue, "80-160");
  g_free(hue);
  gst_object_unref(bin);
}

TEST(RegionTrack, NeedsNoRegistry) {
  auto* bin = GST_ELEMENT(g_object_new(gst_region_track_get_type(), nullptr));
  gst_object_ref_sink(bin);
  EXPECT_EQ(GST_BIN_NUMCHILDREN(bin), 5);
  for (const char* name : {"sink", "src"}) {
    GstPad* pad = gst_element_get_static_pad(bin, name);
    EXPECT_TRUE(pad);
    gst_object_unref(pad);
  }
  gst_object_unref(bin);
}

TEST(RegionTrack, StartsAndStopsManyTimes) {
  GstElement* bin = gst_element_factory_make("regiontrack", nullptr);
  for (int i = 0; i < 20; ++i) {
    EXPECT_EQ(gst_element_set_state(bin, GST_STATE_PLAYING), GST_STATE_CHANGE_SUCCESS);
    EXPECT_EQ(gst_element_set_state(bin, GST_STATE_NULL), GST_STATE_CHANGE_SUCCESS);
  }
  gst_object_unref(bin);
}

}  // namespace
}  // namespace rg
