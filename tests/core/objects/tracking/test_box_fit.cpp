// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/tracking/box_fit.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace rg {
namespace {

/// A grid of cells with foreground in the given boxes, all of one colour bin and group.
objects::GroupGrid gridWith(Size grid, const std::vector<Box>& foreground, uint8_t bin = 0) {
  objects::GroupGrid e;
  e.frame = e.grid = grid;
  e.group.assign(static_cast<size_t>(grid.area()), 0);
  e.bin.assign(e.group.size(), bin);
  e.expected.assign(e.group.size(), 0);
  for (const Box& box : foreground)
    for (int y = box.y; y < box.bottom(); ++y)
      for (int x = box.x; x < box.right(); ++x) e.group[e.at(x, y)] = 1;
  return e;
}

objects::FitTask taskAt(const Box& box, int tier = 0) {
  objects::FitTask task;
  task.expected = box;
  task.reachX = 6;
  task.reachY = 4;
  task.tier = tier;
  return task;
}

std::vector<objects::FitTask> fit(const objects::GroupGrid& e,
                                  std::vector<objects::FitTask> tasks) {
  objects::FitScratch scratch;
  objects::fitBoxes(e, tasks, scratch);
  return tasks;
}

TEST(BoxFit, ABoxMovesOntoTheForeground) {
  const objects::GroupGrid e = gridWith({60, 60}, {{22, 20, 8, 20}});
  EXPECT_EQ(fit(e, {taskAt({18, 18, 8, 20})})[0].fitted, (Box{22, 20, 8, 20}));
}

TEST(BoxFit, NothingToSeeLeavesItWhereItWasExpected) {
  const objects::GroupGrid e = gridWith({60, 60}, {});
  EXPECT_EQ(fit(e, {taskAt({18, 18, 8, 20})})[0].fitted, (Box{18, 18, 8, 20}));
}

TEST(BoxFit, TwoBoxesShareAWideBlob) {
  const objects::GroupGrid e = gridWith({60, 60}, {{20, 20, 16, 20}});
  const auto tasks = fit(e, {taskAt({22, 20, 8, 20}), taskAt({26, 20, 8, 20})});
  EXPECT_EQ(tasks[0].fitted, (Box{20, 20, 8, 20}));
  EXPECT_EQ(tasks[1].fitted, (Box{28, 20, 8, 20}));
}

TEST(BoxFit, AHigherTierTakesWhatIsLeft) {
  const objects::GroupGrid e = gridWith({60, 60}, {{20, 20, 8, 20}});
  const auto tasks = fit(e, {taskAt({20, 20, 8, 20}, 0), taskAt({21, 20, 8, 20}, 2)});
  EXPECT_EQ(tasks[0].fitted, (Box{20, 20, 8, 20}));
  std::vector<uint16_t> owner;
  objects::assignCells(e, tasks, owner);
  EXPECT_EQ(std::count(owner.begin(), owner.end(), 1), 160);
  EXPECT_EQ(std::count(owner.begin(), owner.end(), 2), 0);
}

TEST(BoxFit, ColourDecidesWhereTwoPlacesAreAlike) {
  objects::GroupGrid e = gridWith({60, 60}, {{14, 20, 8, 20}, {26, 20, 8, 20}});
  for (int y = 20; y < 40; ++y)
    for (int x = 26; x < 34; ++x) e.bin[e.at(x, y)] = 1;
  objects::FitTask task = taskAt({20, 20, 8, 20});
  task.bonus[1] = 2;
  EXPECT_EQ(fit(e, {task})[0].fitted.x, 26);
}

TEST(BoxFit, ColourDecidesWhoOwnsACellOfBoth) {
  const objects::GroupGrid e = gridWith({60, 60}, {{20, 20, 8, 20}}, 5);
  auto tasks = std::vector<objects::FitTask>{taskAt({20, 20, 8, 20}), taskAt({20, 20, 8, 20})};
  for (objects::FitTask& task : tasks) task.fitted = task.expected;
  std::vector<uint16_t> owner;
  objects::assignCells(e, tasks, owner);
  EXPECT_EQ(owner[e.at(20, 20)], 1);
  tasks[1].bonus[5] = 1;
  objects::assignCells(e, tasks, owner);
  EXPECT_EQ(owner[e.at(20, 20)], 2);
}

TEST(BoxFit, ABoxPrefersWhatIsExpectedToBeItsOwn) {
  objects::GroupGrid e = gridWith({60, 60}, {{14, 20, 8, 20}, {26, 20, 8, 20}});
  for (int y = 20; y < 40; ++y)
    for (int x = 14; x < 22; ++x) e.expected[e.at(x, y)] = 3;
  objects::FitTask task = taskAt({20, 20, 8, 20});
  task.track = 3;
  EXPECT_EQ(fit(e, {task})[0].fitted.x, 14);
  task.track = 4;
  EXPECT_EQ(fit(e, {task})[0].fitted.x, 26);
}

TEST(BoxFit, ACellOfBothBelongsToWhomItsRegionIsExpectedToBe) {
  objects::GroupGrid e = gridWith({60, 60}, {{20, 20, 8, 20}}, 5);
  e.expected[e.at(22, 22)] = 2;
  auto tasks = std::vector<objects::FitTask>{taskAt({20, 20, 8, 20}), taskAt({20, 20, 8, 20})};
  for (size_t i = 0; i < tasks.size(); ++i) {
    tasks[i].fitted = tasks[i].expected;
    tasks[i].track = static_cast<uint16_t>(i + 1);
  }
  std::vector<uint16_t> owner;
  objects::assignCells(e, tasks, owner);
  EXPECT_EQ(owner[e.at(22, 22)], 2);
  EXPECT_EQ(owner[e.at(23, 22)], 1);
}

TEST(BoxFit, BoxesMayReachBeyondTheFrame) {
  const objects::GroupGrid e = gridWith({10, 10}, {{0, 0, 4, 10}});
  EXPECT_EQ(fit(e, {taskAt({-5, -3, 8, 20})})[0].fitted.right(), 4);
  (void)fit(gridWith({1, 1}, {{0, 0, 1, 1}}), {taskAt({-30, -30, 50, 70})});
}

}  // namespace
}  // namespace rg
