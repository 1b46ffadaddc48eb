// SPDX-License-Identifier: LGPL-2.1-or-later
// Results as bytes, as they go to other processes.
#include "gst/meta/stored_result.hpp"
#include "tests/support/busy_scene.hpp"
#include "tests/support/results.hpp"

#include <gtest/gtest.h>

#include <tuple>

namespace rg {
namespace {

using testing::BufferPtr;
using testing::Caps;
using testing::Chain;

/// A frame with objects in view, from all stages.
BufferPtr busyBuffer(const Caps& caps = {"I420", 64, 48}) {
  Chain chain(testing::kQuickStages, caps);
  int index = 0;
  EXPECT_TRUE(testing::showObjects(chain, index));
  return chain.pass(testing::busyFrame(caps, index));
}

template <class Payload>
class StoredResult : public ::testing::Test {};
using Payloads = ::testing::Types<background::Foreground, segmentation::Labels, graph::Graph,
                                  motion::Motion, objects::Objects>;
TYPED_TEST_SUITE(StoredResult, Payloads);

template <class Payload>
std::shared_ptr<const Payload> busyResult() {
  const BufferPtr buffer = busyBuffer();
  return findResult<Payload>(buffer.get());
}

TYPED_TEST(StoredResult, SaysTheSameWhenItComesBack) {
  const auto bytes = store(*busyResult<TypeParam>());
  ASSERT_GT(bytes.size(), 10u);
  const auto back = restore<TypeParam>(bytes);
  ASSERT_TRUE(back);
  EXPECT_EQ(store(*back), bytes);
}

TYPED_TEST(StoredResult, IsRefusedWithoutOneOfItsBytesOrWithAnother) {
  auto bytes = store(*busyResult<TypeParam>());
  for (size_t length = 0; length < bytes.size(); length += 1 + length / 50)
    EXPECT_FALSE(restore<TypeParam>(std::span(bytes).first(length))) << length;
  bytes.push_back(0);
  EXPECT_FALSE(restore<TypeParam>(bytes));
}

TYPED_TEST(StoredResult, SurvivesBytesThatAreWrong) {
  const auto bytes = store(*busyResult<TypeParam>());
  testing::Chance chance;
  int refused = 0;
  for (int round = 0; round < testing::campaign(2000); ++round) {
    auto wrong = bytes;
    for (int i = chance.between(1, 4); i > 0; --i)
      wrong[static_cast<size_t>(chance.below(static_cast<int>(wrong.size())))] =
          static_cast<uint8_t>(chance.below(256));
    const auto back = restore<TypeParam>(wrong);
    if (back)
      EXPECT_EQ(restore<TypeParam>(store(*back)) != nullptr, true);
    else
      ++refused;
  }
  EXPECT_GT(refused, 0);
}

TYPED_TEST(StoredResult, OfASkippedFrameIsEmpty) {
  const auto back = restore<TypeParam>(store(TypeParam{}));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->status, Status::Skipped);
}

TEST(StoredObjects, KeepTheirPlaneAndTheirStory) {
  auto list = testing::objects(
      {64, 48}, {testing::object(3, {5, 6, 20, 10}), testing::object(9, {40, 30, 8, 8})});
  list->objects[1].parents = {3, 1'000'000'000'000};
  list->events = {{objects::EventKind::Split, {3, 9}}};
  const auto back = restore<objects::Objects>(store(*list));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->objects[1].parents, list->objects[1].parents);
  EXPECT_EQ(back->objects[0].contour, list->objects[0].contour);
  EXPECT_EQ(back->events[0].ids, list->events[0].ids);
  Image<uint16_t> scratch;
  const auto slots = back->slots.unpacked(scratch);
  for (int y = 0; y < 48; ++y)
    for (int x = 0; x < 64; ++x) ASSERT_EQ(slots.at(x, y), list->slots.at(x, y));
}

TEST(StoredObjects, KeepTheCamera) {
  constexpr int64_t kOne = CameraMotion::kOne;
  auto list = testing::objects({64, 48}, {});
  list->camera = {{kOne - 5, 7, -123'456'789'012, -7, kOne + 5, 3, 9, -9, kOne}, {32, -24}};
  const auto back = restore<objects::Objects>(store(*list));
  ASSERT_TRUE(back);
  EXPECT_EQ(back->camera, list->camera);
  list->camera = {{kOne, 0, 0, 0, kOne, 0, 0, 0, kOne + 1}, {}};
  EXPECT_FALSE(restore<objects::Objects>(store(*list))) << "what can't be computed with";
}

TEST(StoredResults, ThatContradictEachOtherAreNotJoined) {
  const auto graph = testing::graph({64, 48});
  motion::Motion motion;
  motion.regions.resize(2);
  EXPECT_TRUE(join(motion, graph));
  motion.regions.resize(3);
  EXPECT_FALSE(join(motion, graph));
  EXPECT_TRUE(join(motion, nullptr));
  objects::Objects objects;
  objects.regionObject.resize(3);
  EXPECT_TRUE(join(objects, nullptr));
  motion.regions.resize(2);
  ASSERT_TRUE(join(motion, graph));
  EXPECT_FALSE(join(objects, std::make_shared<motion::Motion>(motion)));
}

/// Where gdppay and gdpdepay carry no metas at all, as those of GStreamer 1.22 to 1.26, they lose
/// GStreamer's own, too.
TYPED_TEST(StoredResult, GoesThroughGdpWhereThatTakesMetas) {
  GstElementFactory* factory = gst_element_factory_find("gdppay");
  if (!factory) GTEST_SKIP() << "no gdppay";
  gst_object_unref(factory);
  const Caps caps{"I420", 64, 48};
  BufferPtr from = busyBuffer(caps);
  const auto before = findResult<TypeParam>(from.get());
  GstCaps* reference = gst_caps_new_empty_simple("timestamp/x-unix");
  gst_buffer_add_reference_timestamp_meta(from.get(), reference, 7, GST_CLOCK_TIME_NONE);
  gst_caps_unref(reference);
  Chain chain("gdppay ! gdpdepay", caps);
  const BufferPtr to = chain.pass(std::move(from));
  ASSERT_TRUE(to);
  if (!gst_buffer_get_reference_timestamp_meta(to.get(), nullptr))
    GTEST_SKIP() << "this gdppay carries no metas";
  const auto after = findResult<TypeParam>(to.get());
  ASSERT_TRUE(after);
  EXPECT_EQ(store(*after), store(*before));
}

#if GST_CHECK_VERSION(1, 24, 0)
/// Sends the metas of a buffer as unixfdsink does.
BufferPtr sent(GstBuffer* from) {
  BufferPtr to(gst_buffer_copy_region(from, GST_BUFFER_COPY_MEMORY, 0, gst_buffer_get_size(from)));
  gpointer state = nullptr;
  while (GstMeta* meta = gst_buffer_iterate_meta(from, &state)) {
    GByteArray* bytes = g_byte_array_new();
    if (gst_meta_serialize_simple(meta, bytes)) {
      guint32 consumed = 0;
      gst_meta_deserialize(to.get(), bytes->data, bytes->len, &consumed);
    }
    g_byte_array_unref(bytes);
  }
  return to;
}

TYPED_TEST(StoredResult, GoesWithItsBufferToAnotherProcess) {
  const BufferPtr from = busyBuffer(), to = sent(from.get());
  const auto before = findResult<TypeParam>(from.get()), after = findResult<TypeParam>(to.get());
  ASSERT_TRUE(before && after);
  EXPECT_EQ(store(*after), store(*before));
}

TEST(StoredResults, AreWrittenAndRefusedByStagesWhereTheyArrive) {
  const Caps caps{"I420", 64, 48};
  for (const char* writer : {"jsonl", "graph", "regions", "mot"}) {
    Chain chain(std::string("regionwrite location=/dev/null format=") + writer, caps);
    EXPECT_TRUE(chain.pass(sent(busyBuffer(caps).get()))) << writer;
  }
  for (const char* stage : {"srg", "prmmotion", "mrfmerge"}) {
    Chain chain(stage, caps);
    EXPECT_FALSE(chain.pass(sent(busyBuffer(caps).get()))) << stage;
    EXPECT_NE(chain.complaint(GST_MESSAGE_ERROR).find("packed"), std::string::npos) << stage;
  }
}
#endif

}  // namespace
}  // namespace rg
