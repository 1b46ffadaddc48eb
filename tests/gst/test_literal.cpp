// SPDX-License-Identifier: LGPL-2.1-or-later
// The paper's own system, literally: bgremove method=paper, hsvsegment colour-space=hsv, prmmotion
// and mrfmerge method=literal.
#include "gst/meta/result_meta.hpp"
#include "tests/support/harness.hpp"
#include "tests/support/results.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

namespace rg {
namespace {

using testing::BufferPtr;
using testing::Caps;
using testing::Chain;
using testing::paint;
using testing::Painter;

const std::string kRest = "srg ! prmmotion method=literal max-shift=6 ! mrfmerge method=literal";
const std::string kStill =
    "bgremove method=paper training-frames=5 ! hsvsegment colour-space=hsv ! " + kRest;
const std::string kMoving = "hsvsegment colour-space=hsv scope=frame ! " + kRest;
const Caps kCaps{"I420", 96, 64};

/// A ground of tiles, and on it a square of texture that has entered by frame 10.
Painter sceneAt(int time) {
  return [time](int x, int y) -> uint8_t {
    const int left = 3 * (time - 10);
    const bool isThing = x >= left && x < left + 24 && y >= 20 && y < 44 && left > -24;
    if (isThing) return static_cast<uint8_t>(170 + (x - left) / 6 % 2 * 30 + y / 6 % 2 * 30);
    return static_cast<uint8_t>(60 + (x / 16 + y / 16) % 2 * 12 + (x * 7 + y * 13) % 3);
  };
}

BufferPtr frameAt(int time, const Caps& caps = kCaps) {
  return paint(caps, time, sceneAt(time));
}

std::shared_ptr<const objects::Objects> objectsOf(const BufferPtr& buffer) {
  return buffer ? findResult<objects::Objects>(buffer.get()) : nullptr;
}

void expectWholePixels(const BufferPtr& buffer) {
  const auto motion = findResult<motion::Motion>(buffer.get());
  ASSERT_TRUE(motion);
  for (const motion::RegionMotion& region : motion->regions) {
    EXPECT_EQ(region.dx % motion::kMotionUnit, 0);
    EXPECT_EQ(region.dy % motion::kMotionUnit, 0);
  }
}

TEST(Literal, FollowsAThingBeforeAStillCamera) {
  Chain chain(kStill, kCaps);
  int seen = 0;
  for (int time = 0; time < 32; ++time) {
    const BufferPtr out = chain.pass(frameAt(time));
    const auto objects = objectsOf(out);
    ASSERT_TRUE(objects);
    EXPECT_FALSE(objects->groundGroup);  // What is no foreground is more than any group.
    expectWholePixels(out);
    const Point middle{3 * (time - 10) + 12, 32};
    seen += std::any_of(objects->objects.begin(), objects->objects.end(),
                        [&](const objects::Object& object) { return object.box.contains(middle); });
  }
  EXPECT_GE(seen, 12);
  EXPECT_EQ(chain.complaint(GST_MESSAGE_ERROR), "");
  EXPECT_EQ(chain.complaint(GST_MESSAGE_WARNING), "");
}

TEST(Literal, TakesTheLargestGroupOfTheWholeFrameForTheBackground) {
  Chain chain(kMoving, kCaps);
  for (int time = 12; time < 24; ++time) {
    const BufferPtr out = chain.pass(frameAt(time));
    const auto objects = objectsOf(out);
    const auto graph = findResult<graph::Graph>(out.get());
    ASSERT_TRUE(objects && graph);
    ASSERT_TRUE(objects->groundGroup) << time;
    EXPECT_TRUE(objects->ground.empty());
    std::vector<uint32_t> areas(objects->regionGroup.size() + 1, 0);
    for (size_t i = 0; i < objects->regionGroup.size(); ++i)
      areas[objects->regionGroup[i].number()] += graph->regions[i].areaPx;
    EXPECT_EQ(areas[objects->groundGroup.number()], *std::max_element(areas.begin(), areas.end()));
    expectWholePixels(out);
  }
}

TEST(Literal, SurvivesNewCapsFlushesAndRestartsWithThingsInView) {
  for (const std::string& line : {kStill, kMoving}) {
    Chain chain(line, kCaps);
    const auto show = [&](const Caps& caps) {
      for (int time = 0; time < 20; ++time) ASSERT_TRUE(objectsOf(chain.pass(frameAt(time, caps))));
    };
    show(kCaps);
    gst_harness_push_event(chain.harness(), gst_event_new_flush_start());
    gst_harness_push_event(chain.harness(), gst_event_new_flush_stop(TRUE));
    GstSegment segment;
    gst_segment_init(&segment, GST_FORMAT_TIME);
    gst_harness_push_event(chain.harness(), gst_event_new_segment(&segment));
    show(kCaps);
    for (const Caps& caps : {Caps{"BGRx", 101, 47}, Caps{"GRAY8", 64, 64}, Caps{"I420", 1, 1}}) {
      chain.setCaps(caps);
      show(caps);
    }
    EXPECT_EQ(chain.complaint(GST_MESSAGE_ERROR), "");
  }
}

/// Sets a property of an element of the chain by its nick.
void set(const Chain& chain, const char* factory, const char* property, const char* nick) {
  GstElement* element = chain.element(factory);
  gst_util_set_object_arg(G_OBJECT(element), property, nick);
  gst_object_unref(element);
}

TEST(Literal, MayChangeWhilePlaying) {
  Chain chain("bgremove ! hsvsegment ! srg ! prmmotion max-shift=6 ! mrfmerge", kCaps);
  for (int time = 0; time < 40; ++time) {
    const bool isLiteral = time / 4 % 2 != 0;
    set(chain, "hsvsegment", "colour-space", isLiteral ? "hsv" : "rgb");
    set(chain, "prmmotion", "method", isLiteral ? "literal" : "refined");
    set(chain, "mrfmerge", "method", isLiteral ? "literal" : "extended");
    const BufferPtr out = chain.pass(frameAt(time));
    ASSERT_TRUE(objectsOf(out));
    if (isLiteral) expectWholePixels(out);
  }
  EXPECT_EQ(chain.complaint(GST_MESSAGE_ERROR), "");
}

TEST(Literal, RegiontracksMethodIsThatOfBgremove) {
  GstElement* bin = gst_element_factory_make("regiontrack", nullptr);
  gst_util_set_object_arg(G_OBJECT(bin), "method", "paper");
  gst_util_set_object_arg(G_OBJECT(bin), "colour-space", "hsv");
  int bgremove = -1, prmmotion = -1, mrfmerge = -1, space = -1;
  auto* proxy = GST_CHILD_PROXY(bin);
  gst_child_proxy_get(proxy, "bgremove::method", &bgremove, "prmmotion::method", &prmmotion,
                      "mrfmerge::method", &mrfmerge, "hsvsegment::colour-space", &space, nullptr);
  EXPECT_EQ(bgremove, static_cast<int>(background::Method::Paper));
  EXPECT_EQ(prmmotion, static_cast<int>(motion::Method::Refined));
  EXPECT_EQ(mrfmerge, static_cast<int>(objects::Method::Extended));
  EXPECT_EQ(space, static_cast<int>(segmentation::ColourSpace::Hsv));
  gst_child_proxy_set(proxy, "mrfmerge::method", objects::Method::Literal, nullptr);
  gst_child_proxy_get(proxy, "mrfmerge::method", &mrfmerge, nullptr);
  EXPECT_EQ(mrfmerge, static_cast<int>(objects::Method::Literal));
  gst_object_unref(bin);
}

}  // namespace
}  // namespace rg
