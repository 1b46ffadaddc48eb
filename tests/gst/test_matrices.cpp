// SPDX-License-Identifier: LGPL-2.1-or-later
// Metas of frames that elements of GStreamer 1.28 cropped or turned.
#include "tests/support/results.hpp"

#include <gst/video/video.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <memory>

namespace rg {
namespace {

constexpr Size kWhole{64, 48};
constexpr Box kBox{20, 10, 12, 8};

struct Unref {
  void operator()(GstBuffer* buffer) const { gst_buffer_unref(buffer); }
};
using BufferPtr = std::unique_ptr<GstBuffer, Unref>;

GstVideoInfo infoOf(Size size) {
  GstVideoInfo info;
  gst_video_info_set_format(&info, GST_VIDEO_FORMAT_GRAY8, static_cast<guint>(size.width),
                            static_cast<guint>(size.height));
  return info;
}

class Matrices : public ::testing::Test {
 protected:
  static void SetUpTestSuite() { gst_init(nullptr, nullptr); }

  Matrices() : from_(gst_buffer_new()), to_(gst_buffer_new()) {
    attachResult<background::Foreground>(from_.get(), testing::foreground(kWhole, kBox));
    attachResult<objects::Objects>(from_.get(),
                                   testing::objects(kWhole, {testing::object(7, kBox)}));
  }

  /// As videocrop and videoflip do it for each meta. Whether all of them were taken over.
  bool draw(const Box& part, Size to, const std::array<float, 9>& m) {
    const GstVideoInfo in = infoOf(kWhole), out = infoOf(to);
    GstVideoMetaTransformMatrix drawn{
        &in, {part.x, part.y, part.width, part.height}, &out, {0, 0, to.width, to.height}, {}};
    std::copy(m.begin(), m.end(), &drawn.matrix[0][0]);
    bool areTaken = true;
    gpointer state = nullptr;
    while (GstMeta* meta = gst_buffer_iterate_meta(from_.get(), &state))
      areTaken &=
          meta->info->transform_func(to_.get(), meta, from_.get(),
                                     gst_video_meta_transform_matrix_get_quark(), &drawn) != FALSE;
    return areTaken;
  }
  [[nodiscard]] std::shared_ptr<const objects::Objects> objectsThere() const {
    return findResult<objects::Objects>(to_.get());
  }
  void expectAt(const Box& box, Size size) const {
    const auto foreground = findResult<background::Foreground>(to_.get());
    ASSERT_TRUE(objectsThere() && foreground);
    EXPECT_EQ(objectsThere()->size, size);
    ASSERT_EQ(objectsThere()->objects.size(), 1u);
    EXPECT_EQ(objectsThere()->objects[0].box, box);
    EXPECT_EQ(foreground->size, size);
    EXPECT_EQ(foreground->areas, std::vector<Box>{box});
  }

  BufferPtr from_, to_;
};

TEST_F(Matrices, OfACropMoveBoxes) {
  ASSERT_TRUE(draw({14, 6, 40, 30}, {40, 30}, {1, 0, 0, 0, 1, 0, 0, 0, 1}));
  expectAt({6, 4, 12, 8}, {40, 30});
}

TEST_F(Matrices, OfAMirrorMoveBoxesToTheOtherSide) {
  ASSERT_TRUE(draw(boundsOf(kWhole), kWhole, {-1, 0, 64, 0, 1, 0, 0, 0, 1}));
  expectAt({32, 10, 12, 8}, kWhole);
}

TEST_F(Matrices, OfAQuarterTurnChangeColumnsForRows) {
  ASSERT_TRUE(draw(boundsOf(kWhole), {48, 64}, {0, -1, 48, 1, 0, 0, 0, 0, 1}));
  expectAt({30, 20, 8, 12}, {48, 64});
}

TEST_F(Matrices, OfOtherTurnsDropTheMetas) {
  EXPECT_FALSE(draw(boundsOf(kWhole), kWhole, {.8F, -.6F, 0, .6F, .8F, 0, 0, 0, 1}));
  EXPECT_FALSE(gst_buffer_get_region_foreground_meta(to_.get()));
  EXPECT_FALSE(gst_buffer_get_region_objects_meta(to_.get()));
}

/// Stages that skipped a frame say so of every part of it.
TEST_F(Matrices, OfASkippedFrameAreTaken) {
  attachResult(from_.get(), std::make_shared<const objects::Objects>());
  ASSERT_TRUE(draw({14, 6, 40, 30}, {40, 30}, {1, 0, 0, 0, 1, 0, 0, 0, 1}));
  ASSERT_TRUE(objectsThere());
  EXPECT_EQ(objectsThere()->status, Status::Skipped);
}

}  // namespace
}  // namespace rg
