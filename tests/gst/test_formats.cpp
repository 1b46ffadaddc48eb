// SPDX-License-Identifier: LGPL-2.1-or-later
// One scene in every format, in padded rows, in memory of its own for each plane, and in fields:
// what the stages say of it is the same wherever the samples are.
#include "gst/meta/result_meta.hpp"
#include "gst/support/cuda_memory.hpp"
#include "tests/support/busy_scene.hpp"

#include <gst/allocators/gstdmabuf.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fcntl.h>
#include <string>
#include <sys/mman.h>
#include <unistd.h>
#include <vector>

namespace rg {
namespace {

using testing::BufferPtr;
using testing::busyFrame;
using testing::Caps;
using testing::Chain;
using testing::objectsOn;
using testing::Story;

constexpr const char* kYuvFormats[] = {"I420", "NV12", "NV21",      "YUY2",
                                       "UYVY", "Y42B", "I420_10LE", "P010_10LE"};
constexpr int kFrames = 24;

/// Levels of the busy scene, which is grey, row by row.
class Levels {
 public:
  Levels(const Caps& caps, int index)
      : stride_(GST_ROUND_UP_4(caps.width)),
        bytes_(testing::bytesOf(
            busyFrame({"GRAY8", caps.width, caps.height, caps.framerate}, index).get())) {}
  [[nodiscard]] int at(int x, int y) const { return bytes_[static_cast<size_t>(y * stride_ + x)]; }

 private:
  int stride_;
  std::vector<uint8_t> bytes_;
};

/// The sample of a component at a pixel of the scene: chroma follows the levels, and is alike in
/// squares of 2x2 pixels, so that formats with all its rows hold what those with half of them do.
uint8_t sampleOf(const Levels& levels, bool isRgb, guint component, int x, int y) {
  if (!isRgb && component > 0) {
    const int level = levels.at(x & ~1, y & ~1);
    return static_cast<uint8_t>(component == 1 ? 20 + 3 * level / 4 : 200 - level / 2);
  }
  const int level = levels.at(x, y);
  return static_cast<uint8_t>(component == 0 ? level : component == 1 ? 255 - level : level / 2);
}

/// A buffer for frames whose rows have so many bytes more than they need.
BufferPtr paddedBuffer(const GstVideoInfo& info, int padding) {
  gsize offsets[GST_VIDEO_MAX_PLANES] = {}, end = static_cast<gsize>(padding);
  gint strides[GST_VIDEO_MAX_PLANES] = {};
  for (guint i = 0; i < GST_VIDEO_INFO_N_PLANES(&info); ++i) {
    const gsize next = i + 1 < GST_VIDEO_INFO_N_PLANES(&info) ? info.offset[i + 1] : info.size;
    const gsize rows = (next - info.offset[i]) / static_cast<gsize>(info.stride[i]);
    strides[i] = info.stride[i] + padding;
    offsets[i] = end;
    end += rows * static_cast<gsize>(strides[i]);
  }
  BufferPtr buffer(gst_buffer_new_allocate(nullptr, end, nullptr));
  gst_buffer_memset(buffer.get(), 0, 0x5A, end);
  gst_buffer_add_video_meta_full(buffer.get(), GST_VIDEO_FRAME_FLAG_NONE,
                                 GST_VIDEO_INFO_FORMAT(&info),
                                 static_cast<guint>(GST_VIDEO_INFO_WIDTH(&info)),
                                 static_cast<guint>(GST_VIDEO_INFO_HEIGHT(&info)),
                                 GST_VIDEO_INFO_N_PLANES(&info), offsets, strides);
  return buffer;
}

/// A frame of the scene in colour. `padding`: bytes behind each row.
BufferPtr colourFrame(const Caps& caps, int index, int padding = 0) {
  const GstVideoInfo info = caps.info();
  const Levels levels(caps, index);
  BufferPtr buffer = padding > 0 ? paddedBuffer(info, padding)
                                 : BufferPtr(gst_buffer_new_allocate(nullptr, info.size, nullptr));
  GstVideoFrame frame;
  gst_video_frame_map(&frame, &info, buffer.get(), GST_MAP_WRITE);
  for (guint i = 0; i < GST_VIDEO_FRAME_N_COMPONENTS(&frame); ++i) {
    const auto stepX = 1 << GST_VIDEO_FORMAT_INFO_W_SUB(info.finfo, i);
    const auto stepY = 1 << GST_VIDEO_FORMAT_INFO_H_SUB(info.finfo, i);
    for (int y = 0; y < GST_VIDEO_FRAME_COMP_HEIGHT(&frame, i); ++y)
      for (int x = 0; x < GST_VIDEO_FRAME_COMP_WIDTH(&frame, i); ++x)
        testing::putSample(frame, i, x, y,
                           sampleOf(levels, GST_VIDEO_INFO_IS_RGB(&info), i, x * stepX, y * stepY),
                           static_cast<guint>(x + y + index) % 4);
  }
  gst_video_frame_unmap(&frame);
  GST_BUFFER_PTS(buffer.get()) = static_cast<GstClockTime>(index) * 40 * GST_MSECOND;
  GST_BUFFER_DURATION(buffer.get()) = 40 * GST_MSECOND;
  return buffer;
}

/// Expects two formats to give the same story, with objects in view.
void expectSameStory(const std::string& line, const Caps& caps, const Caps& otherCaps,
                     int padding = 0) {
  SCOPED_TRACE(line + ", " + caps.text());
  Chain chain(line, caps), other(line, otherCaps);
  Story story, expected;
  int inView = 0;
  for (int i = 0; i < kFrames; ++i) {
    const BufferPtr out = chain.pass(colourFrame(caps, i, padding));
    const BufferPtr otherOut = other.pass(colourFrame(otherCaps, i));
    ASSERT_TRUE(out && otherOut);
    ASSERT_EQ(story.tell(out.get()), expected.tell(otherOut.get())) << "frame " << i;
    inView += objectsOn(out.get());
  }
  EXPECT_GT(inView, 0);
  EXPECT_EQ(chain.complaint(GST_MESSAGE_WARNING), "");
}

TEST(Formats, SayWhatI420Says) {
  for (const auto& [width, height] : {std::pair{96, 64}, {97, 65}, {131, 62}})
    for (const char* format : kYuvFormats) {
      const Caps caps{format, width, height}, planar{"I420", width, height};
      expectSameStory(testing::kQuickStages, caps, planar);
      expectSameStory(testing::kQuickStages, caps, planar, 36);
    }
}

TEST(Formats, SayWhatI420SaysOfTheWholeFrame) {
  for (const char* format : kYuvFormats)
    expectSameStory(testing::kFrameScopeStages, {format, 97, 65}, {"I420", 97, 65}, 12);
}

TEST(Formats, PlanesOfColourSayWhatPackedOnesSay) {
  for (const int padding : {0, 20}) {
    expectSameStory(testing::kQuickStages, {"GBR", 97, 65}, {"RGB", 97, 65}, padding);
    expectSameStory(testing::kFrameScopeStages, {"GBR", 96, 64}, {"BGRx", 96, 64}, padding);
  }
}

/// Chroma of a smaller picture is a mean of the frame's, in one step where it has all rows: the
/// same where boxes of the one hold whole samples of the other.
TEST(Formats, SayWhatI420SaysAtAnAnalysisHeight) {
  const std::string line =
      "bgremove training-frames=2 analysis-height=64 ! hsvsegment ! srg ! prmmotion ! mrfmerge";
  for (const char* format : kYuvFormats)
    expectSameStory(line, {format, 384, 256}, {"I420", 384, 256});
  expectSameStory(line, {"GBR", 384, 256}, {"RGB", 384, 256});
}

/// Each format after each other one, with objects in view.
TEST(Formats, FollowOneAnother) {
  Chain chain(testing::kQuickStages, {"I420", 97, 65});
  int index = 0;
  for (const char* first : testing::kAllFormats)
    for (const char* second : {"I420", "P010_10LE", "YUY2"})
      for (const char* format : {first, second}) {
        const Caps caps{format, 97, 65};
        if (caps.text() == chain.caps().text()) continue;
        SCOPED_TRACE(caps.text());
        chain.setCaps(caps);
        Chain fresh(testing::kQuickStages, caps);
        Story story, expected;
        int inView = 0;
        for (int i = 0; i < 12; ++i, ++index) {
          const BufferPtr out = chain.pass(colourFrame(caps, index));
          ASSERT_TRUE(out);
          ASSERT_EQ(story.tell(out.get()),
                    expected.tell(fresh.pass(colourFrame(caps, index)).get()));
          inView += objectsOn(out.get());
        }
        EXPECT_GT(inView, 0);
      }
  EXPECT_EQ(chain.complaint(GST_MESSAGE_WARNING), "");
}

/// Memory that a device shares is mapped by GStreamer: here that of a file in memory, for want of a
/// device.
class DmaBufs {
 public:
  DmaBufs() : allocator_(gst_dmabuf_allocator_new()) {}
  ~DmaBufs() { gst_object_unref(allocator_); }
  DmaBufs(const DmaBufs&) = delete;
  DmaBufs& operator=(const DmaBufs&) = delete;

  /// The same frame in so many memories, cut where planes begin.
  [[nodiscard]] BufferPtr share(const Caps& caps, GstBuffer* frame, guint memories) const {
    GstVideoInfo info = caps.info();
    const auto bytes = testing::bytesOf(frame);
    BufferPtr buffer(gst_buffer_new());
    for (guint i = 0; i < memories; ++i) {
      const gsize from = info.offset[i], to = i + 1 < memories ? info.offset[i + 1] : bytes.size();
      gst_buffer_append_memory(buffer.get(), share({&bytes[from], to - from}));
    }
    GST_BUFFER_PTS(buffer.get()) = GST_BUFFER_PTS(frame);
    gst_buffer_add_video_meta_full(buffer.get(), GST_VIDEO_FRAME_FLAG_NONE,
                                   GST_VIDEO_INFO_FORMAT(&info), static_cast<guint>(caps.width),
                                   static_cast<guint>(caps.height), GST_VIDEO_INFO_N_PLANES(&info),
                                   info.offset, info.stride);
    return buffer;
  }

  [[nodiscard]] GstMemory* share(std::span<const uint8_t> bytes, int mode = O_RDWR) const {
    const int file = memfd_create("frame", 0);
    EXPECT_EQ(write(file, bytes.data(), bytes.size()), static_cast<ssize_t>(bytes.size()));
    const int shared = open(("/proc/self/fd/" + std::to_string(file)).c_str(), mode);
    close(file);
    return gst_dmabuf_allocator_alloc(allocator_, shared, bytes.size());
  }

 private:
  GstAllocator* allocator_;
};

guint64 badBuffers(const Chain& chain) {
  GstElement* element = chain.element("bgremove");
  guint64 count = 0;
  g_object_get(element, "bad-buffers", &count, nullptr);
  gst_object_unref(element);
  return count;
}

TEST(DmaBuf, SaysWhatOtherMemorySays) {
  const DmaBufs dmaBufs;
  for (const auto& [format, memories] :
       {std::pair{"NV12", 1u}, {"NV12", 2u}, {"I420", 3u}, {"P010_10LE", 2u}, {"YUY2", 1u}}) {
    SCOPED_TRACE(std::string(format) + " in " + std::to_string(memories));
    const Caps caps{format, 96, 64};
    Chain chain(testing::kQuickStages, caps), other(testing::kQuickStages, caps);
    Story story, expected;
    int inView = 0;
    for (int i = 0; i < kFrames; ++i) {
      BufferPtr frame = colourFrame(caps, i);
      BufferPtr shared = dmaBufs.share(caps, frame.get(), memories);
      const GstMemory* memory = gst_buffer_peek_memory(shared.get(), 0);
      ASSERT_TRUE(gst_is_dmabuf_memory(gst_buffer_peek_memory(shared.get(), memories - 1)));
      const BufferPtr out = chain.pass(std::move(shared));
      ASSERT_EQ(story.tell(out.get()), expected.tell(other.pass(std::move(frame)).get()));
      EXPECT_EQ(gst_buffer_peek_memory(out.get(), 0), memory);
      EXPECT_EQ(gst_buffer_n_memory(out.get()), memories);
      inView += objectsOn(out.get());
    }
    EXPECT_GT(inView, 0);
    EXPECT_EQ(badBuffers(chain), 0u);
  }
}

/// Frames of a decoder on a GPU, for want of one in memory that has to be mapped too: they pass as
/// they are, by any number of stages, and say what other memory says.
TEST(CudaMemory, SaysWhatOtherMemorySays) {
  const DmaBufs dmaBufs;
  const std::string feature = "memory:CUDAMemory";
  for (const char* format : {"NV12", "I420", "P010_10LE", "BGRx"}) {
    SCOPED_TRACE(format);
    const Caps caps{format, 96, 64};
    Chain chain(testing::kQuickStages, caps), other(testing::kQuickStages, caps);
    ASSERT_TRUE(testing::sendCaps(
        chain, "video/x-raw(" + feature + ")" + caps.text().substr(strlen("video/x-raw"))));
    Story story, expected;
    int inView = 0;
    for (int i = 0; i < kFrames; ++i) {
      BufferPtr frame = colourFrame(caps, i);
      const BufferPtr out = chain.pass(dmaBufs.share(caps, frame.get(), 1));
      ASSERT_TRUE(out);
      ASSERT_EQ(story.tell(out.get()), expected.tell(other.pass(std::move(frame)).get()));
      inView += objectsOn(out.get());
    }
    EXPECT_GT(inView, 0);
    GstCaps* passed = gst_pad_get_current_caps(chain.harness()->sinkpad);
    EXPECT_TRUE(gst_caps_features_contains(gst_caps_get_features(passed, 0), feature.c_str()));
    gst_caps_unref(passed);
  }
}

/// With libgstcuda or without, and in any case without a driver, whose absence ends the process in
/// most of its functions.
TEST(CudaMemory, IsWhatCudaHasAllocatedOnly) {
  const DmaBufs dmaBufs;
  const Caps caps{"NV12", 96, 64};
  BufferPtr plain = colourFrame(caps, 0);
  EXPECT_FALSE(cudaMapOf(plain.get(), 0));
  EXPECT_FALSE(cudaMapOf(dmaBufs.share(caps, plain.get(), 1).get(), 0));
  EXPECT_FALSE(cudaMapOf(dmaBufs.share(caps, plain.get(), 2).get(), 0));
  EXPECT_FALSE(cudaMapOf(BufferPtr(gst_buffer_new()).get(), 0));
}

TEST(DmaBuf, ThatCantBeMappedOrIsShortIsCountedAndTheStreamGoesOn) {
  const DmaBufs dmaBufs;
  const Caps caps{"NV12", 96, 64};
  const GstVideoInfo info = caps.info();
  Chain chain(testing::kQuickStages, caps);
  int index = 0;
  ASSERT_TRUE(testing::showObjects(chain, index));
  const std::vector<uint8_t> luma(96 * 64, 60), chroma(96 * 32, 128);
  guint64 bad = 0;
  for (const auto& [mode, missing] : {std::pair{O_WRONLY, 0u}, {O_RDWR, 1u}, {O_RDWR, 96u * 33}}) {
    BufferPtr frame(gst_buffer_new());
    gst_buffer_append_memory(frame.get(), dmaBufs.share(luma));
    if (missing < chroma.size())
      gst_buffer_append_memory(frame.get(),
                               dmaBufs.share({chroma.data(), chroma.size() - missing}, mode));
    GST_BUFFER_PTS(frame.get()) = static_cast<GstClockTime>(index++) * 40 * GST_MSECOND;
    ASSERT_TRUE(chain.pass(std::move(frame)));
    EXPECT_EQ(badBuffers(chain), ++bad);
  }
  EXPECT_TRUE(testing::showObjects(chain, index));
  EXPECT_EQ(info.size, luma.size() + chroma.size());
}

/// Writes every second row of each plane of `from`, from the row `first` on, to row + `shift`.
void putRows(const Caps& caps, GstBuffer* to, GstBuffer* from, int first, int shift) {
  const GstVideoInfo info = caps.info();
  GstVideoFrame target, source;
  gst_video_frame_map(&target, &info, to, GST_MAP_READWRITE);
  gst_video_frame_map(&source, &info, from, GST_MAP_READ);
  for (guint plane = 0; plane < GST_VIDEO_INFO_N_PLANES(&info); ++plane) {
    const auto stride = static_cast<size_t>(GST_VIDEO_FRAME_PLANE_STRIDE(&source, plane));
    const int rows = GST_VIDEO_FRAME_COMP_HEIGHT(&source, plane);
    for (int y = first; y < rows && y + shift < rows; y += 2)
      std::memcpy(
          static_cast<uint8_t*>(target.data[plane]) + static_cast<size_t>(y + shift) * stride,
          static_cast<uint8_t*>(source.data[plane]) + static_cast<size_t>(y) * stride, stride);
  }
  gst_video_frame_unmap(&source);
  gst_video_frame_unmap(&target);
}

/// The scene as an interlaced camera has it, and the field with the top line alone, each row twice.
/// Metas tell where planes lie: usually that differs where a frame is interlaced.
struct Fields {
  static constexpr int kPadding = 8;
  BufferPtr woven, doubled;
  Fields(const Caps& caps, int index)
      : woven(colourFrame(caps, index, kPadding)), doubled(colourFrame(caps, index, kPadding)) {
    const BufferPtr later = colourFrame(caps, index + 1, kPadding);
    putRows(caps, woven.get(), later.get(), 1, 0);
    const BufferPtr field = colourFrame(caps, index, kPadding);
    putRows(caps, doubled.get(), field.get(), 0, 1);
  }
};

const char* const kInterlaced = ",interlace-mode=interleaved,field-order=top-field-first";

TEST(Interlaced, IsToldOnceAndOneFieldIsLookedAt) {
  for (const char* format : {"I420", "NV12", "YUY2", "Y42B", "P010_10LE", "GBR", "GRAY8", "BGRx"})
    for (const int height : {64, 65, 66, 67}) {
      const Caps caps{format, 96, height};
      SCOPED_TRACE(caps.text());
      Chain chain(testing::kQuickStages, caps), other(testing::kQuickStages, caps);
      ASSERT_TRUE(testing::sendCaps(chain, caps.text() + kInterlaced));
      Story story, expected;
      int inView = 0;
      for (int i = 0; i < kFrames; ++i) {
        Fields fields(caps, i);
        const BufferPtr out = chain.pass(std::move(fields.woven));
        const BufferPtr otherOut = other.pass(std::move(fields.doubled));
        ASSERT_EQ(story.tell(out.get()), expected.tell(otherOut.get())) << "frame " << i;
        inView += objectsOn(out.get());
      }
      EXPECT_GT(inView, 0);
      EXPECT_NE(chain.complaint(GST_MESSAGE_WARNING).find("Put deinterlace in front"),
                std::string::npos);
      EXPECT_EQ(chain.complaint(GST_MESSAGE_WARNING), "");
      EXPECT_EQ(other.complaint(GST_MESSAGE_WARNING), "");
    }
}

/// With fewer rows than a field has, as many, and more.
TEST(Interlaced, IsLookedAtInASmallerPicture) {
  const Caps caps{"I420", 384, 256};
  for (const int rows : {64, 128, 200}) {
    SCOPED_TRACE(rows);
    const std::string line =
        "regiontrack training-frames=2 analysis-height=" + std::to_string(rows);
    Chain chain(line, caps), other(line, caps);
    ASSERT_TRUE(testing::sendCaps(chain, caps.text() + kInterlaced));
    Story story, expected;
    int inView = 0;
    for (int i = 0; i < kFrames; ++i) {
      Fields fields(caps, i);
      const BufferPtr out = chain.pass(std::move(fields.woven));
      const BufferPtr otherOut = other.pass(std::move(fields.doubled));
      const std::string said = story.tell(out.get()), usual = expected.tell(otherOut.get());
      if (rows < 200) {
        ASSERT_EQ(said, usual) << "frame " << i;
      }
      inView += objectsOn(out.get());
    }
    EXPECT_GT(inView, 0);
  }
}

/// Rows that mean something else are learnt anew, and a stream that changes often tells it once.
TEST(Interlaced, BeginsAnewAndIsNotToldAgain) {
  const Caps caps{"I420", 96, 64};
  Chain chain(testing::kQuickStages, caps);
  int index = 0;
  for (int round = 0; round < 4; ++round) {
    const std::string text = caps.text() + (round % 2 == 0 ? kInterlaced : "");
    ASSERT_TRUE(testing::sendCaps(chain, text));
    Chain fresh(testing::kQuickStages, caps);
    ASSERT_TRUE(testing::sendCaps(fresh, text));
    Story story, expected;
    int inView = 0;
    for (int i = 0; i < 12; ++i, ++index) {
      const BufferPtr out = chain.pass(std::move(Fields(caps, index).woven));
      ASSERT_EQ(story.tell(out.get()),
                expected.tell(fresh.pass(std::move(Fields(caps, index).woven)).get()));
      inView += objectsOn(out.get());
    }
    EXPECT_GT(inView, 0);
  }
  EXPECT_NE(chain.complaint(GST_MESSAGE_WARNING), "");
  EXPECT_EQ(chain.complaint(GST_MESSAGE_WARNING), "");
}

/// Film and video in turn: a background that was learnt from one field stays true.
TEST(Interlaced, MixedVideoIsReadAlike) {
  const Caps caps{"I420", 96, 64};
  Chain mixed(testing::kQuickStages, caps), woven(testing::kQuickStages, caps);
  ASSERT_TRUE(testing::sendCaps(mixed, caps.text() + ",interlace-mode=mixed"));
  ASSERT_TRUE(testing::sendCaps(woven, caps.text() + kInterlaced));
  Story story, expected;
  for (int i = 0; i < kFrames; ++i) {
    BufferPtr frame = std::move(Fields(caps, i).woven);
    if (i % 3 == 0) GST_BUFFER_FLAG_SET(frame.get(), GST_VIDEO_BUFFER_FLAG_INTERLACED);
    EXPECT_EQ(story.tell(mixed.pass(std::move(frame)).get()),
              expected.tell(woven.pass(std::move(Fields(caps, i).woven)).get()));
  }
}

}  // namespace
}  // namespace rg
