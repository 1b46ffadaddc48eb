// SPDX-License-Identifier: LGPL-2.1-or-later
#include "gst/support/mask_painter.hpp"
#include "tests/support/harness.hpp"
#include "tests/support/results.hpp"

#include <gst/video/gstvideometa.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace rg {
namespace {

using testing::BufferPtr;
using testing::Caps;
using testing::Chain;
using testing::paint;
using testing::square;

constexpr Size kSize{7, 5};

template <class Payload>
BufferPtr frameWith(const Caps& caps, std::shared_ptr<const Payload> result, int index = 0) {
  BufferPtr buffer = paint(caps, index, square(0, 0, 2));
  if (result) attachResult<Payload>(buffer.get(), std::move(result));
  return buffer;
}

/// What the element's source pad negotiated.
std::string outputCaps(const Chain& chain) {
  GstPad* pad = gst_element_get_static_pad(chain.element("regionmask"), "src");
  gst_object_unref(GST_PAD_PARENT(pad));  // element() gave a reference.
  GstCaps* caps = gst_pad_get_current_caps(pad);
  gchar* text = gst_caps_to_string(caps);
  const std::string result = text;
  g_free(text);
  gst_caps_unref(caps);
  gst_object_unref(pad);
  return result;
}

/// The mask as text, a row a line: the high half of each value as a hexadecimal digit.
std::string picture(GstBuffer* buffer, Size size) {
  const auto bytes = testing::bytesOf(buffer);
  const size_t stride = bytes.size() / static_cast<size_t>(size.height);
  std::string text;
  for (size_t y = 0; y < static_cast<size_t>(size.height); ++y) {
    for (size_t x = 0; x < static_cast<size_t>(size.width); ++x)
      text += "0123456789abcdef"[bytes[y * stride + x] >> 4];
    text += '\n';
  }
  return text;
}

TEST(RegionMask, ForegroundIsWhiteAndShadowsAreNot) {
  const Caps caps{"I420", 7, 5};
  Chain chain("regionmask", caps);
  const BufferPtr out =
      chain.pass(frameWith<background::Foreground>(caps, testing::foreground(kSize, {2, 1, 3, 2})));
  ASSERT_TRUE(out);
  EXPECT_EQ(picture(out.get(), kSize),
            "0000000\n"
            "00fff00\n"
            "00fff00\n"
            "0000000\n"
            "0000000\n");
}

TEST(RegionMask, ObjectsAreWhiteWhileTheyAreSeen) {
  const Caps caps{"GRAY8", 7, 5};
  Chain chain("regionmask source=objects", caps);
  auto objects =
      testing::objects(kSize, {testing::object(1, {0, 0, 2, 1}),
                               testing::object(2, {2, 0, 2, 1}, objects::ObjectState::Stopped),
                               testing::object(3, {4, 0, 2, 1}, objects::ObjectState::Occluded),
                               testing::object(4, {0, 2, 2, 1}, objects::ObjectState::New),
                               testing::object(5, {2, 2, 2, 1}, objects::ObjectState::Lost)});
  const BufferPtr out = chain.pass(frameWith<objects::Objects>(caps, objects));
  ASSERT_TRUE(out);
  EXPECT_EQ(picture(out.get(), kSize), "ffff000\n0000000\n0000000\n0000000\n0000000\n");
}

std::shared_ptr<segmentation::Labels> labels() {
  auto result = std::make_shared<segmentation::Labels>();
  result->size = kSize;
  result->status = Status::Ok;
  result->ids.resize(kSize);
  result->ids.fill(0);
  result->ids.at(1, 0) = 0x1234;
  result->ids.at(6, 4) = 65535;
  return result;
}

TEST(RegionMask, LabelsHaveTheByteOrderThatDownstreamTakes) {
  for (const auto& [format, first] : {std::pair{"GRAY16_BE", 0x12}, {"GRAY16_LE", 0x34}}) {
    const Caps caps{"RGB", 7, 5};
    Chain chain(
        std::string("regionmask source=labels ! capsfilter caps=video/x-raw,format=") + format,
        caps);
    const BufferPtr out = chain.pass(frameWith<segmentation::Labels>(caps, labels()));
    ASSERT_TRUE(out) << format;
    const auto bytes = testing::bytesOf(out.get());
    const size_t stride = bytes.size() / 5;
    EXPECT_EQ(bytes[2], first);
    EXPECT_EQ(bytes[3], 0x46 - first);
    EXPECT_EQ(bytes[4 * stride + 12], 255);
    EXPECT_EQ(bytes[0] + bytes[1] + bytes[4], 0);
  }
}

TEST(RegionMask, PngencGetsItsBigEndian) {
  const Caps caps{"RGB", 7, 5};
  Chain chain("regionmask source=labels ! pngenc", caps);
  EXPECT_TRUE(chain.pass(frameWith<segmentation::Labels>(caps, labels())));
  EXPECT_NE(outputCaps(chain).find("GRAY16_BE"), std::string::npos);
}

TEST(RegionMask, KeepsShapeAndRateButNotTheFramesColours) {
  Chain chain("regionmask", Caps{"I420", 7, 5});
  gst_harness_set_src_caps_str(chain.harness(),
                               "video/x-raw,format=I420,width=7,height=5,framerate=30000/1001,"
                               "pixel-aspect-ratio=16/15,colorimetry=bt601,chroma-site=mpeg2");
  BufferPtr frame = frameWith<background::Foreground>(chain.caps(), testing::foreground(kSize, {}));
  GST_BUFFER_PTS(frame.get()) = 12345;
  GST_BUFFER_DURATION(frame.get()) = 67;
  const BufferPtr out = chain.pass(std::move(frame));
  ASSERT_TRUE(out);
  EXPECT_EQ(GST_BUFFER_PTS(out.get()), 12345u);
  EXPECT_EQ(GST_BUFFER_DURATION(out.get()), 67u);
  const std::string text = outputCaps(chain);
  for (const char* field : {"format=(string)GRAY8", "width=(int)7", "height=(int)5",
                            "framerate=(fraction)30000/1001", "pixel-aspect-ratio=(fraction)16/15"})
    EXPECT_NE(text.find(field), std::string::npos) << text;
  EXPECT_EQ(text.find("colorimetry"), std::string::npos) << text;
  EXPECT_EQ(text.find("chroma-site"), std::string::npos) << text;
}

TEST(RegionMask, ScalesAResultToTheFrame) {
  const Caps caps{"GRAY8", 14, 10};
  Chain chain("regionmask", caps);
  const BufferPtr out =
      chain.pass(frameWith<background::Foreground>(caps, testing::foreground(kSize, {6, 4, 1, 1})));
  ASSERT_TRUE(out);
  const std::string text = picture(out.get(), {14, 10});
  EXPECT_EQ(std::count(text.begin(), text.end(), 'f'), 4);
  EXPECT_EQ(text.substr(text.size() - 15), "000000000000ff\n");
}

TEST(RegionMask, PassesRegionMetasOnButNotThoseAboutMemory) {
  const Caps caps{"GRAY8", 7, 5};
  Chain chain("regionmask", caps);
  BufferPtr frame = frameWith<background::Foreground>(caps, testing::foreground(kSize, {}));
  attachResult<objects::Objects>(frame.get(), testing::objects(kSize, {}));
  gst_buffer_add_video_region_of_interest_meta(frame.get(), "object", 1, 1, 2, 2);
  gsize offset[GST_VIDEO_MAX_PLANES] = {};
  gint stride[GST_VIDEO_MAX_PLANES] = {8};
  gst_buffer_add_video_meta_full(frame.get(), GST_VIDEO_FRAME_FLAG_NONE, GST_VIDEO_FORMAT_GRAY8, 7,
                                 5, 1, offset, stride);
  const BufferPtr out = chain.pass(std::move(frame));
  ASSERT_TRUE(out);
  EXPECT_TRUE(findResult<background::Foreground>(out.get()));
  EXPECT_TRUE(findResult<objects::Objects>(out.get()));
  EXPECT_TRUE(gst_buffer_get_video_region_of_interest_meta_id(out.get(), 0));
  EXPECT_FALSE(gst_buffer_get_video_meta(out.get()));
}

TEST(RegionMask, ReadsNoPixels) {
  const Caps caps{"BGRx", 7, 5};
  Chain chain("regionmask", caps);
  BufferPtr frame(gst_buffer_new_allocate(nullptr, 3, nullptr));
  attachResult<background::Foreground>(frame.get(), testing::foreground(kSize, {0, 0, 7, 5}));
  const BufferPtr out = chain.pass(std::move(frame));
  ASSERT_TRUE(out);
  EXPECT_EQ(picture(out.get(), kSize).substr(0, 8), "fffffff\n");
}

TEST(RegionMask, TakesAnyFormatAndMemory) {
  for (const char* caps : {"video/x-raw,format=Y42B,width=7,height=5,framerate=0/1",
                           "video/x-raw(memory:Foreign),format=NV12,width=7,height=5"}) {
    Chain chain("regionmask", Caps{"GRAY8", 7, 5});
    gst_harness_set_src_caps_str(chain.harness(), caps);
    EXPECT_TRUE(chain.pass(
        frameWith<background::Foreground>(chain.caps(), testing::foreground(kSize, {0, 0, 7, 5}))))
        << caps;
  }
}

TEST(RegionMask, WorksOnOnePixel) {
  for (const Size size : {Size{1, 1}, Size{1, 9}, Size{9, 1}}) {
    const Caps caps{"I420", size.width, size.height};
    Chain chain("regionmask", caps);
    const BufferPtr out = chain.pass(
        frameWith<background::Foreground>(caps, testing::foreground(size, boundsOf(size))));
    ASSERT_TRUE(out);
    EXPECT_EQ(testing::bytesOf(out.get())[0], 255);
  }
}

TEST(RegionMask, NamesTheElementThatIsMissing) {
  for (const auto& [source, producer] :
       {std::pair{"foreground", "bgremove"}, {"labels", "hsvsegment"}, {"objects", "mrfmerge"}}) {
    const Caps caps{"GRAY8", 7, 5};
    Chain chain(std::string("regionmask source=") + source, caps);
    EXPECT_EQ(chain.push(frameWith<background::Foreground>(caps, nullptr)), GST_FLOW_ERROR);
    EXPECT_NE(chain.complaint(GST_MESSAGE_ERROR).find(std::string("add ") + producer),
              std::string::npos);
  }
}

TEST(RegionMask, GoesBlackWithOneWarningWhenResultsStop) {
  const Caps caps{"GRAY8", 7, 5};
  Chain chain("regionmask", caps);
  const auto white = testing::foreground(kSize, boundsOf(kSize));
  ASSERT_TRUE(chain.pass(frameWith<background::Foreground>(caps, white)));
  for (int i = 1; i < 4; ++i) {
    const BufferPtr out = chain.pass(frameWith<background::Foreground>(caps, nullptr, i));
    ASSERT_TRUE(out);
    EXPECT_EQ(picture(out.get(), kSize).substr(0, 8), "0000000\n");
  }
  EXPECT_NE(chain.complaint(GST_MESSAGE_WARNING).find("bgremove"), std::string::npos);
  EXPECT_EQ(chain.complaint(GST_MESSAGE_WARNING), "");
  const BufferPtr again = chain.pass(frameWith<background::Foreground>(caps, white, 4));
  EXPECT_EQ(picture(again.get(), kSize).substr(0, 8), "fffffff\n");
}

TEST(RegionMask, SkippedFramesAreBlack) {
  const Caps caps{"GRAY8", 7, 5};
  Chain chain("regionmask", caps);
  auto skipped = std::make_shared<background::Foreground>();
  skipped->size = kSize;
  const BufferPtr out = chain.pass(frameWith<background::Foreground>(caps, skipped));
  ASSERT_TRUE(out);
  EXPECT_EQ(picture(out.get(), kSize).find('f'), std::string::npos);
  EXPECT_EQ(chain.complaint(GST_MESSAGE_WARNING), "");
}

TEST(RegionMask, FollowsNewCaps) {
  Chain chain("regionmask", Caps{"GRAY8", 7, 5});
  for (const auto& caps : {Caps{"GRAY8", 7, 5}, Caps{"NV12", 40, 30}, Caps{"BGR", 3, 3}}) {
    chain.setCaps(caps);
    const Size size{caps.width, caps.height};
    const BufferPtr out = chain.pass(
        frameWith<background::Foreground>(caps, testing::foreground(size, boundsOf(size))));
    ASSERT_TRUE(out);
    const std::string text = picture(out.get(), size);
    EXPECT_EQ(std::count(text.begin(), text.end(), 'f'), size.area());
  }
}

TEST(RegionMask, AnotherSourceWhilePlayingDoesNotChangeWhatWasNegotiated) {
  const Caps caps{"I420", 7, 5};
  Chain chain("regionmask", caps);
  GstElement* element = chain.element("regionmask");
  const auto makeFrame = [&](int index) {
    BufferPtr frame =
        frameWith<background::Foreground>(caps, testing::foreground(kSize, {2, 1, 3, 2}), index);
    auto labels = std::make_shared<segmentation::Labels>();
    labels->size = kSize;
    labels->status = Status::Ok;
    labels->count = 65535;
    labels->ids.resize(kSize);
    labels->ids.fill(65535);
    attachResult<segmentation::Labels>(frame.get(), std::move(labels));
    return frame;
  };
  const BufferPtr before = chain.pass(makeFrame(0));
  gst_util_set_object_arg(G_OBJECT(element), "source", "labels");
  const BufferPtr after = chain.pass(makeFrame(1));
  gst_object_unref(element);
  ASSERT_TRUE(before && after);
  EXPECT_EQ(testing::bytesOf(after.get()), testing::bytesOf(before.get()));
}

/// The bytes of a black GRAY8 frame in memory that was in use before.
std::vector<uint8_t> paintedInUsedMemory(Size size, int stride) {
  GstVideoInfo info;
  gst_video_info_set_format(&info, GST_VIDEO_FORMAT_GRAY8, static_cast<guint>(size.width),
                            static_cast<guint>(size.height));
  info.stride[0] = stride;
  info.size = static_cast<gsize>(stride) * static_cast<gsize>(size.height);
  const BufferPtr to(gst_buffer_new_allocate(nullptr, info.size, nullptr));
  const BufferPtr from(gst_buffer_new());
  gst_buffer_memset(to.get(), 0, 0xa5, info.size);
  GstVideoFrame frame;
  if (!gst_video_frame_map(&frame, &info, to.get(), GST_MAP_WRITE)) return {};
  EXPECT_FALSE(paintMask(MaskSource::Foreground, from.get(), &frame));
  gst_video_frame_unmap(&frame);
  return testing::bytesOf(to.get());
}

TEST(RegionMask, LeavesNoOldMemoryBehindItsRows) {
  EXPECT_EQ(paintedInUsedMemory({7, 5}, 8), std::vector<uint8_t>(40, 0));
  const auto bytes = paintedInUsedMemory({7, 5}, 16);
  ASSERT_EQ(bytes.size(), 80U);
  for (size_t i = 0; i < bytes.size(); ++i) EXPECT_EQ(bytes[i], i % 16 < 7 ? 0 : 0xa5) << i;
}

}  // namespace
}  // namespace rg
