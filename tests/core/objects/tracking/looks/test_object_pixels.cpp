// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/base/pixel.hpp"
#include "core/graph/graph.hpp"
#include "core/objects/tracking/looks/object_pixels.hpp"
#include "tests/core/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace rg {
namespace {

using namespace scenes;

constexpr uint32_t kRegions = 5, kTracks = 3;

std::shared_ptr<const graph::Graph> graphOfNoise(Size size, uint32_t seed) {
  auto labels = std::make_shared<segmentation::Labels>();
  labels->size = size;
  labels->ids.resize(size);
  for (int y = 0; y < size.height; ++y)
    for (int x = 0; x < size.width; ++x)
      labels->ids.at(x, y) = static_cast<uint16_t>(
          mixHash(static_cast<uint32_t>(x / 3), static_cast<uint32_t>(y), seed) % (kRegions + 1));
  labels->count = kRegions;
  labels->status = Status::Ok;
  labels->picture = paint(size, [](int x, int y) {
    return Rgb{static_cast<uint8_t>(x), static_cast<uint8_t>(y), static_cast<uint8_t>(x + y)};
  });
  return *graph::makeStage(contextWith(1))->process(labels, {});
}

struct Found {
  Image<uint16_t> slots;
  std::vector<objects::ObjectSums> sums;
};

/// Pixel by pixel.
Found plainPixels(const graph::Graph& graph, const std::vector<uint8_t>& isBackground,
                  const objects::OwnedCells& cells) {
  Found found;
  found.slots.resize(graph.size);
  found.slots.fill(0);
  found.sums.assign(kTracks, {});
  const Picture& picture = *graph.labels->picture;
  for (int y = 0; y < graph.size.height; ++y)
    for (int x = 0; x < graph.size.width; ++x) {
      const uint16_t label = graph.labels->ids.at(x, y);
      const int step = cells.grid.stepPx;
      const uint16_t owner = cells.owner[cells.grid.at(x / step, y / step)];
      if (label == 0 || isBackground[label - 1u] != 0 || owner == 0) continue;
      found.slots.at(x, y) = owner;
      objects::ObjectSums& sum = found.sums[owner - 1u];
      if (sum.count++ == 0) sum.first = {x, y};
      sum.x += static_cast<uint64_t>(x);
      sum.y += static_cast<uint64_t>(y);
      sum.red += picture.red().at(x, y);
      sum.green += picture.green().at(x, y);
      sum.blue += picture.blue().at(x, y);
    }
  return found;
}

TEST(ObjectPixels, AreThoseOfTheForegroundInTheCellsOfAnObject) {
  for (const Size size : {Size{37, 9}, Size{9, 23}, Size{61, 47}, Size{640, 401}}) {
    const auto graph = graphOfNoise(size, 7);
    std::vector<objects::GroupIndex> groupOf;
    for (const size_t group : {0u, 0u, 1u, 2u, 3u})
      groupOf.push_back(objects::GroupIndex::ofIndex(group));
    const std::vector<objects::TrackIndex> expectedOf(kRegions);
    const std::vector<uint8_t> isBackgroundGroup{0, 1, 0, 0}, isBackground{0, 0, 1, 0, 0};
    objects::GroupGrid grid;
    objects::gather(*graph, groupOf, isBackgroundGroup, expectedOf, grid);
    std::vector<uint16_t> owner(grid.group.size(), 0);
    for (uint32_t i = 0; i < owner.size(); ++i)
      if (grid.group[i] != 0)
        owner[i] = static_cast<uint16_t>(mixHash(i / 4, 3, 3) % (kTracks + 1));
    const objects::OwnedCells cells{grid, owner};
    Found found;
    found.sums.resize(kTracks);
    objects::ObjectPixelScratch scratch;
    objects::findObjectPixels(*graph, isBackground, cells, scratch, {found.slots, found.sums});
    const Found plain = plainPixels(*graph, isBackground, cells);
    for (int y = 0; y < size.height; ++y)
      for (int x = 0; x < size.width; ++x)
        ASSERT_EQ(found.slots.at(x, y), plain.slots.at(x, y)) << x << ' ' << y;
    EXPECT_EQ(found.sums, plain.sums) << size.width << 'x' << size.height;
  }
}

TEST(ObjectPixels, ARunEndsWhereTheValueDoes) {
  for (int length = 1; length < 20; ++length)
    for (int same = 1; same <= length; ++same) {
      std::vector<uint16_t> row(static_cast<size_t>(length) + 4, 7);
      std::fill(row.begin() + 2, row.begin() + 2 + same, uint16_t{0x8001});
      EXPECT_EQ(graph::endOfRun(row.data(), 2, 2 + length), 2 + same) << length;
    }
}

}  // namespace
}  // namespace rg
