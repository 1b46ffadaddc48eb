// SPDX-License-Identifier: LGPL-2.1-or-later
// What the stages tell of their work: the structure for programs, the debug lines for persons.
#include "tests/support/busy_scene.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace rg {
namespace {

using testing::BufferPtr;
using testing::busyFrame;
using testing::Caps;
using testing::Chain;

const Caps kSmall{"I420", 96, 64};
constexpr const char* kStages[] = {"bgremove", "hsvsegment", "srg", "prmmotion", "mrfmerge"};

struct Stats {
  guint64 frames = 0, dropped = 0;
  double meanMs = -1, worstMs = -1;
};

/// Gives the element back.
Stats statsOf(GstElement* element) {
  GstStructure* structure = nullptr;
  g_object_get(element, "stats", &structure, nullptr);
  gst_object_unref(element);
  Stats stats;
  EXPECT_TRUE(gst_structure_get(structure, "frames", G_TYPE_UINT64, &stats.frames, "dropped",
                                G_TYPE_UINT64, &stats.dropped, "ms-mean", G_TYPE_DOUBLE,
                                &stats.meanMs, "ms-worst", G_TYPE_DOUBLE, &stats.worstMs, nullptr));
  gst_structure_free(structure);
  return stats;
}

Stats statsOf(const Chain& chain, const char* factory) {
  return statsOf(chain.element(factory));
}

TEST(StageStats, CountFramesTimesAndDrops) {
  Chain chain(testing::kQuickStages, kSmall);
  for (const char* stage : kStages) EXPECT_EQ(statsOf(chain, stage).frames, 0u);
  for (int i = 0; i < 10; ++i) {
    BufferPtr frame = busyFrame(kSmall, i);
    if (i == 6) GST_BUFFER_FLAG_SET(frame.get(), GST_BUFFER_FLAG_GAP);
    EXPECT_TRUE(chain.pass(std::move(frame)));
  }
  for (const char* stage : kStages) {
    SCOPED_TRACE(stage);
    const Stats stats = statsOf(chain, stage);
    EXPECT_EQ(stats.frames, 10u);
    EXPECT_EQ(stats.dropped, std::string(stage) == "bgremove" ? 1u : stats.dropped);
    EXPECT_LE(stats.dropped, 2u);
    EXPECT_GE(stats.meanMs, 0);
    EXPECT_GE(stats.worstMs, stats.meanMs);
  }
  gst_element_set_state(chain.harness()->element, GST_STATE_NULL);
  gst_element_set_state(chain.harness()->element, GST_STATE_PLAYING);
  for (const char* stage : kStages) EXPECT_EQ(statsOf(chain, stage).frames, 0u);
}

TEST(StageStats, OfRegiontrackAreTheSumOfItsStages) {
  Chain chain("regiontrack training-frames=2", kSmall);
  EXPECT_EQ(statsOf(chain, "regiontrack").frames, 0u);
  EXPECT_EQ(statsOf(chain, "regiontrack").meanMs, 0);
  for (int i = 0; i < 10; ++i) {
    BufferPtr frame = busyFrame(kSmall, i);
    if (i == 6) GST_BUFFER_FLAG_SET(frame.get(), GST_BUFFER_FLAG_GAP);
    EXPECT_TRUE(chain.pass(std::move(frame)));
  }
  Stats sum{0, 0, 0, 0};
  GstElement* bin = chain.element("regiontrack");
  for (const char* stage : kStages) {
    const Stats stats = statsOf(gst_bin_get_by_name(GST_BIN(bin), stage));
    sum = {stats.frames, std::max(sum.dropped, stats.dropped), sum.meanMs + stats.meanMs,
           sum.worstMs + stats.worstMs};
  }
  const Stats all = statsOf(bin);
  EXPECT_EQ(all.frames, 10u);
  EXPECT_EQ(all.dropped, sum.dropped);
  EXPECT_GE(all.dropped, 1u);
  EXPECT_GT(all.meanMs, 0);
  EXPECT_EQ(all.meanMs, sum.meanMs);
  EXPECT_EQ(all.worstMs, sum.worstMs);
}

/// The lines at level DEBUG of the stages' categories.
class DebugLines {
 public:
  DebugLines() {
    (gst_debug_add_log_function)(keep, this, nullptr);  // The macro compares pointers of two kinds.
    for (const char* stage : kStages) gst_debug_set_threshold_for_name(stage, GST_LEVEL_DEBUG);
  }
  ~DebugLines() {
    for (const char* stage : kStages) gst_debug_unset_threshold_for_name(stage);
    (gst_debug_remove_log_function)(keep);
  }
  DebugLines(const DebugLines&) = delete;
  DebugLines& operator=(const DebugLines&) = delete;

  [[nodiscard]] std::vector<std::string> of(const std::string& category) {
    const std::lock_guard lock(mutex_);
    return lines_[category];
  }

 private:
  static void keep(GstDebugCategory* category, GstDebugLevel, const gchar*, const gchar*, gint,
                   GObject*, GstDebugMessage* message, gpointer data) {
    auto& self = *static_cast<DebugLines*>(data);
    const std::lock_guard lock(self.mutex_);
    self.lines_[gst_debug_category_get_name(category)].emplace_back(gst_debug_message_get(message));
  }

  std::mutex mutex_;
  std::map<std::string, std::vector<std::string>> lines_;
};

TEST(StageDebug, TellsWhatAPersonTunesBy) {
  DebugLines lines;
  Chain chain(testing::kQuickStages, kSmall);
  int index = 0;
  ASSERT_TRUE(testing::showObjects(chain, index));
  for (const auto& [stage, figure] : {std::pair{"bgremove", "% of the frame in"},
                                      {"hsvsegment", "regions in the foreground"},
                                      {"srg", "pairs that touch"},
                                      {"prmmotion", "of them move"},
                                      {"mrfmerge", "objects known"}}) {
    SCOPED_TRACE(stage);
    const auto told = lines.of(stage);
    ASSERT_FALSE(told.empty());
    EXPECT_EQ(told.front().find("frame 1 at 0:00:00"), 0u) << told.front();
    for (const char* word : {figure, "ms a frame", "without a result"})
      EXPECT_NE(told.front().find(word), std::string::npos) << told.front();
  }
  bool hasNew = false;
  for (const std::string& line : lines.of("mrfmerge"))
    hasNew = hasNew || line.find("regiongraph-object-new") == 0;
  EXPECT_TRUE(hasNew);
}

/// Nothing changes, and no second passes: nothing more is told.
TEST(StageDebug, IsNotALineForEachFrame) {
  DebugLines lines;
  Chain chain("bgremove", kSmall);
  for (int i = 0; i < 20; ++i)
    ASSERT_TRUE(chain.pass(testing::paint(kSmall, i, testing::square(0, 0, 0))));
  EXPECT_LT(lines.of("bgremove").size(), 20u);
}

}  // namespace
}  // namespace rg
