// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/pixel.hpp"
#include "core/motion/matched_blocks.hpp"
#include "tests/core/scenes.hpp"
#include "tests/core/simd_targets.hpp"

#include <map>
#include <set>
#include <tuple>

namespace rg {
namespace {

using namespace scenes;

/// Numbers are labels in the order of their first pixels; 0 stays without one.
std::shared_ptr<const graph::Graph> graphOf(Size size,
                                            const std::function<int(int, int)>& numberAt) {
  std::map<int, int> labelOf{{0, 0}};
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      labelOf.insert({numberAt(x, y), static_cast<int>(labelOf.size())});
  const auto labels = label(greyNoise(size, 3), static_cast<uint32_t>(labelOf.size() - 1),
                            [&](int x, int y) { return labelOf.at(numberAt(x, y)); });
  return *graph::makeStage(contextWith(1))->process(labels, {});
}

/// (label, x, y) of each matched block.
using Blocks = std::set<std::tuple<int, int, int>>;

Blocks found(const motion::MatchedBlocks& matched) {
  Blocks blocks;
  std::tuple<int, int, int> last{-1, 0, 0};
  for (const motion::MatchedPart& part : matched.parts()) {
    const std::tuple place{int{part.label.number()}, int{part.strip}, int{part.column}};
    EXPECT_LT(last, place);
    last = place;
    EXPECT_NE(part.blocks, 0u);
    motion::forBlocks(part, [&](int x, int y) { blocks.insert({part.label.number(), x, y}); });
  }
  return blocks;
}

/// The same, block by block from what the header says.
Blocks expected(const graph::Graph& graph) {
  const ImageView<const uint16_t> ids = graph.labels->ids;
  const Box frame = boundsOf(graph.size);
  Blocks inner, halves;
  for (int y = 0; y < graph.size.height; ++y)
    for (int x = 0; x + motion::kBlockWidth <= graph.size.width; x += motion::kBlockWidth) {
      std::map<int, int> counts;
      bool isInner = true;
      for (int i = 0; i < motion::kBlockWidth; ++i) {
        ++counts[ids.at(x + i, y)];
        for (int d = -motion::kBorderReach; d <= motion::kBorderReach; ++d)
          for (const Point p : {Point{x + i + d, y}, Point{x + i, y + d}})
            isInner = isInner && (!frame.contains(p) || ids.at(p.x, p.y) == ids.at(x, y));
      }
      if (isInner && ids.at(x, y) != segmentation::kNoRegion) inner.insert({ids.at(x, y), x, y});
      for (const auto& [id, pixels] : counts)
        if (id != segmentation::kNoRegion && 2 * pixels >= motion::kBlockWidth)
          halves.insert({id, x, y});
    }
  Blocks blocks;
  for (int id = 1; id <= static_cast<int>(graph.regions.size()); ++id) {
    const auto isOf = [&](const auto& block) { return std::get<0>(block) == id; };
    const auto pixels = motion::kBlockWidth *
                        static_cast<uint32_t>(std::count_if(inner.begin(), inner.end(), isOf));
    const bool isThin =
        pixels < motion::kLeastInnerPx ||
        pixels < graph.regions[static_cast<size_t>(id) - 1].areaPx / motion::kInnerShare;
    for (const auto& block : isThin ? halves : inner)
      if (isOf(block)) blocks.insert(block);
  }
  return blocks;
}

TEST(MatchedBlocks, AreTheInnerOnesAndThoseOfThinRegions) {
  const auto ragged = [](int cell) {
    return [cell](int x, int y) {
      const int bend = static_cast<int>(mixHash(static_cast<uint32_t>(y), 0, 5) % 3);
      return (y / cell * 40 + (x + bend) / cell) % 199;
    };
  };
  for (const Size size : {Size{3, 40}, Size{64, 33}, Size{203, 71}})
    for (const int cell : {3, 12, 29}) {
      const auto graph = graphOf(size, ragged(cell));
      const Blocks right = expected(*graph);
      test::forEachTargetAndThreads([&](const std::shared_ptr<const Executor>& executor) {
        motion::MatchedBlocks matched;
        matched.find(*graph, *executor);
        EXPECT_EQ(found(matched), right) << size.width << 'x' << size.height << ", " << cell;
      });
    }
}

TEST(MatchedBlocks, OfVeryManyRegionsTheLargestAreMatched) {
  constexpr Size kFrame{512, 128};
  constexpr int kAcross = kFrame.width / 4, kLarge = 10;
  const auto graph = graphOf(kFrame, [](int x, int y) {
    return y < 2 && x < 8 * kLarge ? 1 + x / 8 : 1000 + y * kAcross + x / 4;
  });
  const auto count = static_cast<uint32_t>(graph->regions.size());
  motion::MatchedBlocks matched;
  matched.find(*graph, Executor(1));
  std::set<int> labels;
  for (const auto& block : found(matched)) labels.insert(std::get<0>(block));
  EXPECT_EQ(labels.size(), motion::mostMatched(kFrame));
  EXPECT_LT(motion::mostMatched(kFrame), count / 8);
  for (int i = 1; i <= kLarge; ++i) EXPECT_TRUE(labels.count(i)) << i;
  EXPECT_TRUE(labels.count(static_cast<int>(motion::mostMatched(kFrame))));
  EXPECT_FALSE(labels.count(static_cast<int>(count)));
  EXPECT_TRUE(
      matched.partsOf(segmentation::RegionLabel::ofNumber(static_cast<uint16_t>(count))).empty());
}

}  // namespace
}  // namespace rg
