// SPDX-License-Identifier: LGPL-2.1-or-later
// Other caps in the middle of a stream, with objects in view, and caps that nobody should believe.
#include "gst/meta/result_meta.hpp"
#include "tests/support/busy_scene.hpp"

#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace rg {
namespace {

using testing::BufferPtr;
using testing::busyFrame;
using testing::campaign;
using testing::Caps;
using testing::Chain;
using testing::Chance;
using testing::objectsOn;
using testing::showObjects;
using testing::Story;

const Caps kUsual{"GRAY8", 96, 64};

Caps someCaps(Chance& chance) {
  Caps caps;
  caps.format = chance.pick(testing::kAllFormats);
  constexpr std::pair<int, int> kSizes[] = {{1, 1},   {1, 90},  {120, 1},  {2, 2},
                                            {3, 3},   {15, 17}, {127, 33}, {64, 48},
                                            {48, 64}, {96, 72}, {97, 64}};
  const auto& [width, height] = chance.pick(kSizes);
  const bool isListed = !chance.isOneIn(3);
  caps.width = isListed ? width : chance.between(1, 130);
  caps.height = isListed ? height : chance.between(1, 100);
  return caps;
}

class NewCaps : public ::testing::TestWithParam<const char*> {};

/// Whatever comes before, a frame of another size or format begins anew: what is said from there on
/// is what a chain says that never saw anything else.
TEST_P(NewCaps, TheStoryAfterwardsIsThatOfAFreshChain) {
  Chance chance;
  Chain chain(GetParam(), kUsual);
  int index = 0, inView = 0;
  std::optional<Caps> before;
  for (int round = campaign(12); round > 0; --round) {
    Caps caps = round % 4 == 0 ? kUsual : someCaps(chance);
    if (before && before->text() == caps.text()) ++caps.width;
    before = caps;
    SCOPED_TRACE(caps.text());
    chain.setCaps(caps);
    Chain fresh(GetParam(), caps);
    Story story, expected;
    const int frames = round % 4 == 0 ? 20 : chance.between(1, 20);
    for (int i = 0; i < frames; ++i, ++index) {
      const BufferPtr out = chain.pass(busyFrame(caps, index));
      ASSERT_TRUE(out);
      const std::string said = story.tell(out.get());
      ASSERT_EQ(said, expected.tell(fresh.pass(busyFrame(caps, index)).get())) << "frame " << i;
      inView += objectsOn(out.get());
    }
  }
  EXPECT_GT(inView, 0);
  EXPECT_EQ(chain.complaint(GST_MESSAGE_ERROR), "");
}

INSTANTIATE_TEST_SUITE_P(Stages, NewCaps,
                         ::testing::Values(testing::kQuickStages, testing::kFrameScopeStages,
                                           testing::kDifferenceStages, testing::kPaperStages));

/// All elements that follow the stages take part, and memory goes back to where it was.
TEST(NewCapsEverywhere, LeaveNothingBehind) {
  Chance chance;
  const std::string overlay = gst_element_factory_find("regionoverlay") ? "regionoverlay ! " : "";
  Chain chain(std::string(testing::kQuickStages) +
                  " latency=0.1 ! regionwrite format=graph location=/dev/null ! " + overlay +
                  "regionmask source=objects",
              kUsual);
  int index = 0;
  std::vector<size_t> levels;
  for (int round = 0; round < campaign(60); ++round) {
    chain.setCaps(round % 10 == 9 ? kUsual : someCaps(chance));
    for (int i = round % 10 == 9 ? 12 : chance.between(1, 12); i > 0; --i)
      ASSERT_EQ(chain.push(busyFrame(chain.caps(), index++)), GST_FLOW_OK) << chain.caps().text();
    while (GstBuffer* out = gst_harness_try_pull(chain.harness())) gst_buffer_unref(out);
    while (chain.message(GST_MESSAGE_ELEMENT)) continue;
    while (GstEvent* event = gst_harness_try_pull_event(chain.harness())) gst_event_unref(event);
    if (round % 10 == 9) levels.push_back(testing::heapBytes());
  }
  EXPECT_EQ(chain.complaint(GST_MESSAGE_ERROR), "");
  testing::expectPlateau(levels, size_t{1} << 20);
}

/// What was learnt is kept where only the rate, the shape of pixels or nothing at all changes.
TEST(SameCaps, KeepWhatWasLearnt) {
  const std::string size = "video/x-raw,format=GRAY8,width=96,height=64,framerate=";
  for (const std::string& again :
       {size + "25/1", size + "5/1", size + "0/1", size + "25/1,pixel-aspect-ratio=4/3"}) {
    SCOPED_TRACE(again);
    Chain chain(testing::kQuickStages, kUsual), other(testing::kQuickStages, kUsual);
    int index = 0, otherIndex = 0;
    ASSERT_TRUE(showObjects(chain, index));
    ASSERT_TRUE(showObjects(other, otherIndex));
    ASSERT_TRUE(testing::sendCaps(chain, again));
    Story story, expected;
    for (int i = 0; i < 8; ++i, ++index) {
      const BufferPtr out = chain.pass(busyFrame(kUsual, index));
      EXPECT_GT(objectsOn(out.get()), 0);
      EXPECT_EQ(story.tell(out.get()), expected.tell(other.pass(busyFrame(kUsual, index)).get()));
    }
  }
}

TEST(SameCaps, OtherColorimetryBeginsAnew) {
  const std::string caps = "video/x-raw,format=I420,width=96,height=64,framerate=25/1";
  const Caps frames{"I420", 96, 64};
  Chain chain(testing::kQuickStages, frames), fresh(testing::kQuickStages, frames);
  int index = 0;
  ASSERT_TRUE(showObjects(chain, index));
  for (Chain* each : {&chain, &fresh})
    ASSERT_TRUE(testing::sendCaps(*each, caps + ",colorimetry=bt709"));
  Story story, expected;
  for (int i = 0; i < 12; ++i, ++index)
    EXPECT_EQ(story.tell(chain.pass(busyFrame(frames, index)).get()),
              expected.tell(fresh.pass(busyFrame(frames, index)).get()));
}

/// Objects in view at every size that is too small or too odd for a loop over blocks.
TEST(OddSizes, TheWholeChainTakesThemInEveryFormat) {
  Chance chance;
  for (const char* format : testing::kAllFormats)
    for (int round = 0; round < campaign(2); ++round) {
      const Caps caps{format, chance.between(1, 70), chance.between(1, 70)};
      SCOPED_TRACE(caps.text());
      Chain chain(round % 2 == 0 ? testing::kQuickStages : testing::kFrameScopeStages, caps);
      for (int i = 0; i < 8; ++i) ASSERT_TRUE(chain.pass(busyFrame(caps, i)));
      EXPECT_EQ(chain.complaint(GST_MESSAGE_ERROR), "");
    }
}

TEST(BadCaps, AreRefusedWithObjectsInView) {
  Chain chain(testing::kQuickStages, kUsual);
  int index = 0;
  ASSERT_TRUE(showObjects(chain, index));
  const std::string frame = "video/x-raw,format=GRAY8,framerate=25/1,";
  for (const std::string& caps :
       {frame + "width=2147483647,height=1", frame + "width=1,height=2147483647",
        frame + "width=46341,height=46341", frame + "width=65535,height=65535",
        frame + "width=16384,height=16384", frame + "width=-1,height=4", frame + "width=0,height=0",
        frame + "width=64", frame + "height=48", frame + "width=(string)a,height=48",
        std::string("video/x-raw,width=64,height=48,framerate=25/1"),
        std::string("video/x-raw,format=none,width=64,height=48,framerate=25/1"),
        std::string("video/x-raw,format=ENCODED,width=64,height=48,framerate=25/1"),
        std::string("video/x-raw(memory:DMABuf),format=GRAY8,width=64,height=48,framerate=25/1"),
        std::string("video/x-raw(memory:GLMemory),format=RGBA,width=64,height=48,framerate=25/1"),
        std::string(
            "video/x-raw(memory:CUDAMemory),format=GRAY8,width=64,height=48,framerate=25/1"),
        std::string("audio/x-raw,format=S16LE,rate=8000,channels=1,layout=interleaved"),
        std::string("image/jpeg,width=64,height=48")}) {
    SCOPED_TRACE(caps);
    (void)testing::sendCaps(chain, caps);
    EXPECT_EQ(chain.push(busyFrame(kUsual, index)), GST_FLOW_NOT_NEGOTIATED);
    chain.setCaps(kUsual);
    EXPECT_TRUE(showObjects(chain, index));
  }
}

/// What libgstvideo itself lets pass is either refused or processed, and the next good caps work.
TEST(BadCaps, OddValuesDoNoHarm) {
  const std::string frame = "video/x-raw,format=GRAY8,width=96,height=64";
  Chain chain(testing::kQuickStages, kUsual);
  int index = 0;
  ASSERT_TRUE(showObjects(chain, index));
  for (const char* rest :
       {",framerate=2147483647/1", ",framerate=1/2147483647", ",framerate=-1/1", ",framerate=1/0",
        "", ",framerate=25/1,pixel-aspect-ratio=0/1", ",framerate=25/1,pixel-aspect-ratio=1/0",
        ",framerate=25/1,interlace-mode=bogus", ",framerate=25/1,colorimetry=bogus",
        ",framerate=25/1,colorimetry=255:255:255:255", ",framerate=25/1,views=200",
        ",framerate=25/1,multiview-mode=side-by-side", ",framerate=25/1,chroma-site=bogus"}) {
    SCOPED_TRACE(rest);
    (void)testing::sendCaps(chain, frame + rest);
    for (int i = 0; i < 3; ++i) (void)chain.pass(busyFrame(kUsual, index++));
    chain.setCaps(kUsual);
    ASSERT_TRUE(showObjects(chain, index));
  }
}

/// Caps that a source invented: every frame is shorter than they say, passes and is counted.
TEST(BadCaps, LargerThanTheFramesAreCountedNotBelieved) {
  Chain chain(testing::kQuickStages, kUsual);
  int index = 0;
  ASSERT_TRUE(showObjects(chain, index));
  chain.setCaps({"GRAY8", 1920, 1080});
  for (int i = 0; i < 5; ++i) {
    const BufferPtr out = chain.pass(busyFrame(kUsual, index++));
    ASSERT_TRUE(out);
    EXPECT_EQ(findResult<objects::Objects>(out.get())->status, Status::Skipped);
  }
  GstElement* element = chain.element("bgremove");
  guint64 bad = 0;
  g_object_get(element, "bad-buffers", &bad, nullptr);
  EXPECT_EQ(bad, 5u);
  gst_object_unref(element);
  chain.setCaps(kUsual);
  EXPECT_TRUE(showObjects(chain, index));
}

}  // namespace
}  // namespace rg
