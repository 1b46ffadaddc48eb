// SPDX-License-Identifier: LGPL-2.1-or-later
// The parts that regionoverlay is made of.
#include "core/base/camera/camera_place.hpp"
#include "gst/overlay/figure.hpp"
#include "gst/overlay/ground_grid.hpp"
#include "gst/overlay/painter.hpp"
#include "gst/overlay/trails.hpp"
#include "tests/support/results.hpp"

#include <gst/gst.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace rg::overlay {
namespace {

using testing::object;
using testing::objects;

constexpr int64_t kSecond = 1'000'000'000;
constexpr Size kSize{640, 480};

std::vector<Point> trailOf(const Trails& trails, const objects::Object& object) {
  std::vector<Point> points;
  trails.copy(object, points);
  return points;
}

TEST(Trails, KeepTheWayInOrderAndEndWhereTheObjectIs) {
  Trails trails;
  for (int i = 0; i < 3; ++i)
    trails.advance(*objects(kSize, {object(7, {10 * i, 0, 2, 2})}), i * kSecond / 10, kSecond);
  EXPECT_EQ(trailOf(trails, object(7, {90, 0, 2, 2})),
            (std::vector<Point>{{16, 16}, {176, 16}, {336, 16}, {1456, 16}}));
  EXPECT_EQ(trailOf(trails, object(8, {90, 0, 2, 2})).size(), 1u);
}

TEST(Trails, ForgetWhatIsOlderThanTheirLength) {
  Trails trails;
  for (int i = 0; i < 100; ++i)
    trails.advance(*objects(kSize, {object(7, {i, 0, 2, 2})}), i * kSecond / 10, kSecond);
  const auto points = trailOf(trails, object(7, {100, 0, 2, 2}));
  EXPECT_EQ(points.front().x, (89 + 1) * objects::kPositionUnit);
  EXPECT_EQ(points.size(), 12u);
}

TEST(Trails, ALongTrailHasNoMorePointsThanAShortOne) {
  Trails trails;
  const auto list = objects(kSize, {object(7, {0, 0, 2, 2})});
  for (int i = 0; i < 10'000; ++i) trails.advance(*list, i * kSecond / 25, 300 * kSecond);
  EXPECT_LE(trailOf(trails, list->objects[0]).size(), 64u);
}

TEST(Trails, MoveWithTheSceneUnderAMovingCamera) {
  Trails trails;
  auto list = objects(kSize, {object(7, {10, 10, 2, 2})});
  trails.advance(*list, 0, kSecond);
  auto panned = objects(kSize, {object(7, {5, 10, 2, 2})});
  panned->setCamera(CameraMotion(Point{-5 * objects::kPositionUnit, 0}));
  trails.advance(*panned, kSecond / 10, kSecond);
  const auto points = trailOf(trails, panned->objects[0]);
  for (const Point& point : points) EXPECT_EQ(point, points.back());
}

TEST(Trails, GrowWithTheSceneUnderAZoom) {
  constexpr int64_t kOne = CameraMotion::kOne;
  Trails trails;
  trails.advance(*objects(kSize, {object(7, {419, 139, 2, 2}), object(8, {319, 239, 2, 2})}), 0,
                 kSecond);
  const auto zoomed = objects(kSize, {object(7, {500, 60, 2, 2}), object(8, {319, 239, 2, 2})});
  // What is at (320, 240) stays, all else goes away from it by a quarter.
  zoomed->setCamera({{kOne * 4 / 5, 0, 0, 0, kOne * 4 / 5, 0, 0, 0, kOne}, {320, 240}});
  trails.advance(*zoomed, kSecond / 10, kSecond);
  const auto far = trailOf(trails, zoomed->objects[0]),
             middle = trailOf(trails, zoomed->objects[1]);
  EXPECT_NEAR(far.front().x, (320 + 125) * objects::kPositionUnit, objects::kPositionUnit);
  EXPECT_NEAR(far.front().y, (240 - 125) * objects::kPositionUnit, objects::kPositionUnit);
  EXPECT_NEAR(middle.front().x, 320 * objects::kPositionUnit, objects::kPositionUnit);
  EXPECT_NEAR(middle.front().y, 240 * objects::kPositionUnit, objects::kPositionUnit);
}

TEST(Trails, EndWithTheirObject) {
  Trails trails;
  trails.advance(*objects(kSize, {object(7, {10, 10, 2, 2})}), 0, kSecond);
  trails.advance(*objects(kSize, {}), 2 * kSecond, kSecond);
  EXPECT_EQ(trailOf(trails, object(7, {0, 0, 2, 2})).size(), 1u);
}

Figure figureOf(const objects::Object& object, Size frame) {
  Figure figure;
  layOut(object, {{kSize, frame}, {}, styleFor(frame, 1)}, {}, figure);
  return figure;
}

TEST(Figure, FollowsTheFramesScale) {
  const Figure figure = figureOf(object(1, {100, 100, 20, 40}), {1280, 240});
  EXPECT_EQ(figure.box, (Box{200, 50, 40, 20}));
  EXPECT_EQ(figure.centre, (Point{220, 60}));
  EXPECT_EQ(figure.tip, (Point{236, 60}));
}

TEST(Figure, WordsSayTheState) {
  const Box box{100, 100, 20, 40};
  EXPECT_EQ(figureOf(object(12, box), kSize).text, "12");
  EXPECT_EQ(figureOf(object(12, box, objects::ObjectState::Stopped), kSize).text, "12 stopped");
  EXPECT_EQ(figureOf(object(12, box, objects::ObjectState::Occluded), kSize).text, "12 occluded");
  EXPECT_EQ(figureOf(object(12, box, objects::ObjectState::Stopped), {160, 120}).text, "12");
}

TEST(Figure, WhatHasStoppedPointsNowhere) {
  const Box box{100, 100, 20, 40};
  for (const auto& [state, dx] :
       {std::pair{objects::ObjectState::Tracked, 8}, {objects::ObjectState::Stopped, 0}}) {
    const Figure figure = figureOf(object(1, box, state), kSize);
    EXPECT_EQ(figure.tip.x - figure.centre.x, dx);
  }
}

std::vector<Figure> labelled(const std::vector<Box>& boxes) {
  const Layout layout{{kSize, kSize}, {}, styleFor(kSize, 1)};
  std::vector<Figure> figures;
  for (const Box& box : boxes) figures.push_back(figureOf(object(123, box), kSize));
  placeLabels(figures, layout);
  return figures;
}

TEST(Figure, LabelsStayInTheFrameAndClearOfEachOther) {
  const auto figures = labelled({{-30, -30, 50, 50},
                                 {630, 470, 50, 50},
                                 {300, 200, 20, 40},
                                 {302, 202, 20, 40},
                                 {304, 198, 20, 40}});
  for (size_t i = 0; i < figures.size(); ++i) {
    const Box& label = figures[i].label;
    EXPECT_EQ(intersect(label, boundsOf(kSize)), label) << i;
    for (size_t k = 0; k < i; ++k)
      EXPECT_TRUE(intersect(label, figures[k].label).isEmpty()) << i << ' ' << k;
  }
}

TEST(Figure, LabelsHideNoOtherObjectWhereThereIsRoom) {
  // Above the first one, where its label would go, stands the second.
  const auto figures = labelled({{300, 200, 40, 60}, {300, 150, 40, 48}});
  for (const Figure& figure : figures)
    for (const Figure& other : figures)
      EXPECT_TRUE(intersect(figure.label, other.box).isEmpty()) << figure.label.x;
  EXPECT_EQ(figures[0].label.y, 260);
}

TEST(Style, GrowsWithTheFrame) {
  EXPECT_EQ(styleFor({160, 120}, 1).linePx, 1);
  EXPECT_EQ(styleFor({160, 120}, 1).borderPx, 2);
  EXPECT_EQ(styleFor({3840, 2160}, 1).linePx, 7);
  EXPECT_EQ(styleFor({3840, 2160}, 1).textPx, 48);
  EXPECT_GE(styleFor({1, 1}, 0.25).textPx, 7);
}

/// The pixels of a label with this text.
std::vector<uint32_t> lettering(const std::string& text, Size* size = nullptr) {
  const Style style = styleFor(kSize, 1);
  const Size ground = labelSize(text, style);
  if (size) *size = ground;
  Image<uint32_t> image;
  image.resize({ground.width, ground.height});
  Canvas(image.view(), {0, 0}, style).label({0, 0}, text, {255, 255, 255});
  std::vector<uint32_t> pixels;
  for (int y = 0; y < ground.height; ++y)
    pixels.insert(pixels.end(), image.view().row(y), image.view().row(y) + ground.width);
  return pixels;
}

TEST(Lettering, EachLetterOfAnyScriptHasAShapeOfItsOwn) {
  const char* const names[] = {"Süd", "Sod", "Säd", "Šid", "Юг", "Ух", "Νότος"};
  for (const char* name : names)
    for (const char* other : names)
      EXPECT_EQ(lettering(name) == lettering(other), name == other) << name << ' ' << other;
}

TEST(Lettering, ALetterOfTwoBytesIsOneLetterWide) {
  Size two, one;
  lettering("ü", &one);
  lettering("üü", &two);
  const int space = styleFor(kSize, 1).spacePx;
  EXPECT_NEAR(two.width - 2 * space, 2 * (one.width - 2 * space), 1);
  EXPECT_LT(one.width, 20);
}

TEST(Lettering, LiesOnItsGroundInBlack) {
  for (const char* text : {"123", "Süd"}) {
    const auto pixels = lettering(text);
    EXPECT_TRUE(std::all_of(pixels.begin(), pixels.end(),
                            [](uint32_t pixel) { return pixel >> 24 == 255; }));
    EXPECT_GT(std::count(pixels.begin(), pixels.end(), 0xFFFFFFFF), 50) << text;
    EXPECT_TRUE(std::any_of(pixels.begin(), pixels.end(), [](uint32_t pixel) {
      return (pixel & 0xFF) < 80;
    })) << text;
  }
}

TEST(Lettering, TakesBytesThatAreNoText) {
  EXPECT_FALSE(lettering("\xC3\x28\xFF").empty());
  EXPECT_FALSE(lettering("two\nlines ü").empty());
}

std::shared_ptr<objects::Objects> seenBy(const CameraMotion& camera, Size size = kSize) {
  auto list = objects(size, {});
  list->camera = camera;
  return list;
}

CameraMotion zoom(double factor) {
  const auto scale = static_cast<int64_t>(CameraMotion::kOne * factor);
  return {{scale, 30'000'000, 0, -30'000'000, scale, CameraMotion::kOne, 20'000, -30'000,
           CameraMotion::kOne},
          {320, 240}};
}

bool isFresh(GroundGrid& grid) {
  GroundGrid other;
  other.advance(*objects(grid.size(), {}));
  const auto is = grid.lines(), fresh = other.lines();
  return std::equal(is.begin(), is.end(), fresh.begin(), fresh.end(),
                    [](const GroundGrid::Line& a, const GroundGrid::Line& b) {
                      return a.from.x == b.from.x && a.from.y == b.from.y && a.to.x == b.to.x &&
                             a.to.y == b.to.y;
                    });
}

/// The upright ones come first.
std::vector<double> columnsOf(GroundGrid& grid) {
  std::vector<double> columns;
  for (const GroundGrid::Line& line : grid.lines())
    if (line.from.x == line.to.x) columns.push_back(line.from.x);
  return columns;
}

TEST(GroundGrid, IsOfSquaresAndCoversTheFrame) {
  GroundGrid grid;
  EXPECT_TRUE(grid.lines().empty());
  grid.advance(*seenBy({}));
  EXPECT_EQ(columnsOf(grid), (std::vector<double>{79.5, 159.5, 239.5, 319.5, 399.5, 479.5, 559.5}));
  EXPECT_EQ(grid.lines().size(), 7u + 5);
  for (const GroundGrid::Line& line : grid.lines())
    EXPECT_EQ(std::hypot(line.to.x - line.from.x, line.to.y - line.from.y),
              line.from.x == line.to.x ? 479 : 639);
}

TEST(GroundGrid, MovesAsTheCameraMovesThePictureAndNeverEnds) {
  GroundGrid grid;
  grid.advance(*seenBy({}));
  for (int i = 1; i <= 1000; ++i) grid.advance(*seenBy(CameraMotion(Point{-5 * 16, 0})));
  EXPECT_EQ(columnsOf(grid),  // 5000 px are 62 squares and a half.
            (std::vector<double>{39.5, 119.5, 199.5, 279.5, 359.5, 439.5, 519.5, 599.5}));
}

/// What lies on a line has lain on one in the frame where the grid was laid out.
TEST(GroundGrid, LiesOnTheGround) {
  GroundGrid grid;
  grid.advance(*seenBy({}));
  CameraMatrix back = matrixOf({});
  for (int i = 0; i < 20; ++i) {
    grid.advance(*seenBy(zoom(.99)));
    back = chained(back, matrixOf(zoom(.99)));
  }
  EXPECT_FALSE(isFresh(grid));
  ASSERT_GT(grid.lines().size(), 8u);
  const auto offLine = [](double at, double middle) {
    const double squares = (at - middle) / 80;
    return std::abs(squares - std::round(squares));
  };
  for (const GroundGrid::Line& line : grid.lines())
    for (const GroundGrid::Place& p : {line.from, line.to}) {
      EXPECT_TRUE(p.x >= 0 && p.x <= 639 && p.y >= 0 && p.y <= 479) << p.x << ' ' << p.y;
      const double w = back[6] * p.x + back[7] * p.y + back[8];
      const double x = (back[0] * p.x + back[1] * p.y + back[2]) / w;
      const double y = (back[3] * p.x + back[4] * p.y + back[5]) / w;
      EXPECT_LT(std::min(offLine(x, 319.5), offLine(y, 239.5)), 1e-6);
    }
}

TEST(GroundGrid, IsLaidOutAnewWhereItCanNoLongerBeRead) {
  GroundGrid grid;
  grid.advance(*seenBy({}));
  int frames = 0;
  do {
    grid.advance(*seenBy(zoom(.95)));
    EXPECT_LT(grid.lines().size(), 100u);
  } while (!isFresh(grid) && ++frames < 100);
  EXPECT_GT(frames, 5);
  EXPECT_LT(frames, 30);
}

TEST(GroundGrid, IsLaidOutAnewForAnotherSceneOrSize) {
  GroundGrid grid;
  for (int i = 0; i < 3; ++i) grid.advance(*seenBy(zoom(.97)));
  ASSERT_FALSE(isFresh(grid));
  const auto changed = seenBy(zoom(.97));
  changed->events = {{objects::EventKind::SceneChanged, {}}};
  grid.advance(*changed);
  EXPECT_TRUE(isFresh(grid));
  grid.advance(*seenBy(zoom(.97)));
  grid.advance(*seenBy(zoom(.97), {64, 48}));
  EXPECT_EQ(grid.size(), (Size{64, 48}));
  EXPECT_TRUE(isFresh(grid));
}

TEST(GroundGrid, SurvivesCamerasOfNonsense) {
  GroundGrid grid;
  CameraMotion::Matrix matrix{};
  for (const Size size : {kSize, Size{1, 1}, {16384, 1}})
    for (const int64_t value : {INT64_MIN, INT64_MAX, int64_t{0}, CameraMotion::kOne}) {
      matrix.fill(value);
      grid.advance(*seenBy({matrix, {INT32_MIN, INT32_MAX}}, size));
      grid.advance(*seenBy({matrix, {-16384, 16384}}, size));
      EXPECT_LE(grid.lines().size(), 128u);
    }
}

TEST(Painter, HasNothingToDrawWithoutObjects) {
  Painter painter;
  EXPECT_FALSE(painter.paint({kSize}, {}));
  EXPECT_FALSE(painter.paint({kSize, 25, objects(kSize, {}).get()}, {}));
  const auto hidden = objects(kSize, {object(1, {5, 5, 9, 9}, objects::ObjectState::Lost),
                                      object(2, {5, 5, 9, 9}, objects::ObjectState::New)});
  EXPECT_FALSE(painter.paint({kSize, 25, hidden.get()}, {}));
}

std::vector<Box> rectanglesOf(const CompositionPtr& composition) {
  std::vector<Box> boxes;
  for (guint i = 0; i < gst_video_overlay_composition_n_rectangles(composition.get()); ++i) {
    gint x = 0, y = 0;
    guint width = 0, height = 0;
    gst_video_overlay_rectangle_get_render_rectangle(
        gst_video_overlay_composition_get_rectangle(composition.get(), i), &x, &y, &width, &height);
    boxes.push_back({x, y, static_cast<int>(width), static_cast<int>(height)});
  }
  return boxes;
}

int64_t areaOf(const CompositionPtr& composition) {
  int64_t area = 0;
  for (const Box& box : rectanglesOf(composition)) area += box.area();
  return area;
}

TEST(Painter, DrawsARectangleForEachObjectAndOverTheseEachLabel) {
  Painter painter;
  const auto list = objects(kSize, {object(1, {50, 50, 40, 80}), object(2, {60, 60, 40, 80})});
  const auto composition = painter.paint({kSize, 25, list.get()}, {});
  ASSERT_TRUE(composition);
  const auto boxes = rectanglesOf(composition);
  ASSERT_EQ(boxes.size(), 4u);
  for (size_t i : {0u, 1u}) EXPECT_GE(boxes[i].height, 80);
  const Size label = labelSize("1", styleFor(kSize, 1));
  for (size_t i : {2u, 3u}) EXPECT_EQ(boxes[i].height, label.height);
  EXPECT_LT(areaOf(composition), kSize.area() / 10);
}

TEST(Painter, DrawsTheGridOverTheWholeFrame) {
  Painter painter;
  Views views;
  views.grid = true;
  const auto list = seenBy({});
  EXPECT_FALSE(painter.paint({kSize, 25, list.get()}, views)) << "no frame was followed";
  painter.follow(*list, 0, 2);
  const auto composition = painter.paint({{1280, 720}, 25, list.get()}, views);
  ASSERT_TRUE(composition);
  EXPECT_EQ(rectanglesOf(composition), (std::vector<Box>{{0, 0, 1280, 720}}));
  EXPECT_FALSE(painter.paint({kSize}, views)) << "without objects' results there is no ground";
}

TEST(Painter, NeverDrawsMoreThanTheFrame) {
  Painter painter;
  std::vector<objects::Object> many;
  for (uint64_t id = 1; id <= 500; ++id)
    many.push_back(object(id, {-1000, -1000 + static_cast<int>(id), 3000, 3000}));
  const auto list = objects(kSize, many);
  const auto composition = painter.paint({kSize, 25, list.get()}, {});
  ASSERT_TRUE(composition);
  EXPECT_EQ(areaOf(composition), kSize.area());
}

TEST(Painter, DrawsACaptionThatLabelsKeepClearOf) {
  Painter painter;
  Views views;
  views.caption = "Straße Süd";
  const Box corner{0, 0, labelSize(views.caption, styleFor(kSize, 1)).width,
                   labelSize(views.caption, styleFor(kSize, 1)).height};
  const auto alone = painter.paint({kSize}, views);
  ASSERT_TRUE(alone);
  EXPECT_EQ(rectanglesOf(alone), std::vector<Box>{corner});
  const auto list = objects(kSize, {object(1, {0, corner.height + 2, 40, 80})});
  const auto both = painter.paint({kSize, 25, list.get()}, views);
  ASSERT_TRUE(both);
  const auto boxes = rectanglesOf(both);
  ASSERT_EQ(boxes.size(), 3u);  // The object, and over it the caption and the label.
  EXPECT_EQ(boxes[1], corner);
  EXPECT_TRUE(intersect(boxes[1], boxes[2]).isEmpty());
}

TEST(Painter, CutsALongCaptionBetweenLetters) {
  std::string text;
  for (int i = 0; i < 10'000; ++i) text += "ß";
  Figure figure;
  layOutCaption("a" + text, {{kSize, kSize}, {}, styleFor(kSize, 1)}, figure);
  EXPECT_EQ(figure.text, ("a" + text).substr(0, 255));
}

TEST(Painter, SurvivesBoxesFarOutside) {
  Painter painter;
  constexpr int kFar = 50'000'000;
  auto far = object(1, {kFar, -kFar, 5, 5}, objects::ObjectState::Occluded);
  auto huge = object(2, {-kFar, -kFar, 2 * kFar, 2 * kFar}, objects::ObjectState::Occluded);
  far.speedX = huge.speedY = INT32_MAX;
  const auto list = objects({1, 1}, {far, huge});
  for (const Size size : {Size{1, 1}, kSize}) {
    list->size = size;
    EXPECT_TRUE(painter.paint({size, 25, list.get()}, {}));
  }
}

}  // namespace
}  // namespace rg::overlay
