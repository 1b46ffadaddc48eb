// SPDX-License-Identifier: LGPL-2.1-or-later
// Frames that videocrop shows a part of, before and behind the stages, with objects in view.
#include "core/objects/objects.hpp"
#include "core/text/text.hpp"
#include "gst/meta/result_meta.hpp"
#include "tests/support/busy_scene.hpp"

#include <gtest/gtest.h>

#include <array>
#include <string>
#include <vector>

namespace rg {
namespace {

using testing::BufferPtr;
using testing::busyFrame;
using testing::Caps;
using testing::Chain;
using testing::objectsOn;

const Caps kCaps{"I420", 96, 64};
constexpr Box kPart{14, 6, 60, 48};
const std::string kCrop = " ! videocrop left=14 top=6 right=22 bottom=10 ! ";
const std::string kStages = testing::kQuickStages;
constexpr int kFrames = 30;

/// Has downstream take frames of which a meta shows a part, as sinks do that scale by themselves.
void takeCrops(Chain& chain) {
  gst_harness_add_propose_allocation_meta(chain.harness(), GST_VIDEO_META_API_TYPE, nullptr);
  gst_harness_add_propose_allocation_meta(chain.harness(), GST_VIDEO_CROP_META_API_TYPE, nullptr);
  gst_harness_push_upstream_event(chain.harness(), gst_event_new_reconfigure());
}

/// Levels of a mask's rows.
std::vector<uint8_t> rowsOf(GstBuffer* mask, Size size, const Box& part) {
  const auto bytes = testing::bytesOf(mask);
  const auto stride = static_cast<size_t>(GST_ROUND_UP_4(size.width));
  std::vector<uint8_t> rows;
  for (int y = part.y; y < part.bottom(); ++y)
    for (int x = part.x; x < part.right(); ++x)
      rows.push_back(bytes[static_cast<size_t>(y) * stride + static_cast<size_t>(x)]);
  return rows;
}

TEST(Crops, MasksAndMetasBehindThemAreOfThePart) {
  Chain whole(kStages + " ! regionmask source=objects", kCaps);
  Chain part(kStages + kCrop + "regionmask source=objects", kCaps);
  int inView = 0;
  for (int i = 0; i < kFrames; ++i) {
    const BufferPtr a = whole.pass(busyFrame(kCaps, i)), b = part.pass(busyFrame(kCaps, i));
    ASSERT_TRUE(a && b);
    const auto seen = rowsOf(a.get(), {96, 64}, kPart);
    ASSERT_EQ(rowsOf(b.get(), {60, 48}, {0, 0, 60, 48}), seen);
    EXPECT_FALSE(gst_buffer_get_video_crop_meta(b.get()));
    const auto shown = findResult<objects::Objects>(b.get());
    EXPECT_EQ(shown->size, (Size{60, 48}));
    for (const objects::Object& object : shown->objects)
      for (const objects::Object& other : findResult<objects::Objects>(a.get())->objects) {
        if (other.id != object.id) continue;
        EXPECT_EQ(object.box,
                  (Box{other.box.x - 14, other.box.y - 6, other.box.width, other.box.height}));
        inView += objects::isListed(object.state);
      }
  }
  EXPECT_GT(inView, 0);
  EXPECT_EQ(part.complaint(GST_MESSAGE_WARNING), "");
}

/// What the lines of a frame are where its part is shown.
std::string lineOfPart(GstBuffer* frame, int index) {
  const auto shown =
      objects::place(findResult<objects::Objects>(frame), objects::Placement{{96, 64}, kPart});
  text::FrameStamp stamp;
  stamp.number = static_cast<uint64_t>(index) + 1;
  stamp.size = {kPart.width, kPart.height};
  stamp.ptsNs = GST_BUFFER_PTS(frame);
  std::string line;
  text::appendJson(line, *shown, stamp, text::Contours::Write);
  return line;
}

TEST(Crops, LinesBehindThemAreOfThePart) {
  Chain whole(kStages, kCaps), part(kStages + kCrop + "regiontext contours=true", kCaps);
  int inView = 0;
  for (int i = 0; i < kFrames; ++i) {
    const BufferPtr a = whole.pass(busyFrame(kCaps, i)), b = part.pass(busyFrame(kCaps, i));
    ASSERT_TRUE(a && b);
    const auto bytes = testing::bytesOf(b.get());
    ASSERT_EQ(std::string(bytes.begin(), bytes.end()), lineOfPart(a.get(), i));
    inView += objectsOn(a.get());
  }
  EXPECT_GT(inView, 0);
}

/// regionwrite passes frames on: it follows where what comes behind it does.
TEST(Crops, AreWrittenWhereDownstreamTakesThem) {
  const std::string write = "regionwrite location=/dev/null ";
  Chain chain(kStages + kCrop + write, kCaps);
  takeCrops(chain);
  for (int i = 0; i < 5; ++i) {
    const BufferPtr out = chain.pass(busyFrame(kCaps, i));
    ASSERT_TRUE(out);
    const GstVideoCropMeta* crop = gst_buffer_get_video_crop_meta(out.get());
    ASSERT_TRUE(crop);
    EXPECT_EQ(crop->x, 14u);
  }
  EXPECT_EQ(chain.complaint(GST_MESSAGE_ERROR), "");
  Chain copying(kStages + kCrop + write, kCaps);
  EXPECT_EQ(copying.push(busyFrame(kCaps, 0)), GST_FLOW_ERROR);
  EXPECT_NE(copying.complaint(GST_MESSAGE_ERROR).find("lost after mrfmerge"), std::string::npos);
}

/// Stages look at pixels: in front of them, videocrop makes frames of the part.
TEST(Crops, BeforeTheStagesAreCopied) {
  Chain chain("videocrop left=14 top=6 right=22 bottom=10 ! " + kStages, kCaps);
  takeCrops(chain);
  int inView = 0;
  for (int i = 0; i < kFrames; ++i) {
    const BufferPtr out = chain.pass(busyFrame(kCaps, i));
    ASSERT_TRUE(out);
    EXPECT_FALSE(gst_buffer_get_video_crop_meta(out.get()));
    EXPECT_EQ(findResult<objects::Objects>(out.get())->size, (Size{60, 48}));
    inView += objectsOn(out.get());
  }
  EXPECT_GT(inView, 0);
  EXPECT_EQ(chain.complaint(GST_MESSAGE_WARNING), "");
}

/// A meta that contradicts the caps shows nothing; the frame is read as before.
TEST(Crops, ThatLieAreNotBelieved) {
  Chain stages(kStages, kCaps), text("regiontext", kCaps), other("regiontext", kCaps);
  const auto objectsIn = [](const BufferPtr& said) {
    const auto bytes = testing::bytesOf(said.get());
    const std::string line(bytes.begin(), bytes.end());
    return line.substr(line.find("\"objects\""));
  };
  size_t inView = 0;
  constexpr guint kFar = G_MAXUINT - 3;
  for (int i = 0; i < kFrames; ++i) {
    const BufferPtr frame = stages.pass(busyFrame(kCaps, i));
    ASSERT_TRUE(frame);
    const std::string usual = objectsIn(other.pass(BufferPtr(gst_buffer_copy(frame.get()))));
    inView += usual.find("\"id\"") != std::string::npos;
    for (const auto& [x, y, width, height] : {std::array{0u, 0u, 0u, 0u},
                                              {kFar, 0u, 96u, 64u},
                                              {0u, kFar, kFar, kFar},
                                              {1u, 0u, 96u, 64u},
                                              {0u, 0u, 60u, 48u},
                                              {0u, 0u, 16000u, 16000u}}) {
      BufferPtr lying(gst_buffer_copy(frame.get()));
      GstVideoCropMeta* crop = gst_buffer_add_video_crop_meta(lying.get());
      crop->x = x;
      crop->y = y;
      crop->width = width;
      crop->height = height;
      EXPECT_EQ(objectsIn(text.pass(std::move(lying))), usual);
    }
  }
  EXPECT_GT(inView, 0u);
  EXPECT_EQ(text.complaint(GST_MESSAGE_ERROR), "");
}

}  // namespace
}  // namespace rg
