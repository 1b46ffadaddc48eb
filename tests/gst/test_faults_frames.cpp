// SPDX-License-Identifier: LGPL-2.1-or-later
// Memory that is short, locked, shared or scarce, and pictures that are worst, with objects in
// view.
#include "core/base/pixel.hpp"
#include "gst/meta/result_meta.hpp"
#include "tests/support/busy_scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <string>
#include <sys/mman.h>
#include <vector>

namespace rg {
namespace {

using testing::BufferPtr;
using testing::busyFrame;
using testing::bytesOf;
using testing::campaign;
using testing::Caps;
using testing::Chain;
using testing::Chance;
using testing::objectsOn;
using testing::paint;
using testing::showObjects;
using testing::Story;
using testing::Watchdog;

const Caps kSmall{"I420", 96, 64};

guint64 badBuffers(const Chain& chain, const char* factory) {
  GstElement* element = chain.element(factory);
  guint64 count = 0;
  g_object_get(element, "bad-buffers", &count, nullptr);
  gst_object_unref(element);
  return count;
}

/// A frame whose memory was cut, or made longer, to so many bytes.
BufferPtr resized(BufferPtr frame, gsize bytes) {
  auto data = bytesOf(frame.get());
  data.resize(bytes);
  BufferPtr other(gst_buffer_new_allocate(nullptr, bytes, nullptr));
  gst_buffer_fill(other.get(), 0, data.data(), bytes);
  GST_BUFFER_PTS(other.get()) = GST_BUFFER_PTS(frame.get());
  return other;
}

/// Shorter frames are counted and skipped, longer ones are read as they should be.
TEST(FrameSizes, OfEveryLengthInRandomOrder) {
  Chance chance;
  Chain chain(testing::kQuickStages, kSmall);
  int index = 0;
  ASSERT_TRUE(showObjects(chain, index));
  const gsize whole = kSmall.info().size;
  guint64 bad = 0;
  for (int round = campaign(120); round > 0; --round, ++index) {
    const gsize odd[] = {0, 1, whole - 1, whole, whole + 1, 2 * whole};
    const gsize bytes = chance.isOneIn(2)
                            ? chance.pick(odd)
                            : static_cast<gsize>(chance.below(2 * static_cast<int>(whole)));
    const BufferPtr out = chain.pass(resized(busyFrame(kSmall, index), bytes));
    ASSERT_TRUE(out);
    bad += bytes < whole;
    EXPECT_EQ(badBuffers(chain, "bgremove"), bad) << bytes;
    EXPECT_EQ(findResult<background::Foreground>(out.get())->status == Status::Skipped,
              bytes < whole);
  }
  EXPECT_TRUE(showObjects(chain, index));
}

/// An allocator whose memory nobody can map.
struct LockedAllocator {
  GstAllocator parent;
};
struct LockedAllocatorClass {
  GstAllocatorClass parent;
};
G_DEFINE_TYPE(LockedAllocator, locked_allocator, GST_TYPE_ALLOCATOR)

void locked_allocator_class_init(LockedAllocatorClass* klass) {
  klass->parent.alloc = [](GstAllocator* self, gsize size, GstAllocationParams*) {
    auto* memory = static_cast<GstMemory*>(g_malloc0(sizeof(GstMemory)));
    gst_memory_init(memory, GST_MEMORY_FLAG_NO_SHARE, self, nullptr, size, 0, 0, size);
    return memory;
  };
  klass->parent.free = [](GstAllocator*, GstMemory* memory) { g_free(memory); };
}

void locked_allocator_init(LockedAllocator* self) {
  self->parent.mem_type = "Locked";
  self->parent.mem_map = [](GstMemory*, gsize, GstMapFlags) -> gpointer { return nullptr; };
  self->parent.mem_unmap = [](GstMemory*) {};
}

TEST(LockedMemory, IsCountedAndTheStreamGoesOn) {
  auto* allocator = static_cast<GstAllocator*>(g_object_new(locked_allocator_get_type(), nullptr));
  gst_object_ref_sink(allocator);
  for (const char* line : {testing::kQuickStages, testing::kFrameScopeStages}) {
    SCOPED_TRACE(line);
    const char* reader = line == testing::kQuickStages ? "bgremove" : "hsvsegment";
    Chain chain(std::string(line) + " ! regionwrite location=/dev/null", kSmall);
    int index = 0;
    ASSERT_TRUE(showObjects(chain, index));
    for (guint64 i = 1; i < 6; ++i) {
      BufferPtr frame(gst_buffer_new());
      gst_buffer_append_memory(frame.get(),
                               gst_allocator_alloc(allocator, kSmall.info().size, nullptr));
      GST_BUFFER_PTS(frame.get()) = static_cast<GstClockTime>(index++) * 40 * GST_MSECOND;
      const BufferPtr out = chain.pass(std::move(frame));
      ASSERT_TRUE(out);
      EXPECT_EQ(badBuffers(chain, reader), i);
    }
    EXPECT_TRUE(showObjects(chain, index));
  }
  gst_object_unref(allocator);
}

/// Frames in pages that may only be read: who writes to one ends the process.
TEST(ReadOnlyMemory, IsReadOnly) {
  const gsize size = kSmall.info().size;
  for (const char* line : {testing::kQuickStages, testing::kFrameScopeStages,
                           testing::kDifferenceStages, testing::kPaperStages}) {
    Chain chain(line, kSmall), other(line, kSmall);
    Story story, expected;
    for (int i = 0; i < 20; ++i) {
      void* page = mmap(nullptr, size, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
      ASSERT_NE(page, MAP_FAILED);
      const BufferPtr usual = busyFrame(kSmall, i);
      std::memcpy(page, bytesOf(usual.get()).data(), size);
      mprotect(page, size, PROT_READ);
      BufferPtr locked(gst_buffer_new_wrapped_full(GST_MEMORY_FLAG_READONLY, page, size, 0, size,
                                                   nullptr, nullptr));
      GST_BUFFER_PTS(locked.get()) = GST_BUFFER_PTS(usual.get());
      const BufferPtr out = chain.pass(std::move(locked));
      EXPECT_EQ(story.tell(out.get()), expected.tell(other.pass(busyFrame(kSmall, i)).get()));
      EXPECT_EQ(gst_buffer_peek_memory(out.get(), 0)->size, size);
      munmap(page, size);
    }
  }
}

/// Two branches behind a tee, one of them drawing: the pixels of the other stay as they were.
TEST(SharedFrames, KeepTheirPixelsWhatTheOtherBranchDraws) {
  if (!gst_element_factory_find("regionoverlay")) GTEST_SKIP() << "built without regionoverlay";
  Chain drawing(std::string(testing::kQuickStages) + " ! regionoverlay background=black", kSmall);
  int drawn = 0;
  for (int i = 0; i < 25; ++i) {
    const BufferPtr frame = busyFrame(kSmall, i);
    const auto before = bytesOf(frame.get());
    const BufferPtr out = drawing.pass(BufferPtr(gst_buffer_ref(frame.get())));
    ASSERT_TRUE(out);
    EXPECT_EQ(bytesOf(frame.get()), before);
    drawn += bytesOf(out.get()) != before;
  }
  EXPECT_GT(drawn, 0);
}

/// Runs a launch line to its end; empty, or what went wrong.
std::string run(const std::string& line) {
  const Watchdog watchdog(120);
  GError* error = nullptr;
  GstElement* pipeline = gst_parse_launch(line.c_str(), &error);
  std::string text = error ? error->message : "";
  g_clear_error(&error);
  if (!text.empty()) return text;
  gst_element_set_state(pipeline, GST_STATE_PLAYING);
  GstBus* bus = gst_element_get_bus(pipeline);
  GstMessage* message = gst_bus_timed_pop_filtered(
      bus, GST_CLOCK_TIME_NONE, static_cast<GstMessageType>(GST_MESSAGE_ERROR | GST_MESSAGE_EOS));
  if (GST_MESSAGE_TYPE(message) == GST_MESSAGE_ERROR) {
    gst_message_parse_error(message, &error, nullptr);
    text = error->message;
    g_clear_error(&error);
  }
  gst_message_unref(message);
  gst_object_unref(bus);
  gst_element_set_state(pipeline, GST_STATE_NULL);
  gst_object_unref(pipeline);
  return text;
}

/// Few buffers, allocations that are refused, and queues that hold frames: all come to their end.
TEST(ScarceBuffers, DoNotStopThePipeline) {
  const std::string source =
      "videotestsrc pattern=ball num-buffers=40 ! video/x-raw,format=I420,width=96,height=64 ! ";
  const std::string stages = testing::kQuickStages;
  for (const std::string& rest :
       {"identity drop-allocation=true ! " + stages + " ! fakesink",
        stages + " ! identity drop-allocation=true ! fakesink enable-last-sample=true",
        stages + " latency=0.3 ! queue max-size-buffers=1 ! fakesink",
        "videoconvert ! " + stages + " latency=0.2 ! queue min-threshold-buffers=3 ! fakesink",
        "tee name=t ! queue ! " + stages + " ! fakesink async=false t. ! queue ! " +
            testing::kFrameScopeStages + " ! fakesink async=false"})
    EXPECT_EQ(run(source + rest), "") << rest;
}

/// A pool of one buffer, whose one buffer downstream keeps.
TEST(ScarceBuffers, APoolOfOneServesTheNextFrame) {
  const Watchdog watchdog(60);
  Chain chain(testing::kQuickStages, kSmall);
  GstBufferPool* pool = gst_buffer_pool_new();
  GstStructure* config = gst_buffer_pool_get_config(pool);
  GstCaps* caps = gst_caps_from_string(kSmall.text().c_str());
  gst_buffer_pool_config_set_params(config, caps, static_cast<guint>(kSmall.info().size), 1, 1);
  gst_caps_unref(caps);
  ASSERT_TRUE(gst_buffer_pool_set_config(pool, config));
  gst_buffer_pool_set_active(pool, TRUE);
  for (int i = 0; i < 20; ++i) {
    GstBuffer* frame = nullptr;
    // Blocks where an element still holds the frame before.
    ASSERT_EQ(gst_buffer_pool_acquire_buffer(pool, &frame, nullptr), GST_FLOW_OK);
    const auto bytes = bytesOf(busyFrame(kSmall, i).get());
    gst_buffer_fill(frame, 0, bytes.data(), bytes.size());
    GST_BUFFER_PTS(frame) = static_cast<GstClockTime>(i) * 40 * GST_MSECOND;
    ASSERT_TRUE(chain.pass(BufferPtr(frame)));
  }
  gst_buffer_pool_set_active(pool, FALSE);
  gst_object_unref(pool);
}

/// Bytes are wrong in half of the frames; once they are right, objects are in view again.
TEST(BitErrors, PassAndAreForgotten) {
  Chance chance;
  for (const char* line : {testing::kQuickStages, testing::kFrameScopeStages}) {
    Chain chain(line, kSmall);
    int index = 0;
    ASSERT_TRUE(showObjects(chain, index));
    for (int round = campaign(60); round > 0; --round) {
      BufferPtr frame = busyFrame(kSmall, index++);
      const auto size = static_cast<int>(gst_buffer_get_size(frame.get()));
      for (int i = chance.isOneIn(2) ? chance.below(size) : 0; i > 0; --i)
        gst_buffer_memset(frame.get(), static_cast<gsize>(chance.below(size)),
                          static_cast<guint8>(chance.below(256)), 1);
      ASSERT_TRUE(chain.pass(std::move(frame)));
    }
    for (int i = 0; i < 100; ++i) (void)chain.pass(busyFrame(kSmall, index++));
    EXPECT_TRUE(showObjects(chain, index));
  }
}

/// Pictures with as many regions, borders or runs as there can be, none, and all of them in turn.
using Level = int (*)(int x, int y, int time);
constexpr Level kWorst[] = {
    [](int x, int y, int time) { return (x + y + time) % 2 * 200; },
    [](int x, int y, int time) {
      return static_cast<int>(
          mixHash(static_cast<uint32_t>(x), static_cast<uint32_t>(y), static_cast<uint32_t>(time)) %
          256);
    },
    [](int x, int y, int time) { return y > 2 && (x + time) % 2 == 0 ? 30 : 220; },
    [](int x, int y, int time) { return x % 2 == 0 && (y + time) % 2 == 0 ? 220 : 30; },
    [](int, int, int time) { return time % 2 * 255; },
    [](int, int, int) { return 0; },
    [](int x, int y, int time) { return (x * 255 / 96 + y + time) % 256; },
    [](int x, int y, int time) { return (x * x + y * y) / 8 * (1 + time % 3) % 256; },
    [](int x, int y, int) {
      return std::max(std::abs(x - 48), std::abs(y - 32)) % 4 < 2 ? 20 : 230;
    }};

TEST(WorstPictures, KeepWithinTheRegionsThatAreAllowed) {
  Chance chance;
  for (const std::string& line :
       {std::string(testing::kQuickStages), std::string(testing::kFrameScopeStages),
        std::string("hsvsegment max-regions=65535 min-area=1 similarity=0 ! srg connectivity=8 ! "
                    "prmmotion max-shift=8 ! mrfmerge"),
        std::string("bgremove method=paper training-frames=1 ! hsvsegment max-regions=7 "
                    "scope=areas ! srg ! prmmotion subpixel=false ! mrfmerge")}) {
    SCOPED_TRACE(line);
    const uint32_t most = line.find("65535") != std::string::npos ? 65535
                          : line.find("=7") != std::string::npos  ? 7
                                                                  : 1024;
    Chain chain(line, {"GRAY8", 96, 64});
    int index = 0;
    for (int round = campaign(25); round > 0; --round) {
      const bool isBusy = chance.isOneIn(3);
      const Level level = chance.pick(kWorst);
      for (int i = chance.between(1, 4); i > 0; --i, ++index) {
        const BufferPtr out = chain.pass(isBusy ? busyFrame(chain.caps(), index)
                                                : paint(chain.caps(), index, [=](int x, int y) {
                                                    return static_cast<uint8_t>(level(x, y, index));
                                                  }));
        ASSERT_TRUE(out);
        EXPECT_LE(findResult<segmentation::Labels>(out.get())->count, most);
      }
    }
    EXPECT_EQ(chain.complaint(GST_MESSAGE_ERROR), "");
  }
}

}  // namespace
}  // namespace rg
