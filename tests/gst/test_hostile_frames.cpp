// SPDX-License-Identifier: LGPL-2.1-or-later
// Buffers whose memory is not what their caps or metas promise.
#include "gst/meta/result_meta.hpp"
#include "tests/support/digest.hpp"
#include "tests/support/harness.hpp"

#include <gtest/gtest.h>

#include <cstring>

namespace rg {
namespace {

using testing::BufferPtr;
using testing::Caps;
using testing::Chain;
using testing::paint;
using testing::square;

guint64 badBuffers(const Chain& chain, const char* factory) {
  GstElement* element = chain.element(factory);
  guint64 count = 0;
  g_object_get(element, "bad-buffers", &count, nullptr);
  gst_object_unref(element);
  return count;
}

/// Expects the frame to pass unread, to be counted, and to be complained about once.
void expectPassedUnread(const char* line, const char* factory, const Caps& caps, BufferPtr frame) {
  SCOPED_TRACE(line);
  Chain chain(line, caps);
  const GstBuffer* sent = frame.get();
  BufferPtr out = chain.pass(std::move(frame));
  ASSERT_TRUE(out);
  EXPECT_EQ(out.get(), sent);
  EXPECT_EQ(badBuffers(chain, factory), 1u);
  EXPECT_NE(chain.complaint(GST_MESSAGE_WARNING), "");
  out = chain.pass(paint(caps, 1, square(2, 2, 9)));
  ASSERT_TRUE(out);
  EXPECT_EQ(badBuffers(chain, factory), 1u);
}

void expectPassedUnreadByAll(const Caps& caps, const std::function<BufferPtr()>& make) {
  expectPassedUnread("bgremove", "bgremove", caps, make());
  expectPassedUnread("hsvsegment", "hsvsegment", caps, make());
}

/// regionoverlay writes into frames: one whose meta lies passes as it came, with one complaint.
void expectPassedUndrawn([[maybe_unused]] const Caps& caps, BufferPtr frame) {
#ifdef REGIONGRAPH_HAS_OVERLAY
  Chain chain("bgremove ! regionoverlay background=black boxes=false ids=false trails=false", caps);
  ASSERT_TRUE(chain.pass(paint(caps, 0, square(2, 2, 9))));
  const auto before = testing::bytesOf(frame.get());
  const BufferPtr out = chain.pass(std::move(frame));
  ASSERT_TRUE(out);
  EXPECT_EQ(testing::bytesOf(out.get()), before);
  EXPECT_NE(chain.complaint(GST_MESSAGE_WARNING).find("skipped"), std::string::npos);
  EXPECT_NE(chain.complaint(GST_MESSAGE_WARNING).find("passed on as it came"), std::string::npos);
#endif
}

BufferPtr allocate(gsize bytes) {
  BufferPtr buffer(gst_buffer_new_allocate(nullptr, bytes, nullptr));
  gst_buffer_memset(buffer.get(), 0, 77, bytes);
  return buffer;
}

TEST(HostileFrame, ShortMemoryIsNotRead) {
  const Caps caps{"GRAY8", 64, 48};
  expectPassedUnreadByAll(caps, [] { return allocate(64 * 48 - 1); });
  expectPassedUnreadByAll(caps, [] { return allocate(1); });
  expectPassedUnreadByAll(caps, [] { return BufferPtr(gst_buffer_new()); });
}

TEST(HostileFrame, AMetaWhoseStrideLeavesTheMemoryIsNotBelieved) {
  expectPassedUnreadByAll({"GRAY8", 32, 10}, [] {
    BufferPtr buffer = allocate(320);
    gsize offsets[GST_VIDEO_MAX_PLANES] = {0};
    gint strides[GST_VIDEO_MAX_PLANES] = {100};
    gst_buffer_add_video_meta_full(buffer.get(), GST_VIDEO_FRAME_FLAG_NONE, GST_VIDEO_FORMAT_GRAY8,
                                   32, 10, 1, offsets, strides);
    return buffer;
  });
}

TEST(HostileFrame, AMetaWithANegativeStrideOrAFarOffsetIsNotBelieved) {
  for (const auto& [offset, stride] : {std::pair<gsize, gint>{0, -32}, {400, 32}, {G_MAXSIZE, 32}})
    expectPassedUnreadByAll({"GRAY8", 32, 10}, [&, offset = offset, stride = stride] {
      BufferPtr buffer = allocate(320);
      gsize offsets[GST_VIDEO_MAX_PLANES] = {offset};
      gint strides[GST_VIDEO_MAX_PLANES] = {stride};
      GstVideoMeta* meta = gst_buffer_add_video_meta(buffer.get(), GST_VIDEO_FRAME_FLAG_NONE,
                                                     GST_VIDEO_FORMAT_GRAY8, 32, 10);
      meta->offset[0] = offsets[0];
      meta->stride[0] = strides[0];
      return buffer;
    });
}

TEST(HostileFrame, AMetaOfAnotherSizeOrFormatIsNotBelieved) {
  expectPassedUnreadByAll({"GRAY8", 32, 10}, [] {
    BufferPtr buffer = allocate(60 * 40);
    gst_buffer_add_video_meta(buffer.get(), GST_VIDEO_FRAME_FLAG_NONE, GST_VIDEO_FORMAT_GRAY8, 60,
                              40);
    return buffer;
  });
  expectPassedUnreadByAll({"NV12", 32, 10}, [] {
    BufferPtr buffer = allocate(32 * 15);
    gst_buffer_add_video_meta(buffer.get(), GST_VIDEO_FRAME_FLAG_NONE, GST_VIDEO_FORMAT_GRAY8, 32,
                              10);
    return buffer;
  });
}

TEST(HostileFrame, AMetaWithAnotherNumberOfPlanesOrNoFormatIsNotBelieved) {
  const auto lie = [](guint planes, int format) {
    BufferPtr buffer = allocate(32 * 10);
    GstVideoMeta* meta = gst_buffer_add_video_meta(buffer.get(), GST_VIDEO_FRAME_FLAG_NONE,
                                                   GST_VIDEO_FORMAT_GRAY8, 32, 10);
    meta->n_planes = planes;
    std::memcpy(&meta->format, &format, sizeof format);
    return buffer;
  };
  const Caps caps{"GRAY8", 32, 10};
  for (const guint planes : {0u, 2u, 5u, G_MAXUINT}) {
    expectPassedUnreadByAll(caps, [&] { return lie(planes, GST_VIDEO_FORMAT_GRAY8); });
    expectPassedUndrawn(caps, lie(planes, GST_VIDEO_FORMAT_GRAY8));
  }
  for (const int format : {-1, 0x7fffffff}) {
    expectPassedUnreadByAll(caps, [&] { return lie(1, format); });
    expectPassedUndrawn(caps, lie(1, format));
  }
}

TEST(HostileFrame, PaddedRowsGiveWhatPackedRowsGive) {
  const Caps caps{"GRAY8", 50, 40};
  Chain packed("bgremove ! hsvsegment", caps), padded("bgremove ! hsvsegment", caps);
  constexpr gint kStride = 100;
  constexpr gsize kOffset = 16;
  for (int i = 0; i < 5; ++i) {
    BufferPtr plain = paint(caps, i, square(4 * i, 6, 15));
    BufferPtr wide = allocate(kOffset + kStride * 40);
    GST_BUFFER_PTS(wide.get()) = GST_BUFFER_PTS(plain.get());
    const auto bytes = testing::bytesOf(plain.get());
    const GstVideoInfo info = caps.info();
    const auto from = static_cast<size_t>(GST_VIDEO_INFO_PLANE_STRIDE(&info, 0));
    for (size_t y = 0; y < 40; ++y)
      gst_buffer_fill(wide.get(), kOffset + y * kStride, &bytes[y * from], 50);
    gsize offsets[GST_VIDEO_MAX_PLANES] = {kOffset};
    gint strides[GST_VIDEO_MAX_PLANES] = {kStride};
    gst_buffer_add_video_meta_full(wide.get(), GST_VIDEO_FRAME_FLAG_NONE, GST_VIDEO_FORMAT_GRAY8,
                                   50, 40, 1, offsets, strides);
    const auto before = testing::bytesOf(wide.get());
    const BufferPtr a = packed.pass(std::move(plain));
    const BufferPtr b = padded.pass(std::move(wide));
    EXPECT_EQ(testing::bytesOf(b.get()), before);
    const auto maskA = findResult<background::Foreground>(a.get()),
               maskB = findResult<background::Foreground>(b.get());
    const auto idsA = findResult<segmentation::Labels>(a.get()),
               idsB = findResult<segmentation::Labels>(b.get());
    ASSERT_EQ(idsA->count, idsB->count);
    EXPECT_EQ(testing::digestOf(*maskA), testing::digestOf(*maskB));
    EXPECT_EQ(testing::digestOf(*idsA), testing::digestOf(*idsB));
  }
}

TEST(HostileFrame, MemoryInPiecesIsReadAsOne) {
  const Caps caps{"GRAY8", 32, 10};
  Chain chain("bgremove", caps);
  BufferPtr buffer(gst_buffer_new());
  for (int i = 0; i < 10; ++i) {
    GstMemory* memory = gst_allocator_alloc(nullptr, 32, nullptr);
    gst_buffer_append_memory(buffer.get(), memory);
  }
  gst_buffer_memset(buffer.get(), 0, 9, 320);
  ASSERT_TRUE(chain.pass(std::move(buffer)));
  EXPECT_EQ(badBuffers(chain, "bgremove"), 0u);
}

TEST(HostileCaps, TooLargeFramesAreRefused) {
  for (const auto& [width, height] : {std::pair{16384, 16384}, {20000, 8}, {0, 4}}) {
    Chain chain("bgremove", Caps{"GRAY8", width, height});
    EXPECT_EQ(chain.push(allocate(100)), GST_FLOW_NOT_NEGOTIATED) << width << "x" << height;
  }
}

TEST(HostileCaps, NoMasksAreMadeOfTooLargeFrames) {
  Chain chain("regionmask", Caps{"GRAY8", 16384, 16384});
  EXPECT_EQ(chain.push(allocate(100)), GST_FLOW_NOT_NEGOTIATED);
  EXPECT_NE(chain.complaint(GST_MESSAGE_ERROR).find("too large"), std::string::npos);
}

TEST(HostileCaps, OtherFormatsAreRefused) {
  for (const char* format : {"AYUV", "I420_10BE", "Y42B, interlace-mode=alternate", "GRAY16_LE"}) {
    Chain chain("bgremove", Caps{format, 64, 48});
    EXPECT_EQ(chain.push(allocate(64 * 48 * 4)), GST_FLOW_NOT_NEGOTIATED) << format;
  }
}

}  // namespace
}  // namespace rg
