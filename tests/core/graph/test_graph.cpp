// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/graph/graph.hpp"
#include "tests/core/scenes.hpp"

#include <gtest/gtest.h>

#include <map>

namespace rg {
namespace {

using namespace scenes;

std::shared_ptr<const graph::Graph> build(std::shared_ptr<const segmentation::Labels> labels,
                                          Connectivity connectivity = Connectivity::Four,
                                          int threads = 1) {
  auto result = graph::makeStage(contextWith(threads))->process(std::move(labels), {connectivity});
  EXPECT_TRUE(result);
  return *result;
}

// 1 1 2
// 1 3 2
std::shared_ptr<const segmentation::Labels> threeRegions() {
  static constexpr int kMap[2][3] = {{1, 1, 2}, {1, 3, 2}};
  const auto picture = paint({3, 2}, [](int x, int y) {
    constexpr Rgb kColours[] = {{}, {10, 20, 30}, {50, 20, 30}, {10, 20, 90}};
    return kColours[kMap[y][x]];
  });
  return label(picture, 3, [](int x, int y) { return kMap[y][x]; });
}

TEST(RegionGraph, DescribesEachRegion) {
  const auto graph = build(threeRegions());
  ASSERT_EQ(graph->regions.size(), 3u);
  const graph::Region& first = graph->regions[0];
  EXPECT_EQ(first.areaPx, 3u);
  EXPECT_EQ(first.box, (Box{0, 0, 2, 2}));
  EXPECT_EQ(first.centroidX, 85);  // 1/3 px.
  EXPECT_EQ(first.centroidY, 85);
  EXPECT_EQ(first.colour, (graph::Colour{10, 20, 30}));
  EXPECT_EQ(graph->regions[2].box, (Box{1, 1, 1, 1}));
  EXPECT_EQ(graph->regions[2].centroidX, 256);
}

TEST(RegionGraph, ArcsAreSortedWithLengthAndContrast) {
  const auto arcs = build(threeRegions())->arcs;
  ASSERT_EQ(arcs.size(), 3u);
  EXPECT_EQ(arcs[0].a.number(), 1);
  EXPECT_EQ(arcs[0].b.number(), 2);
  EXPECT_EQ(arcs[0].borderPx, 1u);
  EXPECT_EQ(arcs[0].contrast, 40u);
  EXPECT_EQ(arcs[1].b.number(), 3);
  EXPECT_EQ(arcs[1].borderPx, 2u);
  EXPECT_EQ(arcs[1].contrast, 120u);
  EXPECT_EQ(arcs[2].a.number(), 2);
  EXPECT_EQ(arcs[2].borderPx, 1u);
}

TEST(RegionGraph, EightNeighboursCountTheDiagonals) {
  const auto arcs = build(threeRegions(), Connectivity::Eight)->arcs;
  ASSERT_EQ(arcs.size(), 3u);
  EXPECT_EQ(arcs[0].borderPx, 2u);
  EXPECT_EQ(arcs[1].borderPx, 3u);
  EXPECT_EQ(arcs[2].borderPx, 2u);
}

TEST(RegionGraph, RunsHoldThePixelsOfEachRegion) {
  const auto graph = build(threeRegions());
  const auto runsOf = [&](size_t region) {
    const auto runs = graph->runs.of(region);
    return std::vector(runs.begin(), runs.end());
  };
  EXPECT_EQ(runsOf(0), (std::vector<rg::Run>{{0, 0, 2}, {1, 0, 1}}));
  EXPECT_EQ(runsOf(1), (std::vector<rg::Run>{{0, 2, 3}, {1, 2, 3}}));
  EXPECT_EQ(runsOf(2), (std::vector<rg::Run>{{1, 1, 2}}));
}

TEST(RegionGraph, LabelZeroHasNeitherNodeNorArc) {
  const auto graph = build(label(colourNoise({9, 1}, 1), 2, [](int x, int) {
    return x < 3 ? 1 : x < 5 ? 0 : 2;
  }));
  EXPECT_EQ(graph->regions.size(), 2u);
  EXPECT_TRUE(graph->arcs.empty());
}

/// Every pair of neighbours by itself.
std::map<std::pair<int, int>, std::pair<uint32_t, uint32_t>> countPairs(
    const segmentation::Labels& labels, Connectivity connectivity) {
  std::map<std::pair<int, int>, std::pair<uint32_t, uint32_t>> pairs;
  std::vector<Point> steps{{1, 0}, {0, 1}};
  if (connectivity == Connectivity::Eight) steps.insert(steps.end(), {{1, 1}, {-1, 1}});
  const Picture& picture = *labels.picture;
  for (int y = 0; y < labels.size.height; ++y)
    for (int x = 0; x < labels.size.width; ++x)
      for (const Point step : steps) {
        const Point q{x + step.x, y + step.y};
        if (!boundsOf(labels.size).contains(q)) continue;
        const int a = labels.ids.at(x, y), b = labels.ids.at(q.x, q.y);
        if (a == b || a == 0 || b == 0) continue;
        int contrast = 0;
        for (const auto& plane : {picture.red(), picture.green(), picture.blue()})
          contrast = std::max(contrast, std::abs(plane.at(x, y) - plane.at(q.x, q.y)));
        auto& sums = pairs[std::minmax(a, b)];
        ++sums.first;
        sums.second += static_cast<uint32_t>(contrast);
      }
  return pairs;
}

void expectPairs(const std::vector<graph::Arc>& arcs, const segmentation::Labels& labels,
                 Connectivity connectivity) {
  const auto pairs = countPairs(labels, connectivity);
  ASSERT_EQ(arcs.size(), pairs.size());
  auto expected = pairs.begin();
  for (const graph::Arc& arc : arcs) {
    EXPECT_EQ(arc.a.number(), expected->first.first);
    EXPECT_EQ(arc.b.number(), expected->first.second);
    EXPECT_EQ(arc.borderPx, expected->second.first);
    EXPECT_EQ(arc.contrast, expected->second.second);
    ++expected;
  }
}

std::shared_ptr<const segmentation::Labels> randomLabels(Size size, unsigned labelCount,
                                                         int blockPx) {
  std::mt19937 random(labelCount);
  std::vector<int> blocks(static_cast<size_t>(size.area()));
  for (int& block : blocks) block = static_cast<int>(random() % (labelCount + 1));
  return label(colourNoise(size, 7), labelCount, [&](int x, int y) {
    if (y == 0 && x < static_cast<int>(labelCount)) return x + 1;  // Every label occurs.
    return blocks[static_cast<size_t>(y / blockPx * size.width + x / blockPx)];
  });
}

TEST(RegionGraph, EqualsACountOfAllPairs) {
  for (const Connectivity connectivity : {Connectivity::Four, Connectivity::Eight})
    for (const unsigned labelCount : {1u, 2u, 40u, 120u}) {
      const auto labels = randomLabels({121, 67}, labelCount, labelCount == 40 ? 9 : 1);
      expectPairs(build(labels, connectivity, 2)->arcs, *labels, connectivity);
    }
}

TEST(RegionGraph, ThreadsChangeNothing) {
  const auto labels = randomLabels({199, 151}, 180, 5);
  const auto one = build(labels, Connectivity::Eight, 1);
  const auto two = build(labels, Connectivity::Eight, 2);
  ASSERT_EQ(one->regions.size(), two->regions.size());
  for (size_t i = 0; i < one->regions.size(); ++i) {
    const graph::Region &a = one->regions[i], &b = two->regions[i];
    EXPECT_EQ(a.areaPx, b.areaPx);
    EXPECT_EQ(a.box, b.box);
    EXPECT_EQ(a.centroidX, b.centroidX);
    EXPECT_EQ(a.centroidY, b.centroidY);
    EXPECT_EQ(a.colour, b.colour);
  }
  expectPairs(two->arcs, *labels, Connectivity::Eight);
  EXPECT_EQ(one->runs.starts, two->runs.starts);
  EXPECT_EQ(one->runs.list, two->runs.list);
  Image<uint16_t> painted(labels->size);
  painted.fill(segmentation::kNoRegion);
  for (size_t i = 0; i < two->regions.size(); ++i)
    for (const rg::Run& run : two->runs.of(i))
      std::fill(painted.row(run.y) + run.begin, painted.row(run.y) + run.end,
                static_cast<uint16_t>(i + 1));
  for (int y = 0; y < labels->size.height; ++y)
    for (int x = 0; x < labels->size.width; ++x)
      ASSERT_EQ(painted.at(x, y), labels->ids.at(x, y)) << x << ", " << y;
}

TEST(RegionGraph, SkippedGivesSkipped) {
  const auto graph = build(std::make_shared<segmentation::Labels>());
  EXPECT_EQ(graph->status, Status::Skipped);
  EXPECT_TRUE(graph->regions.empty());
}

}  // namespace
}  // namespace rg
