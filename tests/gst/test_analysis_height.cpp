// SPDX-License-Identifier: LGPL-2.1-or-later
// Stages that look at a smaller picture, and results that are of the whole frame all the same.
#include "core/base/picture.hpp"
#include "tests/support/busy_scene.hpp"
#include "tests/support/results.hpp"
#include "tests/support/value_of.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdlib>

namespace rg {
namespace {

using testing::BufferPtr;
using testing::busyFrame;
using testing::Caps;
using testing::Chain;

constexpr int kTimes = 4;
const Caps kSmall{"GRAY8", 96, 64};
const Caps kLarge{"GRAY8", 96 * kTimes, 64 * kTimes};

/// The busy scene, each pixel of it a square: its means are the scene itself.
BufferPtr enlarged(int index) {
  const BufferPtr small = busyFrame(kSmall, index);
  const auto bytes = testing::bytesOf(small.get());
  return testing::paint(kLarge, index, [&](int x, int y) {
    return bytes[static_cast<size_t>(y / kTimes * kSmall.width + x / kTimes)];
  });
}

Box times(const Box& box) {
  return {kTimes * box.x, kTimes * box.y, kTimes * box.width, kTimes * box.height};
}

template <class T>
void expectEnlarged(const ResultPlane<T>& large, const ResultPlane<T>& small) {
  Image<T> largeScratch, smallScratch;
  const auto pixels = large.unpacked(largeScratch), expected = small.unpacked(smallScratch);
  ASSERT_EQ(pixels.size, (Size{kLarge.width, kLarge.height}));
  for (int y = 0; y < kLarge.height; ++y)
    for (int x = 0; x < kLarge.width; ++x)
      ASSERT_EQ(pixels.at(x, y), expected.at(x / kTimes, y / kTimes)) << x << ' ' << y;
}

void expectEnlarged(const objects::Objects& large, const objects::Objects& small) {
  ASSERT_EQ(large.size, (Size{kLarge.width, kLarge.height}));
  ASSERT_EQ(large.objects.size(), small.objects.size());
  for (size_t i = 0; i < small.objects.size(); ++i) {
    const objects::Object &a = large.objects[i], &b = small.objects[i];
    EXPECT_EQ(a.id, b.id);
    EXPECT_EQ(a.state, b.state);
    EXPECT_EQ(a.box, times(b.box));
    EXPECT_EQ(a.areaPx, kTimes * kTimes * b.areaPx);
    EXPECT_EQ(a.speedX, kTimes * b.speedX);
    const int half = objects::kPositionUnit / 2;  // Between the centre of a pixel and its edge.
    EXPECT_EQ(a.centroidX + half, kTimes * (b.centroidX + half));
    ASSERT_EQ(a.contour.size(), b.contour.size());
    for (size_t k = 0; k < a.contour.size(); ++k)  // From centre to centre.
      EXPECT_EQ(a.contour[k], (Point{kTimes * b.contour[k].x + kTimes / 2,
                                     kTimes * b.contour[k].y + kTimes / 2}));
  }
  expectEnlarged(large.slots, small.slots);
}

template <class Payload>
std::shared_ptr<const Payload> resultOn(const BufferPtr& buffer) {
  auto result = findResult<Payload>(buffer.get());
  EXPECT_TRUE(result);
  return result;
}

void expectEnlarged(const BufferPtr& large, const BufferPtr& small) {
  expectEnlarged(*resultOn<objects::Objects>(large), *resultOn<objects::Objects>(small));
  expectEnlarged(resultOn<segmentation::Labels>(large)->ids,
                 resultOn<segmentation::Labels>(small)->ids);
  const auto graph = resultOn<graph::Graph>(large), smallGraph = resultOn<graph::Graph>(small);
  const auto motion = resultOn<motion::Motion>(large),
             smallMotion = resultOn<motion::Motion>(small);
  ASSERT_EQ(graph->regions.size(), smallGraph->regions.size());
  for (size_t i = 0; i < graph->regions.size(); ++i) {
    EXPECT_EQ(graph->regions[i].box, times(smallGraph->regions[i].box));
    EXPECT_EQ(motion->regions[i].dx, kTimes * smallMotion->regions[i].dx);
  }
}

class AnalysisHeight : public ::testing::TestWithParam<const char*> {};

/// What is found in the means is what is found in the small frame, bit for bit, at its place.
TEST_P(AnalysisHeight, FindsWhatIsInTheSmallPictureAndTellsItInTheFrame) {
  const std::string stages = GetParam();
  std::string reduced = stages;
  for (const std::string name : {"bgremove", "hsvsegment", "regiontrack"})
    if (const size_t at = reduced.find(name); at != std::string::npos)
      reduced.insert(at + name.size(), " analysis-height=64");
  Chain small(stages, kSmall), large(reduced, kLarge);
  int seen = 0;
  for (int i = 0; i < 40; ++i) {
    const BufferPtr a = large.pass(enlarged(i)), b = small.pass(busyFrame(kSmall, i));
    ASSERT_EQ(a == nullptr, b == nullptr);
    if (!a) continue;  // Held back.
    expectEnlarged(a, b);
    ASSERT_FALSE(HasFatalFailure()) << "frame " << i;
    seen += testing::objectsOn(a.get());
  }
  EXPECT_GT(seen, 20);
}

INSTANTIATE_TEST_SUITE_P(Chains, AnalysisHeight,
                         ::testing::Values(testing::kQuickStages, testing::kFrameScopeStages,
                                           "regiontrack training-frames=2",
                                           "regiontrack training-frames=2 latency=0.2"));

TEST(AnalysisHeightTest, PropertiesInPixelsAreOfTheFrame) {
  const auto stages = [](const std::string& reduced, int times) {
    return "hsvsegment " + reduced + " min-area=" + std::to_string(60 * times * times) +
           " ! srg ! prmmotion max-shift=" + std::to_string(2 * times) + " ! mrfmerge";
  };
  Chain small(stages("", 1), kSmall), large(stages("analysis-height=64", kTimes), kLarge);
  Chain usual("hsvsegment ! srg ! prmmotion ! mrfmerge", kSmall);
  int others = 0;
  for (int i = 0; i < 20; ++i) {
    const BufferPtr a = large.pass(enlarged(i)), b = small.pass(busyFrame(kSmall, i)),
                    c = usual.pass(busyFrame(kSmall, i));
    expectEnlarged(a, b);
    ASSERT_FALSE(HasFatalFailure()) << "frame " << i;
    others +=
        resultOn<graph::Graph>(c)->regions.size() != resultOn<graph::Graph>(b)->regions.size();
  }
  EXPECT_GT(others, 10);  // Or min-area did nothing.
}

TEST(AnalysisHeightTest, FitsTheAreasOfInterest) {
  const std::string areas = " areas-of-interest=\"0,0 0.5,0 0.5,1 0,1\"";
  Chain small("regiontrack training-frames=2" + areas, kSmall);
  Chain large("regiontrack training-frames=2 analysis-height=64" + areas, kLarge);
  for (int i = 0; i < 20; ++i) {
    const BufferPtr a = large.pass(enlarged(i)), b = small.pass(busyFrame(kSmall, i));
    ASSERT_TRUE(a && b);
    expectEnlarged(resultOn<background::Foreground>(a)->mask,
                   resultOn<background::Foreground>(b)->mask);
    ASSERT_FALSE(HasFatalFailure());
  }
}

TEST(AnalysisHeightTest, ChangesNothingWhereFramesAreNotHigher) {
  for (const char* rows : {"0", "64", "65", "16384"}) {
    testing::Story plain, same;
    Chain whole(testing::kQuickStages, kSmall);
    Chain bounded(std::string("regiontrack training-frames=2 analysis-height=") + rows, kSmall);
    for (int i = 0; i < 20; ++i)
      ASSERT_EQ(same.tell(bounded.pass(busyFrame(kSmall, i)).get()),
                plain.tell(whole.pass(busyFrame(kSmall, i)).get()));
  }
}

/// Sizes that no whole number divides, gaps, and a change of size on the way.
TEST(AnalysisHeightTest, KeepsBoxesWithinOddFrames) {
  Chain chain("regiontrack training-frames=2 analysis-height=50", {"NV12", 257, 191});
  for (const Caps& caps : {Caps{"NV12", 257, 191}, {"BGR", 131, 199}, {"I420", 40, 30}}) {
    chain.setCaps(caps);
    int seen = 0;
    for (int i = 0; i < 30; ++i) {
      BufferPtr frame = busyFrame(caps, i);
      if (i % 7 == 6) GST_BUFFER_FLAG_SET(frame.get(), GST_BUFFER_FLAG_GAP);
      const BufferPtr out = chain.pass(std::move(frame));
      ASSERT_TRUE(out);
      const auto objects = resultOn<objects::Objects>(out);
      ASSERT_EQ(objects->size, (Size{caps.width, caps.height}));
      for (const objects::Object& object : objects->objects) {
        if (object.state != objects::ObjectState::Tracked) continue;
        ++seen;
        EXPECT_FALSE(intersect(object.box, boundsOf(objects->size)).isEmpty());
      }
    }
    EXPECT_GT(seen, 5) << caps.text();
  }
}

/// The busy scene in as many pixels as the stages make of a small frame.
BufferPtr asDoubled(const Caps& small, int index) {
  const BufferPtr frame = busyFrame(small, index);
  const auto bytes = testing::bytesOf(frame.get());
  const Size size{small.width, small.height};
  const std::array memory{PlaneMemory{bytes.data(), bytes.size(), size.width}};
  Picture picture, large;
  picture.load(
      valueOf(Frame::make({PixelFormat::Gray8, size, YuvMatrix::Bt601, YuvRange::Limited}, memory)),
      Executor(1));
  large.loadDoubled(picture, Executor(1));
  return testing::paint({"GRAY8", 2 * small.width, 2 * small.height}, index,
                        [&](int x, int y) { return large.luma().at(x, y); });
}

bool isHalf(const Box& small, const Box& large) {
  return std::abs(2 * small.x - large.x) <= 1 && std::abs(2 * small.y - large.y) <= 1 &&
         std::abs(2 * small.right() - large.right()) <= 1 &&
         std::abs(2 * small.bottom() - large.bottom()) <= 1;
}

TEST_P(AnalysisHeight, LooksAtSmallFramesTwiceAsLargeAndTellsItInTheFrame) {
  const Caps small{"GRAY8", 160, 120}, large{"GRAY8", 320, 240};
  const std::string stages = GetParam();
  std::string asItIs = stages;
  for (const std::string name : {"bgremove", "hsvsegment", "regiontrack"})
    if (const size_t at = asItIs.find(name); at != std::string::npos)
      asItIs.insert(at + name.size(), " analysis-height=0");
  Chain usual(stages, small), doubled(asItIs, large), plain(asItIs, small);
  int seen = 0, others = 0;
  for (int i = 0; i < 30; ++i) {
    const BufferPtr a = usual.pass(busyFrame(small, i)), b = doubled.pass(asDoubled(small, i)),
                    c = plain.pass(busyFrame(small, i));
    ASSERT_EQ(a == nullptr, b == nullptr);
    if (!a) continue;
    const auto found = resultOn<objects::Objects>(a), expected = resultOn<objects::Objects>(b);
    ASSERT_EQ(found->size, (Size{small.width, small.height}));
    ASSERT_EQ(found->objects.size(), expected->objects.size());
    for (size_t k = 0; k < found->objects.size(); ++k) {
      EXPECT_EQ(found->objects[k].id, expected->objects[k].id);
      EXPECT_TRUE(isHalf(found->objects[k].box, expected->objects[k].box)) << i << ' ' << k;
    }
    seen += testing::objectsOn(a.get());
    others +=
        testing::objectsOn(c.get()) != testing::objectsOn(a.get()) ||
        resultOn<graph::Graph>(c)->regions.size() != resultOn<graph::Graph>(a)->regions.size();
  }
  EXPECT_GT(seen, 20);
  EXPECT_GT(others, 5);  // Or nothing was doubled.
}

/// Before mrfmerge packs it, and behind it.
TEST(AnalysisHeightTest, MasksOfSmallFramesAreOfTheFrame) {
  const Caps caps{"GRAY8", 160, 120};
  const std::string learn = "bgremove training-frames=2 ! ", show = "regionmask source=foreground";
  Chain early(learn + show, caps);
  Chain late(learn + "hsvsegment ! srg ! prmmotion ! mrfmerge ! " + show, caps);
  int white = 0;
  for (int i = 0; i < 20; ++i) {
    const BufferPtr a = early.pass(busyFrame(caps, i)), b = late.pass(busyFrame(caps, i));
    ASSERT_TRUE(a && b);
    const auto bytes = testing::bytesOf(a.get());
    ASSERT_EQ(bytes.size(), size_t{160} * 120);
    EXPECT_EQ(bytes, testing::bytesOf(b.get()));
    white += static_cast<int>(std::count(bytes.begin(), bytes.end(), 255));
  }
  EXPECT_GT(white, 1000);
}

TEST(AnalysisHeightTest, OtherMethodsLookAtSmallFramesAsTheyAre) {
  for (const std::string stages : {testing::kPaperStages, testing::kDifferenceStages}) {
    const Caps caps{"GRAY8", 160, 120};
    std::string asItIs = stages;
    for (const std::string name : {"bgremove", "hsvsegment"})
      asItIs.insert(asItIs.find(name) + name.size(), " analysis-height=0");
    testing::Story usual, expected;
    Chain chain(stages, caps), other(asItIs, caps);
    int seen = 0;
    for (int i = 0; i < 30; ++i) {
      BufferPtr a = busyFrame(caps, i), b = busyFrame(caps, i);
      if (i % 7 == 6)
        for (GstBuffer* frame : {a.get(), b.get()}) GST_BUFFER_FLAG_SET(frame, GST_BUFFER_FLAG_GAP);
      a = chain.pass(std::move(a));
      b = other.pass(std::move(b));
      ASSERT_EQ(usual.tell(a.get()), expected.tell(b.get())) << stages << ' ' << i;
      seen += testing::objectsOn(a.get());
    }
    EXPECT_GT(seen, 10) << stages;
  }
}

TEST(AnalysisHeightTest, StaysAsItIsWhileRunning) {
  Chain chain("regiontrack analysis-height=64", kLarge);
  GstElement* track = chain.element("regiontrack");
  g_object_set(track, "analysis-height", 32, nullptr);
  EXPECT_NE(chain.complaint(GST_MESSAGE_WARNING).find("analysis-height stays as it was"),
            std::string::npos);
  int rows = 0;
  g_object_get(track, "analysis-height", &rows, nullptr);
  EXPECT_EQ(rows, 64);
  gst_object_unref(track);
}

}  // namespace
}  // namespace rg
