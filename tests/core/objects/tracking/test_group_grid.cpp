// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/tracking/group_grid.hpp"
#include "tests/core/scenes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace rg {
namespace {

using testing::ElementsAre;

TEST(GroupGrid, CellsSampleTheGroupsThatAreNoBackground) {
  auto labels = std::make_shared<segmentation::Labels>();
  labels->size = {640, 480};
  labels->ids.resize(labels->size);
  labels->ids.fill(1);
  for (int y = 100; y < 200; ++y)
    for (int x = 100; x < 150; ++x) labels->ids.at(x, y) = 2;
  labels->count = 2;
  const auto picture = scenes::paintGrey(labels->size, [](int, int) { return 9; });
  labels->picture = picture;
  labels->status = Status::Ok;
  const auto graph = *graph::makeStage(scenes::contextWith(1))->process(labels, {});
  objects::GroupGrid e;
  objects::gather(*graph,
                  std::vector{objects::GroupIndex::ofIndex(0), objects::GroupIndex::ofIndex(1)},
                  std::vector<uint8_t>{1, 0},
                  std::vector{objects::TrackIndex(), objects::TrackIndex::ofIndex(6)}, e);
  EXPECT_EQ(e.stepPx, 2);
  EXPECT_EQ(e.grid, (Size{320, 240}));
  EXPECT_EQ(e.group[e.at(60, 60)], 2);
  EXPECT_EQ(e.group[e.at(10, 10)], 0);
  EXPECT_EQ(e.expected[e.at(60, 60)], 7);
  EXPECT_EQ(e.runs.size(), 50u);
  EXPECT_EQ(e.runs.front(), (rg::Run{50, 50, 75}));
}

}  // namespace
}  // namespace rg
