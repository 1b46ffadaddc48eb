// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/pixel.hpp"
#include "core/motion/literal_search.hpp"
#include "tests/core/scenes.hpp"

#include <gtest/gtest.h>

#include <tuple>

namespace rg {
namespace {

using namespace scenes;
using LabelAt = std::function<int(int, int)>;

std::shared_ptr<const graph::Graph> graphOf(std::shared_ptr<const segmentation::Labels> labels) {
  auto graph = graph::makeStage(contextWith(1))->process(std::move(labels), {});
  EXPECT_TRUE(graph);
  return *graph;
}

std::shared_ptr<const motion::Motion> match(std::shared_ptr<const Picture> previous,
                                            std::shared_ptr<const Picture> current, uint32_t count,
                                            const LabelAt& labelAt, int reach, int threads = 1) {
  const auto stage = motion::makeStage(contextWith(threads));
  const motion::Params params{reach, true, motion::Method::Literal};
  EXPECT_TRUE(stage->process(graphOf(label(previous, 1, [](int, int) { return 1; })), params, {}));
  auto motion = stage->process(graphOf(label(current, count, labelAt)), params, {});
  EXPECT_TRUE(motion);
  return *motion;
}

/// The sums of the definition, pixel by pixel.
motion::RegionMotion search(const Picture& previous, const Picture& current, int number,
                            const LabelAt& labelAt, int reach) {
  const auto before = previous.luma(), now = current.luma();
  std::tuple<uint64_t, int, int, int> best{UINT64_MAX, 0, 0, 0};
  for (int dy = -reach; dy <= reach; ++dy)
    for (int dx = -reach; dx <= reach; ++dx) {
      uint64_t sad = 0;
      for (int y = 0; y < now.height(); ++y)
        for (int x = 0; x < now.width(); ++x)
          if (labelAt(x, y) == number)
            sad += static_cast<uint64_t>(
                absDiff(now.at(x, y), before.at(std::clamp(x - dx, 0, before.width() - 1),
                                                std::clamp(y - dy, 0, before.height() - 1))));
      best = std::min(best, {sad, dx * dx + dy * dy, dy, dx});
    }
  return {std::get<3>(best) * motion::kMotionUnit, std::get<2>(best) * motion::kMotionUnit,
          std::get<0>(best), 0};
}

void expectExhaustive(Size size, uint32_t count, const LabelAt& labelAt, int reach) {
  const auto previous = greyNoise(size, 21), current = greyNoise(size, 22);
  for (const int threads : {1, 2}) {
    const auto motion = match(previous, current, count, labelAt, reach, threads);
    ASSERT_EQ(motion->regions.size(), count);
    for (size_t i = 0; i < count; ++i) {
      const auto expected = search(*previous, *current, static_cast<int>(i) + 1, labelAt, reach);
      EXPECT_EQ(motion->regions[i].dx, expected.dx) << "region " << i;
      EXPECT_EQ(motion->regions[i].dy, expected.dy) << "region " << i;
      EXPECT_EQ(motion->regions[i].sad, expected.sad) << "region " << i;
    }
  }
}

TEST(LiteralSearch, EqualsTheSumsOfAllPixelsOfEachRegion) {
  expectExhaustive(
      {45, 38}, 1, [](int, int) { return 1; }, 5);
  expectExhaustive(
      {61, 43}, 5, [](int x, int y) { return (x + 2 * y) / 12 % 6; }, 4);
}

TEST(LiteralSearch, EqualsTheSumsOfScatteredPixels) {
  expectExhaustive(
      {33, 25}, 30,
      [](int x, int y) {
        return static_cast<int>(mixHash(static_cast<uint32_t>(x), static_cast<uint32_t>(y), 1) %
                                31);
      },
      3);
}

TEST(LiteralSearch, EqualsTheSumsOnTinyFrames) {
  expectExhaustive(
      {1, 1}, 1, [](int, int) { return 1; }, 2);
  expectExhaustive(
      {1, 23}, 2, [](int, int y) { return 1 + y / 12; }, 3);
  expectExhaustive(
      {19, 1}, 3, [](int x, int) { return 1 + x / 7; }, 64);
}

/// The same noise seen through a window that moved by (−dx, −dy): its contents move by (dx, dy).
std::shared_ptr<const Picture> movedNoise(Size size, int dx, int dy) {
  return paintGrey(size, [=](int x, int y) {
    return static_cast<int>(
        mixHash(static_cast<uint32_t>(x - dx + 1000), static_cast<uint32_t>(y - dy + 1000), 5) %
        256);
  });
}

TEST(LiteralSearch, ReliesOnAVectorThatIsClear) {
  const LabelAt inside = [](int x, int y) { return x >= 8 && x < 64 && y >= 8 && y < 56 ? 1 : 0; };
  for (const Point d : {Point{7, -7}, Point{-6, 3}, Point{}}) {
    const auto motion =
        match(movedNoise({72, 64}, 0, 0), movedNoise({72, 64}, d.x, d.y), 1, inside, 7);
    EXPECT_EQ(motion->regions[0].dx, d.x * motion::kMotionUnit);
    EXPECT_EQ(motion->regions[0].dy, d.y * motion::kMotionUnit);
    EXPECT_EQ(motion->regions[0].sad, 0u);
    EXPECT_GT(motion->regions[0].reliability, motion::kFullReliability / 2);
  }
}

TEST(LiteralSearch, FlatRegionsSayNothingWhateverTheirNeighboursSay) {
  const auto picture = [](int shift) {
    return paintGrey({96, 64}, [=](int x, int y) {
      if (x >= 48) return 120;
      return static_cast<int>(
          mixHash(static_cast<uint32_t>(x - shift + 99), static_cast<uint32_t>(y), 7) % 256);
    });
  };
  const auto motion = match(
      picture(0), picture(4), 2, [](int x, int) { return 1 + (x >= 48); }, 8);
  EXPECT_EQ(motion->regions[0].dx, 4 * motion::kMotionUnit);
  EXPECT_EQ(motion->regions[1].reliability, 0);
  EXPECT_EQ(motion->regions[1].dx, 0);
}

TEST(LiteralSearch, SumsOfTheLargestRegionsDoNotOverflow) {
  const Size size{5000, 3600};  // 18 million pixels of 255 levels: more than 2^32.
  const auto black = paintGrey(size, [](int, int) { return 0; });
  const auto white = paintGrey(size, [](int, int) { return 255; });
  const auto motion = match(
      black, white, 1, [](int, int) { return 1; }, 1, 2);
  EXPECT_EQ(motion->regions[0].sad, uint64_t{255} * 5000 * 3600);
  EXPECT_EQ(motion->regions[0].dx, 0);
  EXPECT_EQ(motion->regions[0].reliability, 0);
}

}  // namespace
}  // namespace rg
