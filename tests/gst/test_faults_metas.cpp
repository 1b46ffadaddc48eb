// SPDX-License-Identifier: LGPL-2.1-or-later
// Metas of others that lie, and our own where nobody expects them.
#include "gst/meta/gstregiongraph.h"
#include "gst/meta/result_meta.hpp"
#include "tests/support/busy_scene.hpp"
#include "tests/support/results.hpp"

#include <gst/video/gstvideometa.h>
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>

namespace rg {
namespace {

using testing::BufferPtr;
using testing::busyFrame;
using testing::campaign;
using testing::Caps;
using testing::Chain;
using testing::Chance;
using testing::showObjects;
using testing::Story;

const Caps kSmall{"I420", 96, 64};

std::string allReaders() {
  const bool hasOverlay = gst_element_factory_find("regionoverlay") != nullptr;
  return std::string(testing::kQuickStages) + " ! regionwrite location=/dev/null" +
         (hasOverlay ? " ! regionoverlay boxes=true trails=true graph=true grid=true vectors=true"
                     : "");
}

constexpr guint kOddSizes[] = {0, 1, 95, 97, G_MAXINT32, G_MAXUINT32, G_MAXUINT32 - 7};

/// What other detectors attach, with every field at its worst.
void addForeignRoi(GstBuffer* buffer, Chance& chance) {
  auto* roi = gst_buffer_add_video_region_of_interest_meta(
      buffer, chance.isOneIn(2) ? "object" : "\xff\xfe not a name", chance.pick(kOddSizes),
      chance.pick(kOddSizes), chance.pick(kOddSizes), chance.pick(kOddSizes));
  roi->id = static_cast<gint>(chance.pick(kOddSizes));
  roi->parent_id = roi->id;
  if (chance.isOneIn(3))
    gst_video_region_of_interest_meta_add_param(
        roi, gst_structure_new("detection", "x_min", G_TYPE_DOUBLE, std::nan(""), "x_max",
                               G_TYPE_STRING, nullptr, "confidence", G_TYPE_INT64, G_MININT64,
                               "label_id", GST_TYPE_FRACTION, 1, 2, nullptr));
  if (chance.isOneIn(3))
    gst_video_region_of_interest_meta_add_param(roi, gst_structure_new_empty("object_id"));
}

/// Nobody here reads them: the story is the one without them, and they are passed on.
TEST(ForeignMetas, ChangeNothing) {
  Chance chance;
  Chain chain(allReaders(), kSmall), other(allReaders(), kSmall);
  Story story, expected;
  for (int i = 0; i < campaign(40); ++i) {
    BufferPtr frame = busyFrame(kSmall, i);
    const int count = i % 20 == 19 ? 10'000 : chance.below(30);
    for (int k = 0; k < count; ++k) addForeignRoi(frame.get(), chance);
    const BufferPtr out = chain.pass(std::move(frame));
    ASSERT_EQ(story.tell(out.get()), expected.tell(other.pass(busyFrame(kSmall, i)).get()));
    EXPECT_GE(gst_buffer_get_n_meta(out.get(), GST_VIDEO_REGION_OF_INTEREST_META_API_TYPE),
              static_cast<guint>(count));
  }
  EXPECT_EQ(chain.complaint(GST_MESSAGE_ERROR), "");
}

GstMeta* addCustom(GstBuffer* buffer) {
  static const gchar* kTags[] = {nullptr};
  static const GstMetaInfo* const info =
      gst_meta_register_custom("GstRegionFaultsTest", kTags, nullptr, nullptr, nullptr);
  (void)info;
  return reinterpret_cast<GstMeta*>(gst_buffer_add_custom_meta(buffer, "GstRegionFaultsTest"));
}

/// Times of day, crops, transformations and metas nobody knows.
TEST(ForeignMetas, OfOtherKindsChangeNothing) {
  Chance chance;
  Chain chain(allReaders(), kSmall), other(allReaders(), kSmall);
  GstCaps* none = gst_caps_new_empty();
  GstCaps* ntp = gst_caps_new_empty_simple("timestamp/x-ntp");
  Story story, expected;
  for (int i = 0; i < campaign(40); ++i) {
    BufferPtr frame = busyFrame(kSmall, i);
    ASSERT_TRUE(addCustom(frame.get()));
    for (GstCaps* caps : {none, ntp})
      gst_buffer_add_reference_timestamp_meta(frame.get(), caps,
                                              uint64_t{chance.pick(kOddSizes)} << 32, G_MAXUINT64);
    GstVideoCropMeta* crop = gst_buffer_add_video_crop_meta(frame.get());
    crop->x = chance.pick(kOddSizes);
    crop->width = chance.pick(kOddSizes);
    auto* affine = gst_buffer_add_video_affine_transformation_meta(frame.get());
    affine->matrix[0] = std::nanf("");
    ASSERT_EQ(story.tell(chain.pass(std::move(frame)).get()),
              expected.tell(other.pass(busyFrame(kSmall, i)).get()));
  }
  gst_caps_unref(none);
  gst_caps_unref(ntp);
}

/// A result for frames of another size, in front of each element that reads one.
template <class Payload>
void expectSurvived(const char* line, const std::shared_ptr<const Payload>& result,
                    const Caps& caps) {
  SCOPED_TRACE(std::string(line) + " " + caps.text());
  Chain chain(line, caps);
  for (int i = 0; i < 3; ++i) {
    BufferPtr frame = busyFrame(caps, i);
    attachResult<Payload>(frame.get(), result);
    (void)chain.pass(std::move(frame));
  }
}

TEST(OurMetas, OfAnotherSizeAreSurvived) {
  const objects::Object far = testing::object(UINT64_MAX, {1 << 25, -(1 << 25), 1 << 20, 1 << 20});
  const auto objects = testing::objects({31, 17}, {testing::object(1, {3, 4, 9, 9}), far});
  const auto foreground = testing::foreground({31, 17}, {3, 4, 9, 5});
  for (const Caps& caps : {Caps{"BGRx", 1, 1}, Caps{"I420", 64, 48}, Caps{"GRAY8", 200, 3}}) {
    for (const char* line :
         {"regionwrite location=/dev/null", "regionwrite location=/dev/null format=mot",
          "regionmask source=objects", "hsvsegment scope=frame"})
      expectSurvived<objects::Objects>(line, objects, caps);
    for (const char* line : {"hsvsegment scope=foreground", "hsvsegment scope=areas",
                             "regionmask source=foreground", "bgremove"})
      expectSurvived<background::Foreground>(line, foreground, caps);
    if (!gst_element_factory_find("regionoverlay")) continue;
    expectSurvived<objects::Objects>("regionoverlay", objects, caps);
    expectSurvived<background::Foreground>("regionoverlay background=black", foreground, caps);
    expectSurvived<graph::Graph>("regionoverlay graph=true", testing::graph({31, 17}), caps);
  }
}

/// Cameras that no fit could have found, in front of all that writes or draws them.
TEST(OurMetas, OfCamerasOfNonsenseAreSurvived) {
  constexpr int64_t kOne = CameraMotion::kOne;
  const CameraMotion::Matrix kMatrices[] = {
      {},
      {kOne, 0, 0, 0, kOne, 0, 0, 0, 0},
      {kOne, 0, 0, 0, kOne, 0, kOne, -kOne, kOne},
      {INT64_MIN, INT64_MAX, INT64_MIN, 0, INT64_MAX, 0, INT64_MIN, 1, kOne}};
  for (const auto& matrix : kMatrices)
    for (const Point origin : {Point{}, Point{INT32_MAX, INT32_MIN}, Point{16384, 16384}}) {
      auto objects = testing::objects({31, 17}, {testing::object(1, {3, 4, 9, 9})});
      objects->camera = {matrix, origin};
      const std::shared_ptr<const objects::Objects> result = objects;
      for (const Caps& caps : {Caps{"GRAY8", 1, 1}, Caps{"I420", 64, 48}}) {
        expectSurvived<objects::Objects>("regionwrite location=/dev/null", result, caps);
        expectSurvived<objects::Objects>("regiontext contours=true", result, caps);
        if (gst_element_factory_find("regionoverlay"))
          expectSurvived<objects::Objects>("regionoverlay grid=true", result, caps);
      }
    }
}

/// Stages whose input was made for frames of another size, as behind a videoscale.
TEST(OurMetas, OfAScaledStreamAreFollowedByTheLaterStages) {
  Chance chance;
  constexpr const char* kStages[] = {"bgremove training-frames=2", "hsvsegment", "srg", "prmmotion",
                                     "mrfmerge"};
  for (size_t cut = 1; cut < std::size(kStages); ++cut) {
    std::string first = kStages[0], rest = kStages[cut];
    for (size_t i = 1; i < cut; ++i) first += std::string(" ! ") + kStages[i];
    for (size_t i = cut + 1; i < std::size(kStages); ++i) rest += std::string(" ! ") + kStages[i];
    SCOPED_TRACE(rest);
    Chain before(first, kSmall);
    Chain behind(rest + " ! regionwrite location=/dev/null", {"I420", 40, 200});
    for (int i = 0; i < campaign(30); ++i) {
      const BufferPtr out = before.pass(busyFrame(kSmall, i));
      ASSERT_TRUE(out);
      BufferPtr scaled = busyFrame(behind.caps(), i);
      if (!chance.isOneIn(5))
        gst_buffer_copy_into(scaled.get(), out.get(), GST_BUFFER_COPY_META, 0, gsize(-1));
      (void)behind.pass(std::move(scaled));
    }
  }
}

/// Ids beyond what a GstVideoRegionOfInterestMeta holds come out, and nothing is lost by it.
TEST(OurMetas, LargeIdsAndAgesAreTold) {
  objects::Object object = testing::object(UINT64_MAX, {3, 4, 9, 9});
  object.ageFrames = UINT32_MAX;
  object.parents = {UINT64_MAX - 1, UINT64_MAX};
  BufferPtr buffer(gst_buffer_new());
  attachResult<objects::Objects>(buffer.get(), testing::objects({31, 17}, {object}));
  GstRegionObjectsMeta* meta = gst_buffer_get_region_objects_meta(buffer.get());
  ASSERT_TRUE(meta);
  GstRegionObject told{};
  ASSERT_TRUE(gst_region_objects_meta_get_object(meta, 0, &told));
  EXPECT_EQ(told.id, UINT64_MAX);
  EXPECT_EQ(told.age, UINT32_MAX);
  EXPECT_FALSE(gst_region_objects_meta_get_object(meta, 1, &told));
  EXPECT_FALSE(gst_region_objects_meta_get_object(meta, G_MAXUINT, &told));
}

}  // namespace
}  // namespace rg
