// SPDX-License-Identifier: LGPL-2.1-or-later
// Objects as GstAnalytics knows them; built where GStreamer has it.
#include "gst/support/class_metas.hpp"
#include "gst/support/roi_metas.hpp"
#include "tests/support/failing_new.hpp"
#include "tests/support/harness.hpp"
#include "tests/support/results.hpp"

#include <gst/analytics/analytics.h>
#include <gst/video/gstvideometa.h>
#include <gtest/gtest.h>

#include <map>

namespace rg {
namespace {

using testing::BufferPtr;
using testing::Caps;

const Caps kCaps{"GRAY8", 64, 48};
constexpr Size kSize{64, 48};

struct Told {
  Box box;
  GstClockTime first, last;
  int roi, parent;
};

BufferPtr frameAt(int index) {
  return testing::paint(kCaps, index, [](int, int) { return uint8_t{90}; });
}

/// By number: what a reader of detections sees that takes the region of interest with their id.
std::map<uint64_t, Told> toldOf(GstBuffer* buffer) {
  std::map<uint64_t, Told> told;
  GstAnalyticsRelationMeta* meta = gst_buffer_get_analytics_relation_meta(buffer);
  if (!meta) return told;
  gpointer state = nullptr;
  GstAnalyticsODMtd detection;
  while (gst_analytics_relation_meta_iterate(meta, &state, gst_analytics_od_mtd_get_mtd_type(),
                                             &detection)) {
    GstAnalyticsTrackingMtd tracking;
    gpointer related = nullptr;
    EXPECT_TRUE(gst_analytics_relation_meta_get_direct_related(
        meta, detection.id, GST_ANALYTICS_REL_TYPE_RELATE_TO,
        gst_analytics_tracking_mtd_get_mtd_type(), &related, &tracking));
    guint64 number = 0;
    gboolean isLost = TRUE;
    Told one{};
    gst_analytics_tracking_mtd_get_info(&tracking, &number, &one.first, &one.last, &isLost);
    EXPECT_FALSE(isLost);
    float confidence = 0;
    gst_analytics_od_mtd_get_location(&detection, &one.box.x, &one.box.y, &one.box.width,
                                      &one.box.height, &confidence);
    const auto* roi =
        gst_buffer_get_video_region_of_interest_meta_id(buffer, static_cast<gint>(detection.id));
    EXPECT_TRUE(roi);
    if (!roi) continue;
    EXPECT_EQ(roi->roi_type, gst_analytics_od_mtd_get_obj_type(&detection));
    one.roi = roi->id;
    one.parent = roi->parent_id;
    told[number] = one;
  }
  return told;
}

std::map<uint64_t, Told> tell(RoiMetas& metas, int index, std::vector<objects::Object> list) {
  for (objects::Object& object : list) object.ageFrames = static_cast<uint32_t>(index) + 1;
  const BufferPtr buffer = frameAt(index);
  metas.add(buffer.get(), kCaps.info(), *testing::objects(kSize, std::move(list)));
  return toldOf(buffer.get());
}

TEST(Detections, HaveTheObjectsBoxAndRelateToItsNumber) {
  RoiMetas metas;
  const auto told = tell(metas, 0,
                         {testing::object(7, {5, 6, 20, 10}), testing::object(12, {-5, 30, 20, 10}),
                          testing::object(13, {1, 1, 9, 9}, objects::ObjectState::Lost)});
  ASSERT_EQ(told.size(), 2u);
  EXPECT_EQ(told.at(7).box, (Box{5, 6, 20, 10}));
  EXPECT_EQ(told.at(12).box, (Box{0, 30, 15, 10}));
  EXPECT_NE(told.at(7).roi, told.at(12).roi);
}

TEST(Detections, RememberWhenAnObjectWasFirstSeen) {
  RoiMetas metas;
  const Box box{5, 6, 20, 10};
  tell(metas, 0, {testing::object(7, box, objects::ObjectState::New)});
  tell(metas, 1, {testing::object(7, box), testing::object(8, box)});
  const auto told = tell(metas, 3, {testing::object(7, box), testing::object(8, box)});
  EXPECT_EQ(told.at(7).first, 0u);
  EXPECT_EQ(told.at(8).first, 40 * GST_MSECOND);
  EXPECT_EQ(told.at(7).last, 120 * GST_MSECOND);
}

TEST(Detections, OfAnotherStreamBeginAnew) {
  RoiMetas metas;
  const Box box{5, 6, 20, 10};
  tell(metas, 9, {testing::object(1, box)});
  EXPECT_EQ(tell(metas, 2, {testing::object(1, box)}).at(1).first, 80 * GST_MSECOND);
}

TEST(Detections, AreLeftOutOfAFrameThatThereIsNoMemoryFor) {
  RoiMetas metas;
  const Box box{5, 6, 20, 10};
  tell(metas, 0, {testing::object(7, box, objects::ObjectState::New)});
  const BufferPtr buffer = frameAt(1);
  const GstVideoInfo info = kCaps.info();
  const auto list = testing::objects(kSize, {testing::object(7, box), testing::object(8, box)});
  {
    const testing::FailingNew fail(0);
    metas.add(buffer.get(), info, *list);
    EXPECT_TRUE(fail.hasFailed());
  }
  EXPECT_TRUE(toldOf(buffer.get()).empty());
  EXPECT_EQ(gst_buffer_get_n_meta(buffer.get(), GST_VIDEO_REGION_OF_INTEREST_META_API_TYPE), 2u);
  const auto told = tell(metas, 2, {testing::object(7, box), testing::object(8, box)});
  EXPECT_EQ(told.at(7).first, 0u);
  EXPECT_EQ(told.at(8).first, 80 * GST_MSECOND);
}

TEST(Detections, NameTheParentThatIsOnTheFrame) {
  RoiMetas metas;
  auto child = testing::object(9, {30, 6, 20, 10});
  child.parents = {5};
  const auto told =
      tell(metas, 0, {testing::object(5, {1, 1, 4, 4}), testing::object(7, {5, 6, 20, 10}), child});
  EXPECT_EQ(told.at(9).parent, told.at(5).roi);
  EXPECT_NE(told.at(9).parent, 0);
  EXPECT_EQ(told.at(7).parent, 0);
}

TEST(Detections, ContainTheirClass) {
  RoiMetas metas;
  const BufferPtr buffer = frameAt(0);
  metas.add(buffer.get(), kCaps.info(),
            *testing::objects(
                kSize, {testing::object(7, {5, 6, 20, 10}), testing::object(8, {40, 20, 20, 20})}));
  detection::Detections found;
  found.found = {{{38, 18, 24, 24}, 4}};
  EXPECT_EQ(addClasses(buffer.get(), kCaps.info(), found, {"walker", "model"}, Unmatched::Dropped),
            1u);
  GstAnalyticsRelationMeta* meta = gst_buffer_get_analytics_relation_meta(buffer.get());
  ASSERT_TRUE(meta);
  gpointer state = nullptr;
  GstAnalyticsODMtd detection;
  int classes = 0;
  while (gst_analytics_relation_meta_iterate(meta, &state, gst_analytics_od_mtd_get_mtd_type(),
                                             &detection)) {
    GstAnalyticsClsMtd classification;
    gpointer related = nullptr;
    if (!gst_analytics_relation_meta_get_direct_related(
            meta, detection.id, GST_ANALYTICS_REL_TYPE_CONTAIN,
            gst_analytics_cls_mtd_get_mtd_type(), &related, &classification))
      continue;
    ++classes;
    EXPECT_STREQ(g_quark_to_string(gst_analytics_cls_mtd_get_quark(&classification, 0)), "walker");
    Box box;
    float confidence = 0;
    gst_analytics_od_mtd_get_location(&detection, &box.x, &box.y, &box.width, &box.height,
                                      &confidence);
    EXPECT_EQ(box, (Box{40, 20, 20, 20}));
  }
  EXPECT_EQ(classes, 1);
}

}  // namespace
}  // namespace rg
