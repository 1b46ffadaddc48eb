// SPDX-License-Identifier: LGPL-2.1-or-later
// Results of a part of the frame, or of a turned one, against what is seen there pixel by pixel.
#include "core/base/camera/camera_place.hpp"
#include "core/objects/placement_matrix.hpp"
#include "core/objects/result_placer.hpp"

#include <gtest/gtest.h>

#include <array>

namespace rg::objects {
namespace {

constexpr Size kWhole{12, 9};
constexpr Box kThing{3, 2, 4, 5};  ///< Pixels of object 7 and of region 1.
constexpr Box kOther{9, 0, 2, 2};  ///< Of object 8 and of region 2.

/// A graph of two regions, which are two objects.
std::shared_ptr<const Objects> scene() {
  auto labels = std::make_shared<segmentation::Labels>();
  auto graph = std::make_shared<graph::Graph>();
  auto motion = std::make_shared<motion::Motion>();
  auto objects = std::make_shared<Objects>();
  labels->size = graph->size = motion->size = objects->size = kWhole;
  labels->status = graph->status = motion->status = objects->status = Status::Ok;
  Image<uint16_t> plane(kWhole), slots(kWhole);
  for (int y = 0; y < kWhole.height; ++y)
    for (int x = 0; x < kWhole.width; ++x)
      plane.at(x, y) = slots.at(x, y) = kThing.contains({x, y})   ? 1
                                        : kOther.contains({x, y}) ? 2
                                                                  : 0;
  labels->ids.takePacked(std::move(plane));
  labels->count = 2;
  graph->labels = labels;
  graph->regions = {{20, kThing, 4 * 256 + 128, 4 * 256, {}}, {4, kOther, 9 * 256 + 128, 128, {}}};
  motion->graph = graph;
  motion->regions = {{16, -32, 0, 256}, {0, 8, 0, 256}};
  objects->motion = motion;
  objects->slots.takePacked(std::move(slots));
  Object thing, other;
  thing.id = 7;
  thing.state = other.state = ObjectState::Tracked;
  thing.box = kThing;
  thing.areaPx = 20;
  thing.centroidX = 4 * 16 + 8;
  thing.centroidY = 4 * 16;
  thing.speedX = 160;
  thing.speedY = -80;
  thing.contour = {{3, 2}, {6, 2}, {6, 6}, {3, 6}};
  other.id = 8;
  other.box = kOther;
  other.areaPx = 4;
  objects->objects = {thing, other};
  return objects;
}

Box boxOf(const Image<uint16_t>& image, int value) {
  Box box;
  for (int y = 0; y < image.height(); ++y)
    for (int x = 0; x < image.width(); ++x)
      if (image.at(x, y) == value) box = unite(box, {x, y, 1, 1});
  return box;
}

template <class T>
Image<T> pixelsOf(const ResultPlane<T>& plane) {
  Image<T> scratch, copy(plane.pixelSize());
  const auto view = plane.unpacked(scratch);
  for (int y = 0; y < copy.height(); ++y)
    for (int x = 0; x < copy.width(); ++x) copy.at(x, y) = view.at(x, y);
  return copy;
}

class EveryTurn : public ::testing::TestWithParam<int> {
 protected:
  [[nodiscard]] Placement placement(const Box& part) const {
    return {kWhole, part, (GetParam() & 1) != 0, (GetParam() & 2) != 0, (GetParam() & 4) != 0};
  }
};

TEST_P(EveryTurn, PutsPlanesBoxesAndCentresInOnePlace) {
  const Placement to = placement({2, 1, 7, 8});
  const auto placed = place(scene(), to);
  ASSERT_EQ(placed->size, to.size());
  ASSERT_EQ(placed->objects.size(), 1u);
  const Object& thing = placed->objects[0];
  EXPECT_EQ(thing.id, 7u);
  const Image<uint16_t> slots = pixelsOf(placed->slots);
  ASSERT_EQ(slots.size(), to.size());
  EXPECT_EQ(boxOf(slots, 1), thing.box);
  EXPECT_EQ(thing.areaPx, 20u);
  EXPECT_EQ(thing.centroidX, 16 * thing.box.x + 8 * (thing.box.width - 1));
  EXPECT_EQ(thing.centroidY, 16 * thing.box.y + 8 * (thing.box.height - 1));
  const auto& graph = placed->motion->graph;
  EXPECT_EQ(graph->regions[0].box, thing.box);
  EXPECT_EQ(graph->regions[0].areaPx, 20u);
  EXPECT_EQ(graph->regions[0].centroidX, 16 * thing.centroidX);
  EXPECT_EQ(graph->regions[1].areaPx, 0u);
  EXPECT_TRUE(graph->regions[1].box.isEmpty());
  EXPECT_EQ(boxOf(pixelsOf(graph->labels->ids), 1), thing.box);
}

TEST_P(EveryTurn, TurnsVectorsAsPixels) {
  const Placement to = placement({2, 1, 7, 8});
  const auto placed = place(scene(), to);
  // A pixel and the one it was at a moment before.
  const auto find = [&](Point source) {
    for (int y = 0; y < to.size().height; ++y)
      for (int x = 0; x < to.size().width; ++x)
        if (to.sourceOf({x, y}) == source) return Point{x, y};
    return Point{-1, -1};
  };
  const Point a = find({4, 4}), b = find({5, 2});  // By (1, -2).
  EXPECT_EQ(placed->motion->regions[0].dx, 16 * (b.x - a.x));
  EXPECT_EQ(placed->motion->regions[0].dy, 16 * (b.y - a.y));
  const Point c = find({6, 3});  // By (2, -1).
  EXPECT_EQ(placed->objects[0].speedX, 80 * (c.x - a.x));
  EXPECT_EQ(placed->objects[0].speedY, 80 * (c.y - a.y));
}

TEST_P(EveryTurn, KeepsContoursClockwise) {
  const auto placed = place(scene(), placement({2, 1, 7, 8}));
  const std::vector<Point>& contour = placed->objects[0].contour;
  ASSERT_EQ(contour.size(), 4u);
  int64_t twiceArea = 0;
  for (size_t i = 0; i < 4; ++i) {
    const Point p = contour[i], q = contour[(i + 1) % 4];
    twiceArea += int64_t{p.x} * q.y - int64_t{q.x} * p.y;
  }
  EXPECT_EQ(twiceArea, 2 * 3 * 4);  // Of the centres; y grows downwards.
}

/// A zoom and a roll: each pixel comes from where it came from before.
TEST_P(EveryTurn, TurnsTheCameraAsPixels) {
  constexpr int64_t kOne = CameraMotion::kOne;
  auto zoomed = std::make_shared<Objects>(Objects{});
  zoomed->copyFrom(*scene());
  zoomed->camera = {{kOne * 9 / 10, kOne / 50, kOne / 3, -kOne / 40, kOne * 95 / 100, -kOne / 5,
                     kOne / 1000, -kOne / 800, kOne},
                    {6, 4}};
  const Placement to = placement({2, 1, 7, 8});
  const auto placed = place<Objects>(zoomed, to);
  const auto before = [](const CameraMotion& camera, Point p) {
    const CameraMatrix m = matrixOf(camera);
    const double w = m[6] * p.x + m[7] * p.y + m[8];
    return std::pair((m[0] * p.x + m[1] * p.y + m[2]) / w, (m[3] * p.x + m[4] * p.y + m[5]) / w);
  };
  for (const Point p : {Point{0, 0}, Point{6, 0}, Point{0, 6}, Point{5, 4}}) {
    auto [x, y] = before(placed->camera, p);
    if (to.isMirroredX) x = to.size().width - 1 - x;
    if (to.isMirroredY) y = to.size().height - 1 - y;
    if (to.isTransposed) std::swap(x, y);
    const auto [wasX, wasY] = before(zoomed->camera, to.sourceOf(p));
    EXPECT_NEAR(x + to.part.x, wasX, 1e-6);
    EXPECT_NEAR(y + to.part.y, wasY, 1e-6);
  }
  const Point atMiddle = placed->camera.at(to.size().width / 2, to.size().height / 2);
  EXPECT_EQ((Point{placed->cameraDx, placed->cameraDy}), atMiddle);
}

INSTANTIATE_TEST_SUITE_P(Turns, EveryTurn, ::testing::Range(0, 8));

TEST(ResultPlacer, CutsWhatLeavesTheFrame) {
  const auto placed = place(scene(), {kWhole, {5, 3, 6, 6}});
  ASSERT_EQ(placed->objects.size(), 1u);
  EXPECT_EQ(placed->objects[0].box, (Box{-2, -1, 4, 5})) << "boxes of objects may leave it";
  EXPECT_EQ(placed->objects[0].areaPx, 8u);
  EXPECT_EQ(placed->motion->graph->regions[0].box, (Box{0, 0, 2, 4}));
  EXPECT_EQ(placed->motion->graph->regions[0].areaPx, 8u);
  for (const Point p : placed->objects[0].contour) EXPECT_TRUE((Box{0, 0, 6, 6}.contains(p)));
}

TEST(ResultPlacer, NumbersTheSlotsOfWhatIsLeft) {
  const auto placed = place(scene(), {kWhole, {8, 0, 4, 4}});
  ASSERT_EQ(placed->objects.size(), 1u);
  EXPECT_EQ(placed->objects[0].id, 8u);
  EXPECT_EQ(boxOf(pixelsOf(placed->slots), 1), (Box{1, 0, 2, 2}));
}

TEST(ResultPlacer, ScalesToTheFrameFirst) {
  const auto placed = place(scene(), {{24, 27}, {4, 3, 16, 20}});
  ASSERT_EQ(placed->objects.size(), 2u);
  EXPECT_EQ(placed->objects[0].box, (Box{2, 3, 8, 15}));
  EXPECT_EQ(boxOf(pixelsOf(placed->slots), 1), (Box{2, 3, 8, 15}));
  EXPECT_EQ(placed->objects[0].areaPx, 8u * 15);
  EXPECT_EQ(placed->objects[0].speedX, 320);
}

TEST(ResultPlacer, LeavesNothingWhereTheFrameEnds) {
  const auto placed = place(scene(), {kWhole, {-2, -3, 16, 15}});
  const Image<uint16_t> slots = pixelsOf(placed->slots);
  EXPECT_EQ(boxOf(slots, 1), (Box{5, 5, 4, 5}));
  EXPECT_EQ(int{slots.at(0, 0)}, 0);
  EXPECT_EQ(int{slots.at(15, 14)}, 0);
}

TEST(ResultPlacer, TakesSkippedFramesAndNone) {
  EXPECT_EQ(place(std::shared_ptr<const Objects>(), {kWhole, {0, 0, 2, 2}}), nullptr);
  const auto placed = place(std::make_shared<const Objects>(), {kWhole, {0, 0, 2, 2}});
  EXPECT_EQ(placed->status, Status::Skipped);
  EXPECT_TRUE(placed->slots.pixelSize().isEmpty());
}

TEST(ResultPlacer, CountsTheForegroundAnew) {
  auto foreground = std::make_shared<background::Foreground>();
  foreground->size = kWhole;
  Image<uint8_t> mask(kWhole);
  mask.fill(0);
  for (int x = 2; x < 8; ++x) mask.at(x, 4) = background::kForegroundPixel;
  foreground->mask.takePacked(std::move(mask));
  foreground->areas = {{2, 4, 6, 1}, {0, 8, 1, 1}};
  foreground->scene.foregroundPx = 6;
  const auto placed =
      place<background::Foreground>(foreground, {kWhole, {4, 2, 8, 5}, false, true, false});
  EXPECT_EQ(placed->scene.foregroundPx, 4u);
  EXPECT_EQ(placed->areas, std::vector<Box>({{4, 2, 4, 1}}));
}

// Matrices.

std::optional<Placement> placed(const std::array<float, 9>& m, Size to, Box toPart = {},
                                Box fromPart = boundsOf(kWhole)) {
  const float matrix[3][3] = {{m[0], m[1], m[2]}, {m[3], m[4], m[5]}, {m[6], m[7], m[8]}};
  return placementOf({kWhole, to, fromPart, toPart, matrix});
}

void expectPart(const std::optional<Placement>& placement, const Box& part, bool isTransposed,
                bool isMirroredX, bool isMirroredY) {
  ASSERT_TRUE(placement);
  EXPECT_EQ(placement->part, part);
  EXPECT_EQ(placement->isTransposed, isTransposed);
  EXPECT_EQ(placement->isMirroredX, isMirroredX);
  EXPECT_EQ(placement->isMirroredY, isMirroredY);
}

TEST(PlacementMatrix, TellsCropsFlipsAndTurns) {
  expectPart(placed({1, 0, 0, 0, 1, 0, 0, 0, 1}, kWhole), {0, 0, 12, 9}, false, false, false);
  expectPart(placed({1, 0, -2, 0, 1, -3, 0, 0, 1}, {5, 4}), {2, 3, 5, 4}, false, false, false);
  expectPart(placed({-1, 0, 12, 0, 1, 0, 0, 0, 1}, kWhole), {0, 0, 12, 9}, false, true, false);
  expectPart(placed({1, 0, 0, 0, -1, 9, 0, 0, 1}, kWhole), {0, 0, 12, 9}, false, false, true);
  // Clockwise: the source's upper edge is on the right.
  expectPart(placed({0, -1, 9, 1, 0, 0, 0, 0, 1}, {9, 12}), {0, 0, 12, 9}, true, true, false);
  expectPart(placed({0, 2, 0, 2, 0, 0, 0, 0, 2}, {9, 12}), {0, 0, 12, 9}, true, false, false);
}

TEST(PlacementMatrix, LeavesTheScaleToTheSizes) {
  const auto half = placed({.5F, 0, 0, 0, .5F, 0, 0, 0, 1}, {6, 5});
  expectPart(half, {0, 0, 12, 10}, false, false, false);
  const auto letterbox = placed({1, 0, 0, 0, 1, 0, 0, 0, 1}, {16, 15}, {2, 3, 12, 9});
  expectPart(letterbox, {-2, -3, 16, 15}, false, false, false);
}

TEST(PlacementMatrix, DropsWhatItCantFollow) {
  EXPECT_FALSE(placed({.8F, .6F, 0, -.6F, .8F, 0, 0, 0, 1}, kWhole)) << "a turn";
  EXPECT_FALSE(placed({1, 0, 0, 0, 1, 0, .01F, 0, 1}, kWhole)) << "perspective";
  EXPECT_FALSE(placed({0, 0, 0, 0, 0, 0, 0, 0, 1}, kWhole)) << "a point";
  EXPECT_FALSE(placed({1, 0, 0, 0, 1, 0, 0, 0, 0}, kWhole)) << "no matrix";
  EXPECT_FALSE(placed({1, 0, -40, 0, 1, 0, 0, 0, 1}, kWhole)) << "out of view";
  EXPECT_FALSE(placed({1e-9F, 0, 0, 0, 1e-9F, 0, 0, 0, 1}, kWhole)) << "a dot";
  const Box part{2, 2, 4, 4};
  EXPECT_FALSE(placed({1, 0, 0, 0, 1, 0, 0, 0, 1}, {8, 8}, {2, 2, 4, 4}, part)) << "a letterbox";
  expectPart(placed({1, 0, 0, 0, 1, 0, 0, 0, 1}, {4, 4}, {0, 0, 4, 4}, part), part, false, false,
             false);
}

}  // namespace
}  // namespace rg::objects
