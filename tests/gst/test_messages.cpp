// SPDX-License-Identifier: LGPL-2.1-or-later
// Messages that stand alone, and things that touch and part all the time.
#include "gst/support/contact_calm.hpp"
#include "gst/support/object_messages.hpp"
#include "tests/support/busy_scene.hpp"
#include "tests/support/results.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace rg {
namespace {

using testing::BufferPtr;
using testing::BusPtr;
using testing::busyFrame;
using testing::Caps;
using testing::Chain;
using testing::MessagePtr;

constexpr int64_t kFrameNs = 100'000'000;

/// What is told when two things are merged in the frames that are marked so.
std::string toldOf(const std::string& frames) {
  ContactCalm calm;
  std::string told;
  for (size_t i = 0; i < frames.size(); ++i) {
    const auto now = static_cast<int64_t>(i) * kFrameNs;
    const bool isMerged = frames[i] == 'm';
    if (isMerged != (i > 0 && frames[i - 1] == 'm')) calm.note({{1, 2}, isMerged}, now);
    const auto due = calm.take(now);
    told += due.empty() ? '.' : due.front().isMerged ? 'm' : 's';
  }
  return told;
}

TEST(ContactCalm, TellsAMeetingAtOnceAndItsEnd) {
  EXPECT_EQ(toldOf("ssmmmmmmmmmmmmmmmmmmmmmmmsssss"), "..m......................s....");
}

TEST(ContactCalm, TellsWhatFlipsOnce) {
  EXPECT_EQ(toldOf("smsmsmsmsmsmmsmsmsmsmsmsmsmsmsmsmsmsm"), ".m" + std::string(35, '.'));
}

TEST(ContactCalm, TellsWhereFlippingCameToRest) {
  const std::string told = toldOf("smsmsms" + std::string(40, 's'));
  EXPECT_EQ(told.substr(0, 2), ".m");
  EXPECT_EQ(std::count(told.begin(), told.end(), 's'), 1);
  EXPECT_EQ(std::count(told.begin(), told.end(), 'm'), 1);
}

TEST(ContactCalm, WithoutTimesTellsAllOfIt) {
  ContactCalm calm;
  for (int i = 0; i < 6; ++i) {
    calm.note({{1, 2}, i % 2 == 0}, std::nullopt);
    EXPECT_EQ(calm.take(std::nullopt).size(), 1u);
  }
}

TEST(ContactCalm, OthersAreTheirOwnMatter) {
  ContactCalm calm;
  calm.note({{1, 2}, true}, 0);
  calm.note({{1, 3}, true}, 0);
  EXPECT_EQ(calm.take(0).size(), 2u);
  calm.forget(2);
  calm.note({{1, 2}, true}, kFrameNs);
  calm.note({{1, 3}, false}, kFrameNs);
  EXPECT_EQ(calm.take(kFrameNs).size(), 1u);
}

/// The structure of the next message of a name; null without one.
const GstStructure* structureOf(const MessagePtr& message) {
  return message ? gst_message_get_structure(message.get()) : nullptr;
}
MessagePtr nextOf(Chain& chain, const char* name) {
  while (MessagePtr message = chain.message(GST_MESSAGE_ELEMENT))
    if (gst_structure_has_name(gst_message_get_structure(message.get()), name)) return message;
  return nullptr;
}

BufferPtr takenAt(BufferPtr frame, uint64_t unixNs) {
  GstCaps* reference = gst_caps_new_empty_simple("timestamp/x-unix");
  gst_buffer_add_reference_timestamp_meta(frame.get(), reference, unixNs, GST_CLOCK_TIME_NONE);
  gst_caps_unref(reference);
  return frame;
}

TEST(Messages, OfObjectsTellTheirBoxAndStateAndWhenTheFrameWasTaken) {
  const Caps caps{"I420", 96, 64};
  Chain chain(testing::kQuickStages, caps);
  for (int i = 0; i < 15; ++i)
    ASSERT_TRUE(chain.pass(takenAt(busyFrame(caps, i), 1'700'000'000'000'000'000)));
  const MessagePtr message = nextOf(chain, "regiongraph-object-new");
  const GstStructure* fields = structureOf(message);
  ASSERT_TRUE(fields);
  guint64 id = 0;
  int x = -1000, y = -1000, width = 0, height = 0;
  EXPECT_TRUE(gst_structure_get(fields, "id", G_TYPE_UINT64, &id, "x", G_TYPE_INT, &x, "y",
                                G_TYPE_INT, &y, "w", G_TYPE_INT, &width, "h", G_TYPE_INT, &height,
                                nullptr));
  EXPECT_GT(width, 4);
  EXPECT_GT(height, 4);
  EXPECT_STREQ(gst_structure_get_string(fields, "state"), "tracked");
  EXPECT_STREQ(gst_structure_get_string(fields, "utc"), "2023-11-14T22:13:20.000000000Z");
  gst_element_set_state(chain.harness()->element, GST_STATE_NULL);
  const MessagePtr end = nextOf(chain, "regiongraph-object-end");
  ASSERT_TRUE(structureOf(end));
  EXPECT_TRUE(gst_structure_has_field(structureOf(end), "w"));
  EXPECT_TRUE(gst_structure_has_field(structureOf(end), "state"));
}

TEST(Messages, WithoutACaptureTimeTellNone) {
  const Caps caps{"I420", 96, 64};
  Chain chain(testing::kQuickStages, caps);
  int index = 0;
  ASSERT_TRUE(testing::showObjects(chain, index));
  const MessagePtr message = nextOf(chain, "regiongraph-object-new");
  ASSERT_TRUE(structureOf(message));
  EXPECT_FALSE(gst_structure_has_field(structureOf(message), "utc"));
}

/// What is told of results by hand, as of a frame twice as large.
MessagePtr messageOf(const objects::Objects& objects) {
  GstElement* element = gst_element_factory_make("mrfmerge", nullptr);
  gst_object_ref_sink(element);
  const BusPtr bus(gst_bus_new());
  gst_element_set_bus(element, bus.get());
  ObjectMessages messages(GST_BASE_TRANSFORM(element), GST_CAT_DEFAULT);
  messages.tell(objects, {2 * objects.size.width, 2 * objects.size.height}, {});
  gst_element_set_bus(element, nullptr);
  gst_object_unref(element);
  return MessagePtr(gst_bus_pop_filtered(bus.get(), GST_MESSAGE_ELEMENT));
}

/// A camera that begins to pan and zoom.
TEST(Messages, OfTheBackgroundsMotionHaveTheCamerasMatrix) {
  constexpr int64_t kOne = CameraMotion::kOne;
  const auto objects = testing::objects({64, 48}, {});
  objects->cameraDx = -32;
  objects->camera = {{kOne / 2, 0, 2 * kOne, 0, kOne / 2, 0, 0, 0, kOne}, {32, 24}};
  const MessagePtr message = messageOf(*objects);
  const GstStructure* fields = structureOf(message);
  ASSERT_TRUE(fields);
  EXPECT_TRUE(gst_structure_has_name(fields, "regiongraph-background-motion"));
  const GValue* matrix = gst_structure_get_value(fields, "matrix");
  ASSERT_TRUE(matrix);
  std::vector<double> numbers;
  for (guint i = 0; i < gst_value_array_get_size(matrix); ++i)
    numbers.push_back(g_value_get_double(gst_value_array_get_value(matrix, i)));
  EXPECT_EQ(numbers, (std::vector<double>{.5, 0, 36.25, 0, .5, 24.25, 0, 0, 1}));
}

/// The box is the one round both.
TEST(Messages, OfMergesTellTheBoxRoundAll) {
  const auto objects = testing::objects(
      {64, 48}, {testing::object(1, {10, 10, 8, 4}), testing::object(2, {20, 20, 8, 4})});
  objects->events = {{objects::EventKind::Merge, {1, 2}}};
  const MessagePtr message = messageOf(*objects);
  const GstStructure* fields = structureOf(message);
  ASSERT_TRUE(fields);
  EXPECT_TRUE(gst_structure_has_name(fields, "regiongraph-merge"));
  int x = 0, y = 0, width = 0, height = 0;
  EXPECT_TRUE(gst_structure_get(fields, "x", G_TYPE_INT, &x, "y", G_TYPE_INT, &y, "w", G_TYPE_INT,
                                &width, "h", G_TYPE_INT, &height, nullptr));
  EXPECT_EQ((Box{x, y, width, height}), (Box{20, 20, 36, 28}));
  EXPECT_EQ(gst_value_array_get_size(gst_structure_get_value(fields, "states")), 2u);
}

}  // namespace
}  // namespace rg
