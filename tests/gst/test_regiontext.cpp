// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/support/written_lines.hpp"

namespace rg {
namespace {

using testing::BufferPtr;
using testing::bytesOf;
using testing::Chain;
using testing::frameWith;
using testing::linesOf;
using testing::paint;
using testing::square;

std::string textOf(GstBuffer* buffer) {
  const auto bytes = bytesOf(buffer);
  return {bytes.begin(), bytes.end()};
}

using RegionText = testing::WrittenLines;

TEST_F(RegionText, GivesTheVeryLinesThatRegionwriteWrites) {
  for (const std::string format : {"format=jsonl", "format=jsonl contours=true", "format=graph"}) {
    SCOPED_TRACE(format);
    Chain text("regiontext " + format);
    Chain file("regionwrite drop=false " + format + " location=" + path_);
    std::string all;
    for (int i = 0; i < 5; ++i) {
      const BufferPtr out = text.pass(frameWith(i, i));
      ASSERT_TRUE(out);
      ASSERT_TRUE(file.pass(frameWith(i, i)));
      EXPECT_EQ(linesOf(textOf(out.get())).size(), 1u);
      all += textOf(out.get());
    }
    EXPECT_EQ(all, written());
  }
}

TEST_F(RegionText, KeepsTheTimesOfTheFrameAndNothingOfItsPixels) {
  Chain chain("regiontext");
  BufferPtr frame = frameWith(3, 1);
  GstCaps* reference = gst_caps_new_empty_simple("timestamp/x-unix");
  gst_buffer_add_reference_timestamp_meta(frame.get(), reference, 1'700'000'000 * GST_SECOND,
                                          GST_CLOCK_TIME_NONE);
  gst_buffer_add_video_meta(frame.get(), GST_VIDEO_FRAME_FLAG_NONE, GST_VIDEO_FORMAT_BGRx, 64, 48);
  const BufferPtr out = chain.pass(std::move(frame));
  ASSERT_TRUE(out);
  EXPECT_EQ(GST_BUFFER_PTS(out.get()), 120 * GST_MSECOND);
  EXPECT_EQ(GST_BUFFER_DURATION(out.get()), 40 * GST_MSECOND);
  EXPECT_TRUE(gst_buffer_get_reference_timestamp_meta(out.get(), reference));
  EXPECT_FALSE(gst_buffer_get_video_meta(out.get()));
  EXPECT_FALSE(findResult<objects::Objects>(out.get()));
  EXPECT_NE(textOf(out.get()).find(R"("utc":"2023-11-14T)"), std::string::npos);
  gst_caps_unref(reference);
}

TEST_F(RegionText, IsJsonToWhatComesBehindIt) {
  Chain chain("regiontext");
  ASSERT_TRUE(chain.pass(frameWith(0, 1)));
  GstCaps* caps = gst_pad_get_current_caps(chain.harness()->sinkpad);
  ASSERT_TRUE(caps);
  gchar* text = gst_caps_to_string(caps);
  EXPECT_STREQ(text, "application/x-json");
  g_free(text);
  gst_caps_unref(caps);
}

TEST_F(RegionText, LeavesAFrameThatOthersHoldAsItIs) {
  Chain chain("regiontext");
  const BufferPtr frame = frameWith(0, 1);
  const auto before = bytesOf(frame.get());
  ASSERT_TRUE(chain.pass(BufferPtr(gst_buffer_ref(frame.get()))));
  EXPECT_EQ(bytesOf(frame.get()), before);
}

TEST_F(RegionText, NamesTheElementThatIsMissing) {
  Chain chain("regiontext");
  EXPECT_EQ(chain.push(paint({}, 0, square(1, 1, 5))), GST_FLOW_ERROR);
  EXPECT_NE(chain.complaint(GST_MESSAGE_ERROR).find("add mrfmerge"), std::string::npos);
}

/// Behind the stages, into sinks of GStreamer's own.
TEST_F(RegionText, FillsAFileAndAFileForEachLine) {
  const auto run = [&](const std::string& sink) {
    GstElement* pipeline = gst_parse_launch(
        ("videotestsrc num-buffers=5 ! video/x-raw,format=I420,width=64,height=48,framerate=25/1 ! "
         "regiontrack ! regiontext ! " +
         sink)
            .c_str(),
        nullptr);
    EXPECT_EQ(testing::playToEnd(pipeline), GST_MESSAGE_EOS);
    gst_object_unref(pipeline);
  };
  run("filesink location=" + path_);
  const auto lines = linesOf(written());
  ASSERT_EQ(lines.size(), 5u);
  run("multifilesink location=" + path_ + "-%d");
  for (int i = 0; i < 5; ++i)
    EXPECT_EQ(contentOf(path_ + "-" + std::to_string(i)), lines[static_cast<size_t>(i)] + "\n");
}

}  // namespace
}  // namespace rg
