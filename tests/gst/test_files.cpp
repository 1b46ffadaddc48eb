// SPDX-License-Identifier: LGPL-2.1-or-later
// Each element on files that are encoded and decoded here.
#include <gst/gst.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <string>
#include <unistd.h>
#include <utility>

namespace rg {
namespace {

/// Runs a launch line to its end; empty, or what went wrong.
std::string run(const std::string& line) {
  GError* error = nullptr;
  GstElement* pipeline = gst_parse_launch(line.c_str(), &error);
  if (error) {
    const std::string text = error->message;
    g_clear_error(&error);
    if (pipeline) gst_object_unref(pipeline);
    return text;
  }
  gst_element_set_state(pipeline, GST_STATE_PLAYING);
  GstBus* bus = gst_element_get_bus(pipeline);
  GstMessage* message = gst_bus_timed_pop_filtered(
      bus, 60 * GST_SECOND, static_cast<GstMessageType>(GST_MESSAGE_ERROR | GST_MESSAGE_EOS));
  std::string text;
  if (!message) {
    text = "nothing happened for a minute";
  } else if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_ERROR) {
    gst_message_parse_error(message, &error, nullptr);
    text = error->message;
    g_clear_error(&error);
  }
  if (message) gst_message_unref(message);
  gst_object_unref(bus);
  gst_element_set_state(pipeline, GST_STATE_NULL);
  gst_object_unref(pipeline);
  return text;
}

class File : public ::testing::TestWithParam<std::pair<const char*, const char*>> {
 protected:
  void SetUp() override {
    char name[] = "/tmp/regiongraph-clip-XXXXXX";
    const int descriptor = mkstemp(name);
    ASSERT_GE(descriptor, 0);
    close(descriptor);
    path_ = name;
    const auto& [encoder, muxer] = GetParam();
    ASSERT_EQ(run("videotestsrc pattern=ball num-buffers=25 ! "
                  "video/x-raw,width=160,height=120,framerate=25/1 ! videoconvert ! " +
                  std::string(encoder) + " ! " + muxer + " ! filesink location=" + path_),
              "");
  }
  void TearDown() override { std::remove(path_.c_str()); }

  std::string path_;
};

TEST_P(File, PassesEveryPrefixOfThePipeline) {
  const std::string read = "filesrc location=" + path_ + " ! decodebin ! videoconvert ! ";
  for (const char* line :
       {"bgremove", "bgremove ! hsvsegment", "hsvsegment", "bgremove ! hsvsegment ! srg",
        "bgremove ! hsvsegment ! srg ! prmmotion",
        "bgremove ! hsvsegment ! srg ! prmmotion ! mrfmerge",
        "hsvsegment ! srg ! prmmotion ! mrfmerge", "queue ! bgremove ! queue ! hsvsegment ! queue"})
    EXPECT_EQ(run(read + line + " ! fakesink"), "") << line;
}

INSTANTIATE_TEST_SUITE_P(Codecs, File,
                         ::testing::Values(std::pair{"jpegenc", "avimux"},
                                           std::pair{"vp8enc deadline=1", "webmmux"},
                                           std::pair{"theoraenc", "oggmux"}));

}  // namespace
}  // namespace rg
