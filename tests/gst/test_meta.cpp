// SPDX-License-Identifier: LGPL-2.1-or-later
// The public header: what applications read from a buffer.
#include "gst/meta/result_meta.hpp"
#include "tests/support/harness.hpp"

#include <gmock/gmock.h>
#include <gst/video/gstvideometa.h>
#include <gtest/gtest.h>

#include <memory>
#include <utility>
#include <vector>

namespace rg {
namespace {

using testing::BufferPtr;

std::shared_ptr<graph::Graph> twoRegions() {
  auto graph = std::make_shared<graph::Graph>();
  graph->size = {8, 4};
  graph->status = Status::Ok;
  graph->regions = {{12, {0, 0, 4, 3}, 384, 256, {1, 2, 3}},
                    {20, {4, 0, 4, 4}, 1408, 384, {4, 5, 6}}};
  graph->arcs = {
      {segmentation::RegionLabel::ofIndex(0), segmentation::RegionLabel::ofIndex(1), 4, 10}};
  return graph;
}

TEST(GraphMeta, TellsRegionsAndArcs) {
  const BufferPtr buffer(gst_buffer_new());
  EXPECT_EQ(gst_buffer_get_region_graph_meta(buffer.get()), nullptr);
  attachResult<graph::Graph>(buffer.get(), twoRegions());
  GstRegionGraphMeta* meta = gst_buffer_get_region_graph_meta(buffer.get());
  ASSERT_NE(meta, nullptr);
  gint width = 0, height = 0;
  EXPECT_EQ(gst_region_graph_meta_get_status(meta, &width, &height), GST_REGION_STATUS_OK);
  EXPECT_EQ(width, 8);
  EXPECT_EQ(height, 4);
  ASSERT_EQ(gst_region_graph_meta_get_n_regions(meta), 2u);
  GstRegion region;
  ASSERT_TRUE(gst_region_graph_meta_get_region(meta, 1, &region));
  EXPECT_EQ(region.id, 2u);
  EXPECT_EQ(region.area, 20u);
  EXPECT_EQ(region.box.x, 4);
  EXPECT_DOUBLE_EQ(region.centroid_x, 5.5);
  EXPECT_EQ(region.colour.green, 5);
  gst_region_get_box(&region, &width, nullptr, nullptr, &height);
  EXPECT_EQ(width, 4);
  EXPECT_EQ(height, 4);
  guint8 red = 0, blue = 0;
  gst_region_get_colour(&region, &red, nullptr, &blue);
  EXPECT_EQ(red, 4);
  EXPECT_EQ(blue, 6);
  EXPECT_FALSE(gst_region_graph_meta_get_region(meta, 2, &region));
  GstRegionArc arc;
  ASSERT_TRUE(gst_region_graph_meta_get_arc(meta, 0, &arc));
  EXPECT_EQ(arc.a, 1u);
  EXPECT_EQ(arc.b, 2u);
  EXPECT_DOUBLE_EQ(arc.contrast, 2.5);
  EXPECT_FALSE(gst_region_graph_meta_get_arc(meta, 1, &arc));
}

TEST(MotionMeta, TellsPixelsAndShares) {
  const BufferPtr buffer(gst_buffer_new());
  auto motion = std::make_shared<motion::Motion>();
  motion->regions = {{-24, 8, 7, 128}};
  attachResult<motion::Motion>(buffer.get(), motion);
  GstRegionVector vector;
  GstRegionMotionMeta* meta = gst_buffer_get_region_motion_meta(buffer.get());
  ASSERT_TRUE(gst_region_motion_meta_get_vector(meta, 0, &vector));
  EXPECT_DOUBLE_EQ(vector.dx, -1.5);
  EXPECT_DOUBLE_EQ(vector.dy, 0.5);
  EXPECT_DOUBLE_EQ(vector.reliability, 0.5);
}

TEST(ObjectsMeta, TellsObjectsParentsAndContours) {
  BufferPtr buffer(gst_buffer_new());
  auto objects = std::make_shared<objects::Objects>();
  objects::Object object;
  object.id = 7;
  object.state = objects::ObjectState::Stopped;
  object.box = {-2, 3, 10, 20};
  object.centroidX = 40;
  object.speedX = -32;
  object.hasSpeed = true;
  object.parents = {3, 5};
  object.contour = {{1, 2}, {3, 4}};
  objects->objects = {object};
  objects->regionObject = {0, 7};
  objects->cameraDx = 24;
  objects->camera = CameraMotion(Point{24, -8});
  attachResult<objects::Objects>(buffer.get(), objects);
  GstRegionObjectsMeta* meta = gst_buffer_get_region_objects_meta(buffer.get());
  GstRegionObject out;
  ASSERT_TRUE(gst_region_objects_meta_get_object(meta, 0, &out));
  EXPECT_EQ(out.id, 7u);
  EXPECT_EQ(out.state, GST_REGION_OBJECT_STATE_STOPPED);
  EXPECT_EQ(out.box.x, -2);
  gint boxX = 0, boxWidth = 0;
  gst_region_object_get_box(&out, &boxX, nullptr, &boxWidth, nullptr);
  EXPECT_EQ(boxX, -2);
  EXPECT_EQ(boxWidth, 10);
  EXPECT_DOUBLE_EQ(out.centroid_x, 2.5);
  EXPECT_DOUBLE_EQ(out.velocity_x, -2.0);
  EXPECT_EQ(out.n_parents, 2u);
  EXPECT_EQ(gst_region_objects_meta_get_parent(meta, 0, 1), 5u);
  EXPECT_EQ(gst_region_objects_meta_get_parent(meta, 0, 2), 0u);
  gint x = 0, y = 0;
  ASSERT_TRUE(gst_region_objects_meta_get_contour_point(meta, 0, 1, &x, &y));
  EXPECT_EQ(x, 3);
  EXPECT_EQ(y, 4);
  EXPECT_FALSE(gst_region_objects_meta_get_contour_point(meta, 1, 0, &x, &y));
  EXPECT_EQ(gst_region_objects_meta_get_region_object(meta, 2), 7u);
  EXPECT_EQ(gst_region_objects_meta_get_region_object(meta, 0), 0u);
  EXPECT_EQ(gst_region_objects_meta_get_region_object(meta, 3), 0u);
  gdouble dx = 0, dy = 1;
  gst_region_objects_meta_get_camera_motion(meta, &dx, &dy);
  EXPECT_DOUBLE_EQ(dx, 1.5);
  EXPECT_DOUBLE_EQ(dy, 0.0);
  gdouble* matrix = gst_region_objects_meta_get_camera_matrix(meta);
  buffer.reset();
  EXPECT_EQ((std::vector<gdouble>{matrix, matrix + 9}),
            (std::vector<gdouble>{1, 0, -1.5, 0, 1, .5, 0, 0, 1}));
  g_free(matrix);
}

TEST(ObjectsMeta, TellsTheCameraFromTheLeftUpperCorner) {
  const BufferPtr buffer(gst_buffer_new());
  constexpr int64_t kOne = CameraMotion::kOne;
  auto objects = std::make_shared<objects::Objects>();
  objects->camera = {{kOne / 2, 0, 0, 0, kOne / 2, kOne, 0, 0, kOne}, {32, 24}};
  attachResult<objects::Objects>(buffer.get(), objects);
  gdouble* matrix =
      gst_region_objects_meta_get_camera_matrix(gst_buffer_get_region_objects_meta(buffer.get()));
  EXPECT_EQ((std::vector<gdouble>{matrix, matrix + 9}),
            (std::vector<gdouble>{.5, 0, 16, 0, .5, 13, 0, 0, 1}));
  g_free(matrix);
}

std::shared_ptr<background::Foreground> smallMask() {
  auto foreground = std::make_shared<background::Foreground>();
  foreground->size = {3, 2};
  foreground->status = Status::Ok;
  foreground->mask.resize(foreground->size);
  foreground->mask.fill(background::kBackgroundPixel);
  foreground->mask.at(2, 1) = background::kForegroundPixel;
  return foreground;
}

TEST(Plane, OutlivesItsBuffer) {
  BufferPtr buffer(gst_buffer_new());
  attachResult<background::Foreground>(buffer.get(), smallMask());
  GstRegionPlane plane;
  ASSERT_TRUE(gst_region_foreground_meta_map(gst_buffer_get_region_foreground_meta(buffer.get()),
                                             &plane, nullptr));
  buffer.reset();
  EXPECT_EQ(plane.width, 3);
  EXPECT_EQ(plane.height, 2);
  EXPECT_EQ(plane.pixel_bytes, 1u);
  EXPECT_EQ(static_cast<const guint8*>(plane.data)[plane.stride + 2], 255);
  gst_region_plane_unmap(&plane);
  EXPECT_EQ(plane.data, nullptr);
  gst_region_plane_unmap(&plane);
}

struct FreeBytes {
  void operator()(GBytes* bytes) const { g_bytes_unref(bytes); }
};
using BytesPtr = std::unique_ptr<GBytes, FreeBytes>;

template <class T>
std::vector<T> pixelsOf(const BytesPtr& bytes) {
  gsize size = 0;
  const auto* pixels = static_cast<const T*>(g_bytes_get_data(bytes.get(), &size));
  return {pixels, pixels + size / sizeof(T)};
}

BytesPtr maskBytes(std::shared_ptr<background::Foreground> foreground) {
  const BufferPtr buffer(gst_buffer_new());
  attachResult<background::Foreground>(buffer.get(), std::move(foreground));
  GstRegionPlane plane;
  EXPECT_TRUE(gst_region_foreground_meta_map(gst_buffer_get_region_foreground_meta(buffer.get()),
                                             &plane, nullptr));
  plane.height = 1000;  // A reader may write anything into what it was given.
  plane.data = nullptr;
  BytesPtr bytes(gst_region_plane_get_bytes(&plane));
  gst_region_plane_unmap(&plane);
  EXPECT_EQ(gst_region_plane_get_bytes(&plane), nullptr);
  return bytes;
}

TEST(PlaneBytes, HaveNothingBetweenRows) {
  const BytesPtr bytes = maskBytes(smallMask());
  EXPECT_THAT(pixelsOf<guint8>(bytes), ::testing::ElementsAre(0, 0, 0, 0, 0, 255));
}

TEST(PlaneBytes, ShareRowsThatAreNotPadded) {
  auto foreground = smallMask();
  foreground->mask.resize({64, 2});
  foreground->mask.fill(background::kBackgroundPixel);
  foreground->mask.at(63, 1) = background::kForegroundPixel;
  const guint8* const pixels = foreground->mask.row(0);
  const std::weak_ptr<background::Foreground> payload = foreground;
  BytesPtr bytes = maskBytes(std::move(foreground));
  EXPECT_EQ(g_bytes_get_data(bytes.get(), nullptr), pixels);
  EXPECT_EQ(pixelsOf<guint8>(bytes).size(), 128u);
  EXPECT_EQ(pixelsOf<guint8>(bytes).back(), 255);
  bytes.reset();
  EXPECT_TRUE(payload.expired());
}

template <class T>
void pack(ResultPlane<T>& plane) {
  ResultPlane<T> packed;
  PlanePacker().pack(plane, packed, plane.size());
  plane = std::move(packed);
}

TEST(PlaneBytes, AreReadFromPackedResults) {
  auto labels = std::make_shared<segmentation::Labels>();
  labels->size = {32, 2};
  labels->status = Status::Ok;
  labels->ids.resize(labels->size);
  labels->ids.fill(0);
  labels->ids.at(31, 1) = 259;
  pack(labels->ids);
  ASSERT_TRUE(labels->ids.isPacked());
  BufferPtr buffer(gst_buffer_new());
  attachResult<segmentation::Labels>(buffer.get(), std::move(labels));
  GstRegionPlane plane;
  ASSERT_TRUE(
      gst_region_labels_meta_map(gst_buffer_get_region_labels_meta(buffer.get()), &plane, nullptr));
  const BytesPtr bytes(gst_region_plane_get_bytes(&plane));
  gst_region_plane_unmap(&plane);
  buffer.reset();
  std::vector<guint16> expected(64, 0);
  expected.back() = 259;
  EXPECT_EQ(pixelsOf<guint16>(bytes), expected);
}

TEST(Plane, OfASkippedFrameIsAnError) {
  const BufferPtr buffer(gst_buffer_new());
  attachResult<background::Foreground>(buffer.get(), std::make_shared<background::Foreground>());
  GstRegionPlane plane;
  GError* error = nullptr;
  EXPECT_FALSE(gst_region_foreground_meta_map(gst_buffer_get_region_foreground_meta(buffer.get()),
                                              &plane, &error));
  ASSERT_NE(error, nullptr);
  g_error_free(error);
}

TEST(Meta, CopiesShareOnePayloadAndFreeIt) {
  const auto payload = smallMask();
  {
    const BufferPtr buffer(gst_buffer_new());
    attachResult<background::Foreground>(buffer.get(), payload);
    const BufferPtr copy(gst_buffer_copy(buffer.get()));
    EXPECT_EQ(findResult<background::Foreground>(copy.get()).get(), payload.get());
    EXPECT_EQ(payload.use_count(), 3);
  }
  EXPECT_EQ(payload.use_count(), 1);
}

TEST(Meta, APartOfABufferLosesIt) {
  const BufferPtr buffer(gst_buffer_new_allocate(nullptr, 100, nullptr));
  attachResult<background::Foreground>(buffer.get(), smallMask());
  const BufferPtr part(gst_buffer_copy_region(buffer.get(), GST_BUFFER_COPY_ALL, 10, 20));
  EXPECT_EQ(findResult<background::Foreground>(part.get()), nullptr);
}

TEST(Meta, SurvivesConversionAndScalingAndIsDroppedByCropping) {
  const auto passes = [](const char* line) {
    testing::Chain chain(line, {"BGRx", 32, 32});
    BufferPtr frame = testing::paint(chain.caps(), 0, testing::square(4, 4, 9));
    attachResult<background::Foreground>(frame.get(), smallMask());
    const BufferPtr out = chain.pass(std::move(frame));
    return out && findResult<background::Foreground>(out.get()) != nullptr;
  };
  EXPECT_TRUE(passes("videoconvert ! capsfilter caps=video/x-raw,format=I420"));
  EXPECT_TRUE(passes("videoscale ! capsfilter caps=video/x-raw,width=16,height=16"));
  EXPECT_FALSE(passes("videocrop left=8"));
}

}  // namespace
}  // namespace rg
