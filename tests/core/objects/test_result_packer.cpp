// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/object_delay.hpp"
#include "core/objects/result_packer.hpp"
#include "tests/core/scenes.hpp"
#include "tests/support/digest.hpp"

#include <gtest/gtest.h>

#include <memory>
#include <random>

namespace rg {
namespace {

using namespace scenes;
using testing::digestOf;

/// Runs of random lengths up to `longest`, of values up to `most`.
template <class T>
ResultPlane<T> randomPlane(Size size, int longest, int most, unsigned seed) {
  std::mt19937 random(seed);
  ResultPlane<T> plane(size);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width;) {
      const int end = std::min(size.width, x + 1 + static_cast<int>(random()) % longest);
      const auto value = static_cast<T>(random() % static_cast<unsigned>(most + 1));
      std::fill(plane.row(y) + x, plane.row(y) + std::max(end, x + 1), value);
      x = std::max(end, x + 1);
    }
  return plane;
}

template <class T>
void expectSame(const ResultPlane<T>& packed, const ResultPlane<T>& plane) {
  ASSERT_TRUE(packed.isPacked());
  ASSERT_EQ(packed.pixelSize(), plane.size());
  Image<T> scratch;
  const ImageView<const T> pixels = packed.unpacked(scratch);
  std::vector<T> row;
  for (int y = 0; y < plane.height(); ++y) {
    const auto bytes = static_cast<size_t>(plane.width()) * sizeof(T);
    ASSERT_EQ(std::memcmp(pixels.row(y), plane.row(y), bytes), 0) << y;
    ASSERT_EQ(std::memcmp(packed.unpackedRow(y, row), plane.row(y), bytes), 0) << y;
  }
}

template <class T>
void packsAll() {
  PlanePacker packer;
  ResultPlane<T> packed, copy;  // Of all sizes in turn, as a pool's are.
  unsigned seed = 1;
  for (const Size size : {Size{1, 1}, {1, 9}, {63, 5}, {64, 4}, {257, 3}, {40, 30}, {2000, 2}})
    for (const int longest : {1, 2, 7, 500})
      for (const int most : {0, 1, 255, 65535}) {
        const auto plane = randomPlane<T>(size, longest, most, ++seed);
        packer.pack(plane, packed, size);
        expectSame(packed, plane);
        copy.copyFrom(packed);
        expectSame(copy, plane);
        copy.copyFrom(plane);
        ASSERT_FALSE(copy.isPacked());
        ASSERT_EQ(copy.view().at(0, 0), plane.at(0, 0));
      }
}

TEST(PlanePacker, GivesEveryPixelBack) {
  packsAll<uint8_t>();
  packsAll<uint16_t>();
}

/// Long runs, and noise that is kept as it lies.
TEST(PlanePacker, ShowsAnotherSizeByThePixelsUnderTheCentres) {
  PlanePacker packer;
  ResultPlane<uint8_t> packed;
  for (const int longest : {1, 30}) {
    const auto plane = randomPlane<uint8_t>({61, 40}, longest, 255, 7);
    for (const Size shown : {Size{244, 160}, {61, 77}, {100, 40}, {30, 13}, {1, 1}}) {
      packer.pack(plane, packed, shown);
      ASSERT_EQ(packed.pixelSize(), shown);
      Image<uint8_t> scratch;
      std::vector<uint8_t> row;
      const FrameMap map{plane.size(), shown};
      const auto pixels = packed.unpacked(scratch);
      for (int y = 0; y < shown.height; ++y)
        for (int x = 0; x < shown.width; ++x) {
          const int expected = plane.at(map.sourceX(x), map.sourceY(y));
          ASSERT_EQ(int{pixels.at(x, y)}, expected) << x << ' ' << y;
          ASSERT_EQ(int{packed.unpackedRow(y, row)[x]}, expected) << x << ' ' << y;
        }
    }
  }
}

TEST(PlanePacker, PacksWhatIsEmpty) {
  PlanePacker packer;
  ResultPlane<uint8_t> packed;
  packer.pack(ResultPlane<uint8_t>{}, packed, {8, 8});
  EXPECT_TRUE(packed.isPacked());
  EXPECT_TRUE(packed.pixelSize().isEmpty());
}

/// One frame's results, with a thing that moves over a wall.
class ResultPackerTest : public ::testing::Test {
 protected:
  std::shared_ptr<const objects::Objects> next() {
    const Box thing{4 * time_ - 10, 20, 24, 30};
    const auto picture = paint({97, 71}, [&](int x, int y) {
      const auto level = static_cast<uint8_t>(90 + (x / 5 * 7 + y / 6 * 11) % 60);
      return thing.contains({x, y}) ? Rgb{220, 40, 30} : Rgb{level, level, level};
    });
    const FrameTime now{time_++ * int64_t{40'000'000}, true};
    background::Params learning;
    learning.trainingFrames = 2;
    auto foreground = *background_->process(picture, learning, now);
    auto labels =
        *segmentation_->process(picture, std::move(foreground), {segmentation::Scope::Foreground});
    auto motion = *motion_->process(*graph_->process(std::move(labels), {}), {}, {});
    return *objects_->process(std::move(motion), {}, now);
  }

  const Context context_ = contextWith(1);
  const std::unique_ptr<background::Stage> background_ = background::makeStage(context_);
  const std::unique_ptr<segmentation::Stage> segmentation_ = segmentation::makeStage(context_);
  const std::unique_ptr<graph::Stage> graph_ = graph::makeStage(context_);
  const std::unique_ptr<motion::Stage> motion_ = motion::makeStage(context_);
  const std::unique_ptr<objects::Stage> objects_ = objects::makeStage(context_);
  objects::ResultPacker packer_;
  int time_ = 0;
};

TEST_F(ResultPackerTest, KeepsWhatReadersSee) {
  size_t seen = 0;
  for (int i = 0; i < 20; ++i) {
    const auto objects = next();
    seen += objects->objects.size();
    const auto packed = packer_.pack(objects);
    const auto& labels = objects->motion->graph->labels;
    const auto& packedLabels = packed->motion->graph->labels;
    EXPECT_EQ(digestOf(*packed), digestOf(*objects));
    EXPECT_EQ(digestOf(*packed->motion), digestOf(*objects->motion));
    EXPECT_EQ(digestOf(*packedLabels), digestOf(*labels));
    EXPECT_EQ(digestOf(*packedLabels->foreground), digestOf(*labels->foreground));
    EXPECT_EQ(packed->motion->graph->regions.size(), labels->count);
    packer_.endFrame();
  }
  EXPECT_GT(seen, 5u);
}

TEST_F(ResultPackerTest, MarksAllAsPackedAndDropsWhatOnlyStagesNeed) {
  const auto objects = next();
  const auto packed = packer_.pack(objects);
  const graph::Graph& graph = *packed->motion->graph;
  EXPECT_TRUE(objects::isPacked(*packed) && objects::isPacked(*packed->motion) &&
              objects::isPacked(graph) && objects::isPacked(*graph.labels) &&
              objects::isPacked(*graph.labels->foreground));
  EXPECT_FALSE(objects::isPacked(*objects) || objects::isPacked(*objects->motion) ||
               objects::isPacked(*objects->motion->graph));
  EXPECT_FALSE(graph.labels->picture || graph.labels->foreground->picture);
  EXPECT_TRUE(graph.runs.list.empty());
}

/// A picture of half the frame's width and all its height.
TEST(ResultPacker, TellsTheCameraOfTheWholeFrame) {
  constexpr int64_t kOne = CameraMotion::kOne;
  auto objects = std::make_shared<objects::Objects>();
  objects->size = {64, 48};
  objects->camera = {{kOne / 2, 0, kOne, kOne / 8, kOne, 3 * kOne, kOne / 1024, 0, kOne}, {32, 24}};
  objects::ResultPacker packer;
  packer.showIn({128, 48});
  const auto packed = packer.pack<objects::Objects>(objects);
  for (const Point p : {Point{0, 0}, Point{63, 11}, Point{40, 47}}) {
    // Of the two pixels that p becomes the left one lies half a pixel left of its centre.
    const Point left = packed->camera.before(2 * p.x, p.y);
    const Point right = packed->camera.before(2 * p.x + 1, p.y);
    const Point was = objects->camera.before(p.x, p.y);
    EXPECT_NEAR((left.x + right.x) / 2, 2 * was.x + 128, 4) << p.x;
    EXPECT_NEAR((left.y + right.y) / 2, was.y, 2) << p.x;
  }
}

TEST_F(ResultPackerTest, PacksOneResultOnceInAFrame) {
  const auto objects = next();
  const auto labels = packer_.pack(objects->motion->graph->labels);
  const auto packed = packer_.pack(objects);
  EXPECT_EQ(packed->motion->graph->labels, labels);
  EXPECT_EQ(packer_.pack(packed), packed) << "what is packed stays as it is";
  packer_.endFrame();
  EXPECT_NE(packer_.pack(objects), packed);
}

TEST_F(ResultPackerTest, TakesItsMemoryAgainForTheNextFrame) {
  for (int i = 0; i < 10; ++i) next();
  const void* first = packer_.pack(next()).get();
  packer_.endFrame();
  EXPECT_EQ(packer_.pack(next()).get(), first);
}

TEST_F(ResultPackerTest, IsDelayedAsWhatIsNotPacked) {
  objects::ObjectDelay plain, packed;
  for (int i = 0; i < 25; ++i) {
    const auto objects = next();
    plain.push(objects, i);
    packed.push(packer_.pack(objects), i);
    packer_.endFrame();
  }
  for (int i = 0; i < 25; ++i) EXPECT_EQ(digestOf(*packed.popAny()), digestOf(*plain.popAny()));
}

}  // namespace
}  // namespace rg
