// SPDX-License-Identifier: LGPL-2.1-or-later
#include "tests/support/harness.hpp"
#include "tests/support/results.hpp"

#include <gst/video/video.h>
#include <gtest/gtest.h>

#include <cstring>
#include <string>

namespace rg {
namespace {

using testing::BufferPtr;
using testing::Caps;
using testing::Chain;
using testing::object;
using testing::objects;
using testing::paint;

constexpr uint8_t kGrey = 90;
constexpr Size kSize{320, 240};
constexpr Box kBox{100, 60, 80, 120};

BufferPtr greyFrame(const Caps& caps, int index = 0) {
  return paint(caps, index, [](int, int) { return kGrey; });
}

BufferPtr frameWith(const Caps& caps, std::shared_ptr<const objects::Objects> result,
                    int index = 0) {
  BufferPtr buffer = greyFrame(caps, index);
  if (result) attachResult<objects::Objects>(buffer.get(), std::move(result));
  return buffer;
}

auto oneObject() {
  return objects(kSize, {object(5, kBox)});
}

/// Level, or luma, or the first channel of pixel (x, y).
uint8_t pixel(GstBuffer* buffer, const Caps& caps, int x, int y, int component = 0) {
  const GstVideoInfo info = caps.info();
  GstVideoFrame frame;
  if (!gst_video_frame_map(&frame, &info, buffer, GST_MAP_READ)) return 0;
  const auto at = static_cast<guint>(component);
  const uint8_t* data = testing::firstSample(frame, at);
  const bool isWord = GST_VIDEO_FORMAT_INFO_DEPTH(info.finfo, at) > 8;
  const auto shiftX = static_cast<int>(GST_VIDEO_FORMAT_INFO_W_SUB(info.finfo, component));
  const auto shiftY = static_cast<int>(GST_VIDEO_FORMAT_INFO_H_SUB(info.finfo, component));
  const uint8_t* sample = data + (y >> shiftY) * GST_VIDEO_FRAME_COMP_STRIDE(&frame, component) +
                          (x >> shiftX) * GST_VIDEO_FRAME_COMP_PSTRIDE(&frame, component);
  const int word = isWord ? sample[0] | sample[1] << 8 : sample[0];
  const auto value = static_cast<uint8_t>(word >> GST_VIDEO_FORMAT_INFO_SHIFT(info.finfo, at) >>
                                          (GST_VIDEO_FORMAT_INFO_DEPTH(info.finfo, at) - 8));
  gst_video_frame_unmap(&frame);
  return value;
}

/// The part of the frame that the drawing changed.
Box changed(GstBuffer* buffer, const Caps& caps) {
  Box box;
  for (int y = 0; y < caps.height; ++y)
    for (int x = 0; x < caps.width; ++x)
      if (pixel(buffer, caps, x, y) != kGrey) box = unite(box, {x, y, 1, 1});
  return box;
}

TEST(RegionOverlay, BlendsIntoEveryFormat) {
  for (const char* format : testing::kAllFormats) {
    SCOPED_TRACE(format);
    const Caps caps{format, kSize.width, kSize.height};
    Chain chain("regionoverlay", caps);
    const BufferPtr out = chain.pass(frameWith(caps, oneObject()));
    ASSERT_TRUE(out);
    EXPECT_NE(pixel(out.get(), caps, kBox.x, kBox.y + 20), kGrey);
    EXPECT_NE(pixel(out.get(), caps, kBox.right() - 1, kBox.bottom() - 20), kGrey);
    EXPECT_EQ(pixel(out.get(), caps, kBox.x + 20, kBox.y + 30), kGrey);
    EXPECT_EQ(pixel(out.get(), caps, 20, 200), kGrey);
    EXPECT_FALSE(gst_buffer_get_video_overlay_composition_meta(out.get()));
  }
}

TEST(RegionOverlay, AttachesWhereDownstreamDrawsByItself) {
  const Caps caps{"NV12", kSize.width, kSize.height};
  Chain chain("regionoverlay", caps);
  gst_harness_add_propose_allocation_meta(chain.harness(),
                                          GST_VIDEO_OVERLAY_COMPOSITION_META_API_TYPE, nullptr);
  ASSERT_TRUE(gst_harness_push_upstream_event(chain.harness(), gst_event_new_reconfigure()));
  BufferPtr in = frameWith(caps, oneObject());
  const auto before = testing::bytesOf(in.get());
  const BufferPtr out = chain.pass(std::move(in));
  ASSERT_TRUE(out);
  EXPECT_EQ(testing::bytesOf(out.get()), before);
  const auto* meta = gst_buffer_get_video_overlay_composition_meta(out.get());
  ASSERT_TRUE(meta);
  EXPECT_EQ(gst_video_overlay_composition_n_rectangles(meta->overlay), 2u);  // Object and label.
}

TEST(RegionOverlay, DoesNotDrawOnFramesThatOthersHold) {
  const Caps caps{"I420", kSize.width, kSize.height};
  Chain chain("regionoverlay", caps);
  const BufferPtr held = frameWith(caps, oneObject());
  const auto before = testing::bytesOf(held.get());
  const BufferPtr out = chain.pass(BufferPtr(gst_buffer_ref(held.get())));
  ASSERT_TRUE(out);
  EXPECT_NE(testing::bytesOf(out.get()), before);
  EXPECT_EQ(testing::bytesOf(held.get()), before);
}

TEST(RegionOverlay, LeavesAFrameWithoutObjectsAlone) {
  const Caps caps{"I420", kSize.width, kSize.height};
  Chain chain("regionoverlay", caps);
  BufferPtr in = frameWith(caps, objects(kSize, {}));
  const GstMemory* memory = gst_buffer_peek_memory(in.get(), 0);
  const BufferPtr out = chain.pass(std::move(in));
  ASSERT_TRUE(out);
  EXPECT_EQ(gst_buffer_peek_memory(out.get(), 0), memory);
}

TEST(RegionOverlay, DrawsWhereTheObjectIsOnAScaledFrame) {
  const Caps caps{"GRAY8", kSize.width * 2, kSize.height / 2};
  Chain chain("regionoverlay ids=false trails=false vectors=false", caps);
  const BufferPtr out = chain.pass(frameWith(caps, oneObject()));
  ASSERT_TRUE(out);
  const Box drawn = changed(out.get(), caps);
  EXPECT_NEAR(drawn.x, 2 * kBox.x, 2);
  EXPECT_NEAR(drawn.right(), 2 * kBox.right(), 2);
  EXPECT_NEAR(drawn.y, kBox.y / 2, 2);
  EXPECT_NEAR(drawn.bottom(), kBox.bottom() / 2, 2);
}

TEST(RegionOverlay, EachPartCanBeDrawnAlone) {
  const Caps caps{"GRAY8", kSize.width, kSize.height};
  const std::string none = "boxes=false ids=false trails=false vectors=false ";
  for (const char* part : {"boxes=true", "ids=true", "vectors=true", "contours=true"}) {
    Chain chain("regionoverlay " + none + part, caps);
    const BufferPtr out = chain.pass(frameWith(caps, oneObject()));
    ASSERT_TRUE(out);
    EXPECT_FALSE(changed(out.get(), caps).isEmpty()) << part;
  }
  Chain chain("regionoverlay " + none + "trails=true", caps);
  BufferPtr out;
  for (int i = 0; i < 5; ++i)
    out = chain.pass(frameWith(caps, objects(kSize, {object(5, {20 * i, 100, 10, 10})}), i));
  const Box trail = changed(out.get(), caps);
  EXPECT_NEAR(trail.x, 5, 3);
  EXPECT_NEAR(trail.right(), 86, 3);
  EXPECT_LT(trail.height, 8);
}

TEST(RegionOverlay, DrawsTheGraphWithoutObjects) {
  const Caps caps{"GRAY8", kSize.width, kSize.height};
  Chain chain("regionoverlay boxes=false ids=false trails=false vectors=false graph=true", caps);
  BufferPtr in = greyFrame(caps);
  attachResult<graph::Graph>(in.get(), testing::graph(kSize));
  const BufferPtr out = chain.pass(std::move(in));
  ASSERT_TRUE(out);
  const Box drawn = changed(out.get(), caps);
  EXPECT_NEAR(drawn.x, 80, 12);
  EXPECT_NEAR(drawn.right(), 240, 12);
}

TEST(RegionOverlay, DrawsTheMotionOfRegionsWithoutObjects) {
  const Caps caps{"GRAY8", kSize.width, kSize.height};
  Chain chain("regionoverlay", caps);
  BufferPtr in = greyFrame(caps);
  attachResult<graph::Graph>(in.get(), testing::graph(kSize));
  auto motion = std::make_shared<motion::Motion>();
  motion->size = kSize;
  motion->regions = {{2 * motion::kMotionUnit, 0, 0, motion::kFullReliability}, {64, 64, 0, 0}};
  attachResult<motion::Motion>(in.get(), motion);
  const BufferPtr out = chain.pass(std::move(in));
  ASSERT_TRUE(out);
  const Box drawn = changed(out.get(), caps);
  EXPECT_NEAR(drawn.x, 80, 3);
  EXPECT_NEAR(drawn.right(), 80 + 25, 5);
  EXPECT_LT(drawn.height, 20);
}

TEST(RegionOverlay, DrawsAGridThatMovesWithTheGround) {
  const Caps caps{"GRAY8", kSize.width, kSize.height};
  Chain chain("regionoverlay boxes=false ids=false trails=false vectors=false grid=true", caps);
  const auto result = objects(kSize, {});
  BufferPtr out = chain.pass(frameWith(caps, result));
  ASSERT_TRUE(out);
  EXPECT_NE(pixel(out.get(), caps, 160, 100), kGrey);  // In the middle of the frame.
  EXPECT_EQ(pixel(out.get(), caps, 172, 100), kGrey);
  EXPECT_EQ(changed(out.get(), caps), (Box{0, 0, kSize.width, kSize.height}));
  const auto panned = objects(kSize, {});
  panned->camera = CameraMotion(Point{12 * 16, 0});
  out = chain.pass(frameWith(caps, panned, 1));
  ASSERT_TRUE(out);
  EXPECT_EQ(pixel(out.get(), caps, 160, 100), kGrey);
  EXPECT_NE(pixel(out.get(), caps, 172, 100), kGrey);
}

TEST(RegionOverlay, BlacksOutWhatIsNoObject) {
  for (const char* format : testing::kAllFormats) {
    SCOPED_TRACE(format);
    const Caps caps{format, kSize.width, kSize.height};
    Chain chain("regionoverlay background=black boxes=false ids=false trails=false vectors=false",
                caps);
    const BufferPtr out = chain.pass(frameWith(caps, oneObject()));
    ASSERT_TRUE(out);
    const GstVideoInfo info = caps.info();
    const bool isLimited = GST_VIDEO_INFO_IS_YUV(&info);
    EXPECT_EQ(pixel(out.get(), caps, 10, 10), isLimited ? 16 : 0);
    EXPECT_EQ(pixel(out.get(), caps, kBox.x, kBox.y), kGrey);
    EXPECT_EQ(pixel(out.get(), caps, kBox.right() - 1, kBox.bottom() - 1), kGrey);
    EXPECT_EQ(pixel(out.get(), caps, kBox.right(), kBox.y + 5), isLimited ? 16 : 0);
    if (isLimited) {
      EXPECT_EQ(pixel(out.get(), caps, 10, 10, 1), 128);
      EXPECT_EQ(pixel(out.get(), caps, 10, 10, 2), 128);
    }
  }
}

TEST(RegionOverlay, BlacksOutTheBackgroundWithoutObjects) {
  const Caps caps{"GRAY8", kSize.width, kSize.height};
  Chain chain("regionoverlay background=black", caps);
  BufferPtr in = greyFrame(caps);
  attachResult<background::Foreground>(in.get(), testing::foreground(kSize, {100, 60, 10, 10}));
  const BufferPtr out = chain.pass(std::move(in));
  ASSERT_TRUE(out);
  EXPECT_EQ(pixel(out.get(), caps, 105, 65), kGrey);
  EXPECT_EQ(pixel(out.get(), caps, 105, 75), 0) << "a shadow is no foreground";
  EXPECT_EQ(pixel(out.get(), caps, 0, 0), 0);
}

TEST(RegionOverlay, NamesTheElementThatIsMissing) {
  const std::string none = "boxes=false ids=false trails=false vectors=false ";
  for (const auto& [properties, producer] : {std::pair{std::string(), "mrfmerge"},
                                             {none + "grid=true", "mrfmerge"},
                                             {none + "graph=true", "srg"},
                                             {none + "background=black", "bgremove"}}) {
    const Caps caps{"I420", 64, 48};
    Chain chain("regionoverlay " + properties, caps);
    EXPECT_EQ(chain.push(greyFrame(caps)), GST_FLOW_ERROR);
    EXPECT_NE(chain.complaint(GST_MESSAGE_ERROR).find(std::string("add ") + producer),
              std::string::npos);
  }
  const Caps caps{"I420", 64, 48};
  Chain chain("regionoverlay " + none, caps);
  EXPECT_TRUE(chain.pass(greyFrame(caps)));
}

TEST(RegionOverlay, PassesFramesOnWithOneWarningWhenResultsStop) {
  const Caps caps{"I420", kSize.width, kSize.height};
  Chain chain("regionoverlay", caps);
  ASSERT_TRUE(chain.pass(frameWith(caps, oneObject())));
  for (int i = 1; i < 4; ++i) {
    const BufferPtr out = chain.pass(frameWith(caps, nullptr, i));
    ASSERT_TRUE(out);
    EXPECT_TRUE(changed(out.get(), caps).isEmpty());
  }
  EXPECT_NE(chain.complaint(GST_MESSAGE_WARNING).find("mrfmerge"), std::string::npos);
  EXPECT_EQ(chain.complaint(GST_MESSAGE_WARNING), "");
}

TEST(RegionOverlay, WorksOnTheSmallestFrames) {
  for (const char* format : testing::kAllFormats)
    for (const Size size : {Size{1, 1}, Size{1, 7}, Size{7, 1}, Size{3, 3}}) {
      const Caps caps{format, size.width, size.height};
      Chain chain("regionoverlay contours=true graph=true background=black", caps);
      EXPECT_TRUE(chain.pass(frameWith(caps, objects(size, {object(1, boundsOf(size))}))));
      EXPECT_EQ(chain.complaint(GST_MESSAGE_WARNING), "");
    }
}

TEST(RegionOverlay, DoesNotWriteBeyondALyingMeta) {
  const Caps caps{"GRAY8", 64, 48};
  Chain chain("regionoverlay background=black", caps);
  BufferPtr in = frameWith(caps, objects({64, 48}, {object(1, {10, 10, 20, 20})}));
  gsize offset[GST_VIDEO_MAX_PLANES] = {};
  gint stride[GST_VIDEO_MAX_PLANES] = {4096};
  gst_buffer_add_video_meta_full(in.get(), GST_VIDEO_FRAME_FLAG_NONE, GST_VIDEO_FORMAT_GRAY8, 64,
                                 48, 1, offset, stride);
  const auto before = testing::bytesOf(in.get());
  const BufferPtr out = chain.pass(std::move(in));
  ASSERT_TRUE(out);
  EXPECT_EQ(testing::bytesOf(out.get()), before);
  EXPECT_NE(chain.complaint(GST_MESSAGE_WARNING), "");
}

TEST(RegionOverlay, DrawsOnPaddedRowsAndLeavesThePadding) {
  const Caps caps{"GRAY8", 64, 48};
  Chain chain("regionoverlay", caps);
  constexpr gint kStride = 100;
  BufferPtr in(gst_buffer_new_allocate(nullptr, kStride * 48, nullptr));
  gst_buffer_memset(in.get(), 0, kGrey, kStride * 48);
  gsize offset[GST_VIDEO_MAX_PLANES] = {};
  gint stride[GST_VIDEO_MAX_PLANES] = {kStride};
  gst_buffer_add_video_meta_full(in.get(), GST_VIDEO_FRAME_FLAG_NONE, GST_VIDEO_FORMAT_GRAY8, 64,
                                 48, 1, offset, stride);
  attachResult<objects::Objects>(in.get(), objects({64, 48}, {object(1, {10, 10, 54, 30})}));
  const BufferPtr out = chain.pass(std::move(in));
  ASSERT_TRUE(out);
  const auto bytes = testing::bytesOf(out.get());
  EXPECT_NE(bytes[20 * kStride + 10], kGrey);
  EXPECT_NE(bytes[20 * kStride + 63], kGrey);
  for (size_t y = 0; y < 48; ++y)
    for (size_t x = 64; x < kStride; ++x) ASSERT_EQ(bytes[y * kStride + x], kGrey) << x << "," << y;
}

TEST(RegionOverlay, DrawsTheSameTwice) {
  const Caps caps{"BGRx", kSize.width, kSize.height};
  std::vector<uint8_t> first;
  for (int run = 0; run < 2; ++run) {
    Chain chain("regionoverlay contours=true", caps);
    for (int i = 0; i < 3; ++i) {
      const BufferPtr out = chain.pass(frameWith(caps, oneObject(), i));
      ASSERT_TRUE(out);
      const auto bytes = testing::bytesOf(out.get());
      if (run == 0 && i == 2) first = bytes;
      if (run == 1 && i == 2) {
        EXPECT_EQ(bytes, first);
      }
    }
  }
}

}  // namespace
}  // namespace rg
