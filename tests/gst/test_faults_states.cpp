// SPDX-License-Identifier: LGPL-2.1-or-later
// Changes of state in any order, during a push, and after a start that failed; many instances.
#include "tests/support/busy_scene.hpp"
#include "tests/support/cascade_files.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace rg {
namespace {

using testing::beginStream;
using testing::BufferPtr;
using testing::busyFrame;
using testing::campaign;
using testing::Caps;
using testing::Chain;
using testing::Chance;
using testing::showObjects;
using testing::Story;
using testing::Watchdog;

const Caps kSmall{"I420", 96, 64};
constexpr GstState kStates[] = {GST_STATE_NULL, GST_STATE_READY, GST_STATE_PAUSED,
                                GST_STATE_PLAYING};

/// All elements in a row; what comes out are frames, with the metas of all stages.
std::string everything() {
  const bool hasOverlay = gst_element_factory_find("regionoverlay") != nullptr;
  return std::string(testing::kQuickStages) + " ! regionwrite location=/dev/null" +
         (hasOverlay ? " ! regionoverlay" : "");
}

void setState(Chain& chain, GstState state) {
  EXPECT_EQ(gst_element_set_state(chain.harness()->element, state), GST_STATE_CHANGE_SUCCESS);
}

/// What a chain says of the first frames, those that it holds back included.
std::string storyOf(Chain& chain, int frames = 14) {
  for (int i = 0; i < frames; ++i)
    EXPECT_EQ(chain.push(busyFrame(chain.caps(), i)), GST_FLOW_OK) << "frame " << i;
  gst_harness_push_event(chain.harness(), gst_event_new_eos());
  std::string told;
  Story story;
  while (const BufferPtr out{gst_harness_try_pull(chain.harness())}) told += story.tell(out.get());
  return told;
}

/// From NULL on, the chain must say of the next frames what a fresh one says.
void expectFreshStory(Chain& chain, const std::string& line) {
  setState(chain, GST_STATE_NULL);
  setState(chain, GST_STATE_PLAYING);
  beginStream(chain);
  while (GstBuffer* old = gst_harness_try_pull(chain.harness())) gst_buffer_unref(old);
  Chain fresh(line, chain.caps());
  const std::string expected = storyOf(fresh);
  EXPECT_NE(expected.find("object 1"), std::string::npos) << expected;
  EXPECT_EQ(storyOf(chain), expected);
}

/// Each change between two of the four states, for each element alone.
TEST(States, EveryElementMakesEveryChange) {
  constexpr int kOrder[] = {1, 0, 2, 0, 3, 1, 2, 1, 3, 2, 3, 0};
  const testing::CascadeFile cascade;
  for (const char* name :
       {"bgremove", "hsvsegment", "srg", "prmmotion", "mrfmerge", "haardetect", "regionmask",
        "regiontext", "regionwrite", "regiontrack", "regionoverlay"}) {
    SCOPED_TRACE(name);
    GstElement* element = gst_element_factory_make(name, nullptr);
    if (!element && std::string(name) == "regionoverlay") continue;
    ASSERT_TRUE(element);
    gst_object_ref_sink(element);
    if (std::string(name) == "haardetect")
      g_object_set(element, "cascade", cascade.path().c_str(), nullptr);
    if (std::string(name) == "regionwrite") g_object_set(element, "location", "/dev/null", nullptr);
    for (int round = 0; round < 3; ++round)
      for (const int state : kOrder)
        EXPECT_EQ(gst_element_set_state(element, kStates[state]), GST_STATE_CHANGE_SUCCESS);
    gst_object_unref(element);
  }
}

/// Frames between the changes, flushes and seeks too, wherever the walk has come to.
void walk(const std::string& line, int steps) {
  const Watchdog watchdog(120);
  Chance chance;
  Chain chain(line, kSmall);
  gst_harness_set_drop_buffers(chain.harness(), TRUE);
  int index = 0;
  bool hasBegun = true;
  for (int step = 0; step < steps; ++step) {
    const GstState state = chance.pick(kStates);
    setState(chain, state);
    hasBegun = hasBegun && state >= GST_STATE_PAUSED;
    if (state >= GST_STATE_PAUSED && !chance.isOneIn(8) && !std::exchange(hasBegun, true))
      beginStream(chain);
    if (hasBegun && chance.isOneIn(4)) {
      testing::flush(chain);
      index = chance.below(30);
    }
    const int frames = hasBegun && chance.isOneIn(6) ? 10 : chance.below(2);
    for (int i = 0; i < frames; ++i) {
      const GstFlowReturn flow = chain.push(busyFrame(kSmall, index++));
      ASSERT_TRUE(!hasBegun || flow == GST_FLOW_OK) << flow;
      ASSERT_TRUE(state >= GST_STATE_PAUSED || flow == GST_FLOW_FLUSHING) << flow;
    }
  }
  gst_harness_set_drop_buffers(chain.harness(), FALSE);
  expectFreshStory(chain, line);
}

TEST(States, ARandomWalkWithFramesLeavesNothingBehind) {
  walk(everything(), campaign(600));
}

TEST(States, ARandomWalkOfTheBinLeavesNothingBehind) {
  walk("regiontrack", campaign(200));
}

TEST(States, ARandomWalkUnderFrameScopeLeavesNothingBehind) {
  walk(std::string(testing::kFrameScopeStages) + " latency=0.2 ! regionmask source=labels",
       campaign(200));
}

/// Pushes until told to stop; after a state change the stream is begun again.
void pushUntil(const std::atomic<bool>& isDone, Chain& chain, std::atomic<int>& passed) {
  std::vector<BufferPtr> frames;
  for (int i = 0; i < 40; ++i) frames.push_back(busyFrame(kSmall, i));
  for (size_t i = 0; !isDone; i = (i + 1) % frames.size()) {
    const GstFlowReturn flow = gst_harness_push(chain.harness(), gst_buffer_copy(frames[i].get()));
    if (flow == GST_FLOW_OK)
      ++passed;
    else
      beginStream(chain);
  }
}

TEST(States, ChangeWhileFramesArePushed) {
  const Watchdog watchdog(120);
  Chance chance;
  Chain chain(everything(), kSmall);
  gst_harness_set_drop_buffers(chain.harness(), TRUE);
  std::atomic<bool> isDone = false;
  std::atomic<int> passed = 0;
  std::thread pusher([&] { pushUntil(isDone, chain, passed); });
  for (int i = campaign(300); i > 0; --i) {
    g_usleep(static_cast<gulong>(chance.below(3000)));
    EXPECT_NE(gst_element_set_state(chain.harness()->element, chance.pick(kStates)),
              GST_STATE_CHANGE_FAILURE);
  }
  setState(chain, GST_STATE_PLAYING);
  while (passed == 0) g_usleep(1000);
  isDone = true;
  pusher.join();
  gst_harness_set_drop_buffers(chain.harness(), FALSE);
  expectFreshStory(chain, everything());
}

struct BadStart {
  const char* element;
  const char* property;
  const char* bad;
  const char* good;
};

/// With objects in view before: what failed must not keep anything of them.
TEST(States, AFailedStartIsMendedByAnotherValue) {
  constexpr BadStart kBadStarts[] = {
      {"bgremove", "mask", "/nowhere/mask.png", ""},
      {"bgremove", "areas-of-interest", "0,0 1,1", "0,0 1,0 1,1 0,1"},
      {"hsvsegment", "background-hue", "green", ""},
      {"hsvsegment", "object-hue", "10", ""},
      {"regionwrite", "location", "/nowhere/objects.jsonl", "/dev/null"},
  };
  for (const BadStart& what : kBadStarts) {
    SCOPED_TRACE(what.property);
    Chain chain(everything(), kSmall);
    int index = 0;
    ASSERT_TRUE(showObjects(chain, index));
    GstElement* element = chain.element(what.element);
    for (int round = campaign(4); round > 0; --round) {
      setState(chain, GST_STATE_NULL);
      g_object_set(element, what.property, what.bad, nullptr);
      EXPECT_EQ(gst_element_set_state(chain.harness()->element, GST_STATE_PLAYING),
                GST_STATE_CHANGE_FAILURE);
      EXPECT_NE(chain.complaint(GST_MESSAGE_ERROR), "");
      (void)chain.push(busyFrame(kSmall, index));
      g_object_set(element, what.property, what.good, nullptr);
      expectFreshStory(chain, everything());
    }
    gst_object_unref(element);
  }
}

/// Judged by the heap, after the first rounds have filled what is made once.
TEST(Instances, AHundredInRoundsLeaveNothingBehind) {
  if (testing::heapBytes() == 0) GTEST_SKIP() << "this allocator does not tell what is in use";
  std::vector<size_t> levels;
  for (int round = campaign(4); round > 0; --round) {
    std::vector<std::unique_ptr<Chain>> chains;
    for (int i = 0; i < 100; ++i) {
      chains.push_back(
          std::make_unique<Chain>(i % 2 == 0 ? everything() : std::string("regiontrack"), kSmall));
      for (int frame = 0; frame < 3; ++frame)
        ASSERT_TRUE(chains.back()->pass(busyFrame(kSmall, frame + testing::kFirstBusy)));
    }
    chains.clear();
    levels.push_back(testing::heapBytes());
  }
  testing::expectPlateau(levels, size_t{64} << 10);
}

TEST(Instances, SideBySideDoNotDisturbEachOther) {
  const Watchdog watchdog(120);
  Chain alone(everything(), kSmall);
  const std::string expected = storyOf(alone, 30);
  std::atomic<bool> isDone = false;
  std::vector<std::thread> threads;
  std::atomic<int> wrong = 0;
  for (int i = 0; i < 3; ++i)
    threads.emplace_back([&] {
      for (int round = campaign(3); round > 0; --round) {
        Chain chain(everything(), kSmall);
        wrong += storyOf(chain, 30) != expected;
      }
    });
  std::thread others([&] {
    while (!isDone) {
      Chain brief(everything(), {"GRAY8", 64, 48});
      for (int i = 0; i < 6; ++i) (void)brief.pass(busyFrame(brief.caps(), i));
    }
  });
  for (std::thread& thread : threads) thread.join();
  isDone = true;
  others.join();
  EXPECT_EQ(wrong, 0);
}

}  // namespace
}  // namespace rg
