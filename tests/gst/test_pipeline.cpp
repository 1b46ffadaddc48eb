// SPDX-License-Identifier: LGPL-2.1-or-later
// The five elements together on a scene with known objects.
#include "core/base/pixel.hpp"
#include "gst/meta/gstregiongraph.h"
#include "gst/meta/result_meta.hpp"
#include "tests/support/harness.hpp"

#include <gst/video/gstvideometa.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace rg {
namespace {

using testing::BufferPtr;
using testing::Caps;
using testing::Chain;
using testing::MessagePtr;

constexpr const char* kPipeline = "bgremove ! hsvsegment ! srg ! prmmotion ! mrfmerge";
constexpr int kFirstVisible = 25;
constexpr int kFrames = 75;

/// Two bodies that cross the picture in lanes of their own, over a textured background with noise.
Box bodyAt(int which, int frame) {
  const int step = frame - kFirstVisible;
  return which == 0 ? Box{3 * step - 20, 40, 22, 48} : Box{320 - 4 * step, 140, 26, 56};
}

testing::Painter scene(int frame) {
  return [frame](int x, int y) -> uint8_t {
    const auto px = static_cast<uint32_t>(x), py = static_cast<uint32_t>(y);
    const int noise = static_cast<int>(mixHash(px, py, static_cast<uint32_t>(frame)) % 5) - 2;
    int value = 90 + static_cast<int>(mixHash(px / 6, py / 6, 7) % 24);
    for (int i = 0; i < 2 && frame >= kFirstVisible; ++i) {
      const Box body = bodyAt(i, frame);
      if (!body.contains({x, y})) continue;
      const auto bx = static_cast<uint32_t>(x - body.x), by = static_cast<uint32_t>(y - body.y);
      value = (i == 0 ? 190 : 25) + static_cast<int>(mixHash(bx / 4, by / 4, 99) % 20);
    }
    return static_cast<uint8_t>(value + noise);
  };
}

double overlap(const Box& a, const Box& b) {
  const auto common = static_cast<double>(intersect(a, b).area());
  return common / (static_cast<double>(a.area() + b.area()) - common);
}

bool isSeen(const objects::Object& object) {
  return object.state == objects::ObjectState::Tracked ||
         object.state == objects::ObjectState::Stopped;
}

TEST(Pipeline, FindsTheTwoBodiesAndKeepsTheirNumbers) {
  const Caps caps{"GRAY8", 320, 240};
  Chain chain(kPipeline, caps);
  std::map<int, std::set<uint64_t>> idsOf;
  int expected = 0, found = 0, wrong = 0;
  for (int frame = 0; frame < kFrames; ++frame) {
    const BufferPtr out = chain.pass(testing::paint(caps, frame, scene(frame)));
    ASSERT_TRUE(out);
    const auto objects = findResult<objects::Objects>(out.get());
    ASSERT_TRUE(objects);
    size_t used = 0;
    for (int which = 0; which < 2; ++which) {
      const Box truth = bodyAt(which, frame);
      if (frame < kFirstVisible + 15 || intersect(truth, {0, 0, 320, 240}) != truth) continue;
      ++expected;
      for (const objects::Object& object : objects->objects)
        if (isSeen(object) && overlap(object.box, truth) >= 0.5) {
          ++found;
          ++used;
          idsOf[which].insert(object.id);
        }
    }
    if (frame >= kFirstVisible + 15)
      wrong +=
          static_cast<int>(std::count_if(objects->objects.begin(), objects->objects.end(), isSeen) -
                           static_cast<std::ptrdiff_t>(used));
  }
  ASSERT_GT(expected, 60);
  EXPECT_GE(found, expected * 95 / 100);
  EXPECT_LE(wrong, expected / 20);
  EXPECT_EQ(idsOf[0].size(), 1u);
  EXPECT_EQ(idsOf[1].size(), 1u);
  EXPECT_NE(idsOf[0], idsOf[1]);
}

TEST(Pipeline, RegionOfInterestMetasRepeatTheObjects) {
  const Caps caps{"GRAY8", 320, 240};
  Chain chain(kPipeline, caps);
  BufferPtr out;
  for (int frame = 0; frame < 60; ++frame)
    out = chain.pass(testing::paint(caps, frame, scene(frame)));
  const auto objects = findResult<objects::Objects>(out.get());
  gpointer state = nullptr;
  int count = 0;
  while (GstMeta* meta = gst_buffer_iterate_meta_filtered(
             out.get(), &state, GST_VIDEO_REGION_OF_INTEREST_META_API_TYPE)) {
    auto* roi = reinterpret_cast<GstVideoRegionOfInterestMeta*>(meta);
    gint id = 0;
    EXPECT_TRUE(gst_structure_get_int(gst_video_region_of_interest_meta_get_param(roi, "object_id"),
                                      "id", &id));
    const auto object =
        std::find_if(objects->objects.begin(), objects->objects.end(),
                     [&](const objects::Object& o) { return o.id == static_cast<uint64_t>(id); });
    ASSERT_NE(object, objects->objects.end());
    const Box visible = intersect(object->box, {0, 0, 320, 240});
    EXPECT_EQ((Box{static_cast<int>(roi->x), static_cast<int>(roi->y), static_cast<int>(roi->w),
                   static_cast<int>(roi->h)}),
              visible);
    const GstStructure* detection = gst_video_region_of_interest_meta_get_param(roi, "detection");
    ASSERT_NE(detection, nullptr);
    gdouble left = -1;
    EXPECT_TRUE(gst_structure_get_double(detection, "x_min", &left));
    EXPECT_DOUBLE_EQ(left, visible.x / 320.0);
#ifndef REGIONGRAPH_HAS_ANALYTICS  // Else it is the detection's: test_detections.cpp.
    EXPECT_EQ(id, roi->id);
#endif
    ++count;
  }
  EXPECT_EQ(count, 2);
}

std::vector<std::string> elementMessages(Chain& chain) {
  std::vector<std::string> names;
  while (const MessagePtr message = chain.message(GST_MESSAGE_ELEMENT))
    names.emplace_back(gst_structure_get_name(gst_message_get_structure(message.get())));
  return names;
}

TEST(Pipeline, TellsTheBeginningAndTheEndOfObjects) {
  const Caps caps{"GRAY8", 320, 240};
  Chain chain(kPipeline, caps);
  for (int frame = 0; frame < 60; ++frame)
    (void)chain.pass(testing::paint(caps, frame, scene(frame)));
  const auto during = elementMessages(chain);
  const auto count = [](const auto& names, const char* name) {
    return std::count(names.begin(), names.end(), name);
  };
  EXPECT_EQ(count(during, "regiongraph-object-new"), 2);
  EXPECT_EQ(count(during, "regiongraph-object-end"), 0);
  gst_harness_push_event(chain.harness(), gst_event_new_eos());
  EXPECT_EQ(count(elementMessages(chain), "regiongraph-object-end"), 2);
}

TEST(Pipeline, DarknessIsToldOnTheBusAndInTheMeta) {
  const Caps caps{"GRAY8", 160, 120};
  Chain chain("bgremove", caps);
  const auto show = [&](int frame, int gain) {
    return chain.pass(testing::paint(caps, frame, [=](int x, int y) {
      return static_cast<uint8_t>(gain * (60 + (x / 9 + y / 7) % 5 * 30));
    }));
  };
  for (int frame = 0; frame < 20; ++frame) (void)show(frame, 1);
  EXPECT_TRUE(elementMessages(chain).empty());
  const BufferPtr dark = show(20, 0);
  const auto sceneEvent = [](GstBuffer* buffer) {
    return gst_region_foreground_meta_get_scene_event(gst_buffer_get_region_foreground_meta(buffer),
                                                      nullptr, nullptr);
  };
  EXPECT_EQ(sceneEvent(dark.get()), GST_REGION_SCENE_EVENT_TOO_DARK);
  EXPECT_EQ(elementMessages(chain), std::vector<std::string>{"regiongraph-too-dark"});
  EXPECT_EQ(sceneEvent(show(21, 0).get()), GST_REGION_SCENE_EVENT_NONE);
  EXPECT_EQ(sceneEvent(show(22, 1).get()), GST_REGION_SCENE_EVENT_BRIGHT_AGAIN);
  EXPECT_EQ(elementMessages(chain), std::vector<std::string>{"regiongraph-too-dark"});
}

TEST(Pipeline, ACameraThatIsTurnedIsToldOnTheBusAndInTheMetaAndTheWholeFrameIsDivided) {
  const Caps caps{"GRAY8", 160, 120};
  Chain chain("bgremove camera=auto ! hsvsegment", caps);
  const auto show = [&](int frame, int shift) {
    return chain.pass(testing::paint(caps, frame, [=](int x, int y) {
      return static_cast<uint8_t>(
          40 +
          mixHash(static_cast<uint32_t>(x + shift) / 9, static_cast<uint32_t>(y) / 9, 5) % 160);
    }));
  };
  const auto scopeOf = [](GstBuffer* buffer) {
    return gst_region_labels_meta_get_scope(gst_buffer_get_region_labels_meta(buffer));
  };
  const auto isMoving = [](GstBuffer* buffer) {
    return gst_region_foreground_meta_is_camera_moving(
        gst_buffer_get_region_foreground_meta(buffer));
  };
  for (int frame = 0; frame < 30; ++frame) (void)show(frame, 0);
  EXPECT_TRUE(elementMessages(chain).empty());
  const BufferPtr before = show(30, 0);
  EXPECT_FALSE(isMoving(before.get()));
  EXPECT_EQ(scopeOf(before.get()), GST_REGION_SCOPE_FOREGROUND);
  BufferPtr during;
  for (int frame = 31; frame < 40; ++frame) during = show(frame, 20 * (frame - 30));
  EXPECT_TRUE(isMoving(during.get()));
  EXPECT_EQ(scopeOf(during.get()), GST_REGION_SCOPE_FRAME);
  EXPECT_EQ(elementMessages(chain), std::vector<std::string>{"regiongraph-camera-moving"});
  BufferPtr after;
  for (int frame = 40; frame < 70; ++frame) after = show(frame, 20 * 9);
  EXPECT_FALSE(isMoving(after.get()));
  EXPECT_EQ(scopeOf(after.get()), GST_REGION_SCOPE_FOREGROUND);
  const MessagePtr message = chain.message(GST_MESSAGE_ELEMENT);
  ASSERT_TRUE(message);
  gboolean moving = TRUE;
  const GstStructure* fields = gst_message_get_structure(message.get());
  EXPECT_STREQ(gst_structure_get_name(fields), "regiongraph-camera-moving");
  EXPECT_TRUE(gst_structure_get_boolean(fields, "moving", &moving));
  EXPECT_FALSE(moving);
}

TEST(Pipeline, AMovingCameraIsTold) {
  const Caps caps{"GRAY8", 160, 120};
  Chain chain("hsvsegment ! srg ! prmmotion ! mrfmerge", caps);
  const auto panned = [](int shift) {
    return [shift](int x, int y) -> uint8_t {
      return static_cast<uint8_t>(
          40 +
          mixHash(static_cast<uint32_t>(x + shift) / 9, static_cast<uint32_t>(y) / 9, 5) % 160);
    };
  };
  BufferPtr out;
  for (int frame = 0; frame < 4; ++frame)
    out = chain.pass(testing::paint(caps, frame, panned(3 * frame)));
  const auto objects = findResult<objects::Objects>(out.get());
  EXPECT_NEAR(objects->cameraDx / double{motion::kMotionUnit}, -3.0, 0.25);
  EXPECT_NEAR(objects->cameraDy / double{motion::kMotionUnit}, 0.0, 0.25);
  const auto names = elementMessages(chain);
  EXPECT_EQ(std::count(names.begin(), names.end(), "regiongraph-background-motion"), 1);
}

}  // namespace
}  // namespace rg
