// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/pixel.hpp"
#include "core/motion/matched_blocks.hpp"
#include "core/motion/motion.hpp"
#include "tests/core/scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <tuple>

namespace rg {
namespace {

using namespace scenes;

std::shared_ptr<const graph::Graph> graphOf(std::shared_ptr<const segmentation::Labels> labels) {
  auto graph = graph::makeStage(contextWith(1))->process(std::move(labels), {});
  EXPECT_TRUE(graph);
  return *graph;
}

std::shared_ptr<const graph::Graph> graphOf(
    const std::shared_ptr<const segmentation::Labels>& labels, segmentation::Scope scope) {
  std::const_pointer_cast<segmentation::Labels>(labels)->scope = scope;
  return graphOf(labels);
}

using LabelAt = std::function<int(int, int)>;

std::shared_ptr<const motion::Motion> match(
    std::shared_ptr<const Picture> previous, std::shared_ptr<const Picture> current, uint32_t count,
    const LabelAt& labelAt, const motion::Params& params, int threads = 1,
    segmentation::Scope scope = segmentation::Scope::Foreground) {
  const auto stage = motion::makeStage(contextWith(threads));
  const auto before = label(previous, 1, [](int, int) { return 1; });
  EXPECT_TRUE(stage->process(graphOf(before, scope), params, {}));
  auto motion = stage->process(graphOf(label(current, count, labelAt), scope), params, {});
  EXPECT_TRUE(motion);
  EXPECT_EQ((*motion)->status, Status::Ok);
  return *motion;
}

int everywhere(int, int) {
  return 1;
}

/// The same noise seen through a window that moved by (−dx, −dy): its contents move by (dx, dy).
std::shared_ptr<const Picture> movedNoise(Size size, int dx, int dy) {
  return paintGrey(size, [=](int x, int y) {
    return static_cast<int>(
        mixHash(static_cast<uint32_t>(x - dx + 1000), static_cast<uint32_t>(y - dy + 1000), 5) %
        256);
  });
}

TEST(RegionMotion, FindsEveryTranslation) {
  const Size size{72, 64};
  const motion::Params params{7, false};
  const auto previous = movedNoise(size, 0, 0);
  for (const Point d : {Point{0, 0}, Point{7, -7}, Point{-6, 3}, Point{1, 0}, Point{-7, 7}}) {
    const auto motion = match(
        previous, movedNoise(size, d.x, d.y), 1,
        [](int x, int y) { return x >= 8 && x < 64 && y >= 8 && y < 56 ? 1 : 0; }, params);
    EXPECT_EQ(motion->regions[0].dx, d.x * motion::kMotionUnit);
    EXPECT_EQ(motion->regions[0].dy, d.y * motion::kMotionUnit);
    EXPECT_EQ(motion->regions[0].sad, 0u);
  }
}

// Where nothing is asked for: by what passes the frame's 96 rows in a second, 20 to 64.
TEST(RegionMotion, SearchesAsFarAsThingsGetBetweenTwoFrames) {
  const Size size{192, 96};
  const auto graphAt = [&](int dx) {
    const auto labels = label(movedNoise(size, dx, 0), 1, [](int x, int y) {
      return x >= 72 && x < 120 && y >= 8 && y < 88 ? 1 : 0;
    });
    return graphOf(labels, segmentation::Scope::Foreground);
  };
  constexpr int64_t kMs = 1'000'000;
  motion::Params params{.isSubpixel = false};
  const auto finds = [&](int dx, FrameTime earlier, FrameTime later) {
    const auto stage = motion::makeStage(contextWith(1));
    EXPECT_TRUE(stage->process(graphAt(0), params, earlier));
    const auto motion = *stage->process(graphAt(dx), params, later);
    return motion->regions[0].dx == dx * motion::kMotionUnit;
  };
  EXPECT_TRUE(finds(20, {5 * kMs, true}, {6 * kMs, true}));
  EXPECT_FALSE(finds(21, {5 * kMs, true}, {6 * kMs, true}));
  EXPECT_TRUE(finds(48, {5 * kMs, true}, {505 * kMs, true}));
  EXPECT_FALSE(finds(49, {5 * kMs, true}, {505 * kMs, true}));
  EXPECT_TRUE(finds(64, {5 * kMs, true}, {5005 * kMs, true}));
  EXPECT_FALSE(finds(65, {INT64_MIN, true}, {INT64_MAX, true}));
  EXPECT_FALSE(finds(21, {5 * kMs, true}, {505 * kMs, false}));
  EXPECT_FALSE(finds(21, {505 * kMs, true}, {5 * kMs, true}));
  params.method = motion::Method::Literal;
  EXPECT_TRUE(finds(20, {5 * kMs, true}, {505 * kMs, true}));
  EXPECT_FALSE(finds(21, {5 * kMs, true}, {505 * kMs, true}));
}

motion::RegionMotion search(const Picture& previous, const Picture& current,
                            std::span<const motion::MatchedPart> parts, int reach) {
  const auto before = previous.luma();
  std::tuple<uint64_t, int, int, int> best{UINT64_MAX, 0, 0, 0};
  for (int dy = -reach; dy <= reach; ++dy)
    for (int dx = -reach; dx <= reach; ++dx) {
      uint64_t sad = 0;
      for (const motion::MatchedPart& part : parts)
        motion::forBlocks(part, [&](int x, int y) {
          for (int i = x; i < x + motion::kBlockWidth; ++i)
            sad += static_cast<uint64_t>(absDiff(
                current.luma().at(i, y), before.at(std::clamp(i - dx, 0, before.width() - 1),
                                                   std::clamp(y - dy, 0, before.height() - 1))));
        });
      best = std::min(best, {sad, dx * dx + dy * dy, dy, dx});
    }
  return {std::get<3>(best) * motion::kMotionUnit, std::get<2>(best) * motion::kMotionUnit,
          std::get<0>(best), 0};
}

void expectExhaustive(Size size, uint32_t count, const LabelAt& labelAt, int reach) {
  const auto previous = greyNoise(size, 21), current = greyNoise(size, 22);
  motion::MatchedBlocks blocks;
  blocks.find(*graphOf(label(current, count, labelAt)), Executor(1));
  for (const int threads : {1, 2}) {
    const auto motion = match(previous, current, count, labelAt, {reach, false}, threads);
    ASSERT_EQ(motion->regions.size(), count);
    for (size_t i = 0; i < count; ++i) {
      const auto parts = blocks.partsOf(segmentation::RegionLabel::ofIndex(i));
      const motion::RegionMotion expected =
          parts.empty() ? motion::RegionMotion{} : search(*previous, *current, parts, reach);
      EXPECT_EQ(motion->regions[i].dx, expected.dx) << "region " << i;
      EXPECT_EQ(motion->regions[i].dy, expected.dy) << "region " << i;
      EXPECT_EQ(motion->regions[i].sad, expected.sad) << "region " << i;
    }
  }
}

TEST(RegionMotion, EqualsASearchOfAllShiftsOverWholeCells) {
  expectExhaustive({45, 38}, 1, everywhere, 5);
  expectExhaustive(
      {64, 32}, 2, [](int x, int) { return 1 + (x >= 32); }, 4);
}

TEST(RegionMotion, EqualsASearchOfAllShiftsOverSlantedRegions) {
  expectExhaustive(
      {61, 43}, 5, [](int x, int y) { return (x + 2 * y) / 12 % 6; }, 4);
}

TEST(RegionMotion, EqualsASearchOfAllShiftsOverScatteredPixels) {
  expectExhaustive(
      {43, 35}, 90,
      [](int x, int y) {
        return static_cast<int>(mixHash(static_cast<uint32_t>(x), static_cast<uint32_t>(y), 1) %
                                91);
      },
      3);
}

TEST(RegionMotion, EqualsASearchOfAllShiftsOnTinyFrames) {
  expectExhaustive({1, 1}, 1, everywhere, 2);
  expectExhaustive(
      {1, 23}, 2, [](int, int y) { return 1 + y / 12; }, 3);
  expectExhaustive(
      {19, 1}, 3, [](int x, int) { return 1 + x / 7; }, 64);
}

TEST(RegionMotion, FindsFarShiftsOfLargeRegions) {
  const Size size{560, 460};
  const LabelAt halves = [](int x, int y) {
    return x < 70 || x >= 490 || y < 70 || y >= 400 ? 0 : x < 90 ? 1 : 2;
  };
  for (const int threads : {1, 2}) {
    const auto motion =
        match(movedNoise(size, 0, 0), movedNoise(size, -61, 47), 2, halves, {64, true}, threads);
    for (const motion::RegionMotion& region : motion->regions) {
      EXPECT_EQ(region.dx, -61 * motion::kMotionUnit);
      EXPECT_EQ(region.dy, 47 * motion::kMotionUnit);
      EXPECT_EQ(region.sad, 0u);
      EXPECT_GT(region.reliability, motion::kFullReliability / 2);
    }
  }
}

double wave(double x, double y) {
  return 128 + 40 * std::sin(x * 0.31 + 1) * std::cos(y * 0.27) +
         35 * std::sin(x * 0.17 - y * 0.23);
}

std::shared_ptr<const Picture> waves(Size size, double dx, double dy) {
  return paintGrey(size, [=](int x, int y) { return std::lround(wave(x - dx, y - dy)); });
}

TEST(RegionMotion, FindsFractionsOfAPixel) {
  const Size size{80, 72};
  const auto previous = waves(size, 0, 0);
  for (const double dx : {-3.25, 0.5, 2.75})
    for (const double dy : {-0.25, 1.0, 4.5}) {
      const auto motion = match(
          previous, waves(size, dx, dy), 1,
          [](int x, int y) { return x >= 10 && x < 70 && y >= 10 && y < 62 ? 1 : 0; }, {8, true});
      EXPECT_NEAR(motion->regions[0].dx, dx * motion::kMotionUnit, 1.0);
      EXPECT_NEAR(motion->regions[0].dy, dy * motion::kMotionUnit, 1.0);
    }
}

TEST(RegionMotion, AFlatRegionSaysNothing) {
  const auto flat = paintGrey({48, 40}, [](int, int) { return 90; });
  const auto motion = match(flat, flat, 1, everywhere, {});
  EXPECT_EQ(motion->regions[0].dx, 0);
  EXPECT_EQ(motion->regions[0].dy, 0);
  EXPECT_EQ(motion->regions[0].reliability, 0);
}

TEST(RegionMotion, AStraightEdgeIsNotReliableATextureIs) {
  const Size size{64, 64};
  const auto stripes = [&](int dx) {
    return paintGrey(size, [=](int x, int) { return (x - dx + 64) / 8 % 2 == 0 ? 60 : 200; });
  };
  EXPECT_LE(match(stripes(0), stripes(2), 1, everywhere, {6, true})->regions[0].reliability, 8);
  const LabelAt inside = [](int x, int y) { return x > 5 && x < 58 && y > 5 && y < 58 ? 1 : 0; };
  EXPECT_GE(match(movedNoise(size, 0, 0), movedNoise(size, 2, 1), 1, inside, {6, true})
                ->regions[0]
                .reliability,
            200);
}

TEST(RegionMotion, ARepeatedPatternIsAmbiguous) {
  const auto dots = [](int dx) {
    return paintGrey({64, 64},
                     [=](int x, int y) { return (x - dx + 64) % 5 < 2 && y % 5 < 2 ? 220 : 40; });
  };
  const LabelAt inside = [](int x, int y) { return x > 9 && x < 54 && y > 9 && y < 54 ? 1 : 0; };
  const auto motion = match(dots(0), dots(1), 1, inside, {8, true});
  EXPECT_EQ(motion->regions[0].dx, motion::kMotionUnit);
  EXPECT_EQ(motion->regions[0].reliability, 0);
}

TEST(RegionMotion, AVectorOnTheBorderOfTheSearchIsToldFromAMotionBeyond) {
  const Size size{64, 64};
  const LabelAt inside = [](int x, int y) { return x > 9 && x < 54 && y > 9 && y < 54 ? 1 : 0; };
  const auto on = match(movedNoise(size, 0, 0), movedNoise(size, 5, 0), 1, inside, {5, true});
  EXPECT_EQ(on->regions[0].dx, 5 * motion::kMotionUnit);
  EXPECT_GT(on->regions[0].reliability, motion::kFullReliability / 2);
  const auto beyond = match(movedNoise(size, 0, 0), movedNoise(size, 6, 0), 1, inside, {5, true});
  EXPECT_EQ(beyond->regions[0].reliability, 0);
}

/// Grey levels drawn by lot every 4 px, in between smooth: nowhere like elsewhere.
double texture(double x, double y) {
  const auto lot = [](double column, double row) {
    const auto a = static_cast<uint32_t>(static_cast<int>(column) + 1000);
    const auto b = static_cast<uint32_t>(static_cast<int>(row) + 1000);
    return static_cast<double>(mixHash(a, b, 9) % 200 + 28);
  };
  const double u = x / 4, v = y / 4, column = std::floor(u), row = std::floor(v);
  const auto ease = [](double t) { return t * t * (3 - 2 * t); };
  const double right = ease(u - column), below = ease(v - row);
  return (lot(column, row) * (1 - right) + lot(column + 1, row) * right) * (1 - below) +
         (lot(column, row + 1) * (1 - right) + lot(column + 1, row + 1) * right) * below;
}

std::shared_ptr<const Picture> movedTexture(Size size, double dx, double dy) {
  return paintGrey(size, [=](int x, int y) { return std::lround(texture(x - dx, y - dy)); });
}

/// 6 x 5 tiles of 24 px; what a shift brings in from outside is 20 px wide.
void expectThatTilesFollow(segmentation::Scope scope, int least) {
  const Size size{144, 120};
  const LabelAt tiles = [](int x, int y) { return 1 + x / 24 + y / 24 * 6; };
  const auto previous = movedTexture(size, 0, 0);
  for (const double dx : {-20.0, 3.0, 20.0, 7.25, -13.5})
    for (const double dy : {20.0, 0.0, -11.0, -2.75}) {
      const auto motion =
          match(previous, movedTexture(size, dx, dy), 30, tiles, {20, true}, 1, scope);
      const bool isWhole = std::floor(dx) == dx && std::floor(dy) == dy;
      int reliable = 0;
      for (const motion::RegionMotion& region : motion->regions) {
        if (region.reliability == 0) continue;
        ++reliable;
        EXPECT_NEAR(region.dx, dx * motion::kMotionUnit, isWhole ? 0 : 0.15 * motion::kMotionUnit);
        EXPECT_NEAR(region.dy, dy * motion::kMotionUnit, isWhole ? 0 : 0.15 * motion::kMotionUnit);
      }
      EXPECT_GE(reliable, least) << dx << ' ' << dy;
    }
}

TEST(RegionMotion, EveryTileOfATextureMovesAsThePictureDoes) {
  expectThatTilesFollow(segmentation::Scope::Foreground, 5 * 4);
}

TEST(RegionMotion, SoItDoesWhereTheCameraIsLookedFor) {
  expectThatTilesFollow(segmentation::Scope::Frame, 5 * 3);
}

TEST(RegionMotion, ACameraMayMoveFurtherThanTheSearchReaches) {
  const Size size{160, 120};
  const LabelAt inside = [](int x, int y) { return x > 49 && x < 130 && y > 9 && y < 90 ? 1 : 0; };
  const auto motion = match(movedTexture(size, 0, 0), movedTexture(size, 31, -22), 1, inside,
                            {8, true}, 1, segmentation::Scope::Frame);
  EXPECT_EQ(motion->regions[0].dx, 31 * motion::kMotionUnit);
  EXPECT_EQ(motion->regions[0].dy, -22 * motion::kMotionUnit);
  EXPECT_GT(motion->regions[0].reliability, motion::kFullReliability / 2);
  EXPECT_EQ(motion->camera.at(80, 60),
            (Point{31 * motion::kMotionUnit, -22 * motion::kMotionUnit}));
}

/// Left half textured, right half flat but for its noise; both move alike.
std::shared_ptr<const Picture> halfTexture(int dx, unsigned seed) {
  return paintGrey({96, 64}, [=](int x, int y) {
    const auto bits = mixHash(static_cast<uint32_t>(x), static_cast<uint32_t>(y), seed);
    return x - dx < 48 ? std::lround(texture(x - dx, y)) : 128 + static_cast<int>(bits % 3);
  });
}

TEST(RegionMotion, AFlatRegionMovesWithItsNeighbourButSaysThatItSawNothing) {
  const auto motion = match(halfTexture(0, 1), halfTexture(4, 2), 2,
                            [](int x, int) { return x < 52 ? 1 : 2; }, {8, true});
  EXPECT_EQ(motion->regions[0].dx, 4 * motion::kMotionUnit);
  EXPECT_NEAR(motion->regions[1].dx, 4 * motion::kMotionUnit, 2);
  EXPECT_NEAR(motion->regions[1].dy, 0, 2);
  EXPECT_LE(motion->regions[1].reliability, 8);
}

TEST(RegionMotion, AChangeOfBrightnessIsNoMotion) {
  const Size size{80, 72};
  const auto previous = movedTexture(size, 0, 0);
  const auto brighter =
      paintGrey(size, [](int x, int y) { return std::lround(texture(x - 2.25, y + 1.5)) + 6; });
  const auto motion =
      match(previous, brighter, 1,
            [](int x, int y) { return x >= 10 && x < 70 && y >= 10 && y < 62 ? 1 : 0; }, {8, true});
  EXPECT_NEAR(motion->regions[0].dx, 2.25 * motion::kMotionUnit, 1.0);
  EXPECT_NEAR(motion->regions[0].dy, -1.5 * motion::kMotionUnit, 1.0);
}

TEST(RegionMotion, FractionsAreTheSameForAnyNumberOfThreads) {
  const Size size{133, 91};
  const LabelAt tiles = [](int x, int y) { return 1 + x / 19 + y / 13 * 7; };
  const auto previous = greyNoise(size, 4), current = greyNoise(size, 5);
  const auto one = match(previous, current, 49, tiles, {6, true}, 1);
  for (const int threads : {2, 3, 4}) {
    const auto more = match(previous, current, 49, tiles, {6, true}, threads);
    for (size_t i = 0; i < one->regions.size(); ++i) {
      EXPECT_EQ(one->regions[i].dx, more->regions[i].dx);
      EXPECT_EQ(one->regions[i].dy, more->regions[i].dy);
      EXPECT_EQ(one->regions[i].reliability, more->regions[i].reliability);
    }
  }
}

// What a stage keeps from frame to frame is of the previous one, whatever was searched there.
TEST(RegionMotion, DoesNotDependOnFramesBeforeThePreviousOne) {
  const Size size{96, 80};
  const LabelAt tiles = [](int x, int y) { return 1 + x / 24 + y / 20 * 4; };
  const auto graphAt = [&](double d) {
    return graphOf(label(movedTexture(size, d, -d / 2), 16, tiles));
  };
  const auto first = graphAt(0), second = graphAt(1.5), third = graphAt(4.25);
  const auto stage = motion::makeStage(contextWith(2));
  for (const auto& graph : {first, second}) ASSERT_TRUE(stage->process(graph, {8, true}, {}));
  for (const int reach : {8, 13}) {
    const auto fresh = motion::makeStage(contextWith(2));
    ASSERT_TRUE(fresh->process(second, {}, {}));
    const auto expected = *fresh->process(third, {reach, true}, {});
    const auto found = *stage->process(third, {reach, true}, {});
    for (size_t i = 0; i < expected->regions.size(); ++i) {
      EXPECT_EQ(found->regions[i].dx, expected->regions[i].dx);
      EXPECT_EQ(found->regions[i].dy, expected->regions[i].dy);
      EXPECT_EQ(found->regions[i].reliability, expected->regions[i].reliability);
    }
    ASSERT_TRUE(stage->process(second, {8, true}, {}));
  }
}

TEST(RegionMotion, WithoutAPreviousFrameAllVectorsAreZero) {
  const auto graph =
      graphOf(label(greyNoise({20, 20}, 1), 2, [](int x, int) { return 1 + x / 10; }));
  const auto stage = motion::makeStage(contextWith(1));
  for (const Reset reset : {Reset::Stream, Reset::Flush, Reset::Gap}) {
    const auto first = stage->process(graph, {}, {});
    ASSERT_TRUE(first);
    EXPECT_EQ((*first)->status, Status::Skipped);
    ASSERT_EQ((*first)->regions.size(), 2u);
    EXPECT_EQ((*first)->regions[1].reliability, 0);
    EXPECT_EQ((*stage->process(graph, {}, {}))->status, Status::Ok);
    stage->reset(reset);
  }
}

TEST(RegionMotion, ASkippedFrameKeepsThePreviousOne) {
  const auto graph = graphOf(label(greyNoise({20, 20}, 1), 1, everywhere));
  const auto stage = motion::makeStage(contextWith(1));
  ASSERT_TRUE(stage->process(graph, {}, {}));
  const auto skipped = stage->process(std::make_shared<graph::Graph>(), {}, {});
  ASSERT_TRUE(skipped);
  EXPECT_EQ((*skipped)->status, Status::Skipped);
  EXPECT_TRUE((*skipped)->regions.empty());
  EXPECT_EQ((*stage->process(graph, {}, {}))->status, Status::Ok);
}

}  // namespace
}  // namespace rg
