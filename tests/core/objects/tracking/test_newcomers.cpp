// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/tracking/steps/newcomers.hpp"

#include <gtest/gtest.h>

namespace rg {
namespace {

/// A body of 8 x 12 cells, its foot of 4 x 2 below a gap of a row, each of a group of its own.
objects::GroupGrid bodyAndFoot(bool showsMovers) {
  objects::GroupGrid e;
  e.frame = e.grid = {16, 24};
  const auto cells = static_cast<size_t>(e.grid.area());
  e.group.assign(cells, 0);
  e.bin.assign(cells, 0);
  const auto fill = [&](const Box& box, uint16_t group) {
    for (int y = box.y; y < box.bottom(); ++y)
      for (int x = box.x; x < box.right(); ++x) e.group[e.at(x, y)] = group;
  };
  fill({4, 4, 8, 12}, 1);
  fill({5, 17, 4, 2}, 2);
  e.showsMovers = showsMovers;
  e.listRuns();
  return e;
}

class OfTwoGroups : public ::testing::TestWithParam<bool> {
 protected:
  objects::GroupGrid evidence_ = bodyAndFoot(GetParam());
  objects::TrackerState state_;
  objects::Newcomers newcomers_;
};

TEST_P(OfTwoGroups, ComeOneOrTwoInAsTheCameraStandsOrMoves) {
  state_.owner.assign(evidence_.group.size(), 0);
  newcomers_.find(evidence_, 1, state_);
  if (GetParam()) {
    ASSERT_EQ(newcomers_.list().size(), 2u);
    EXPECT_EQ(newcomers_.list()[0].box, (Box{4, 4, 8, 12}));
    EXPECT_EQ(newcomers_.list()[1].box, (Box{5, 17, 4, 2}));
  } else {
    ASSERT_EQ(newcomers_.list().size(), 1u);
    EXPECT_EQ(newcomers_.list()[0].box, (Box{4, 4, 8, 15}));
  }
}

TEST_P(OfTwoGroups, TheSmallerGoesToATrackOnlyIfTheCameraStands) {
  state_.tracks.emplace_back().id = state_.nextId++;
  state_.tracks[0].isSeen = true;
  state_.sightings.emplace_back().box = {4, 4, 8, 12};
  state_.owner.assign(evidence_.group.size(), 0);
  for (size_t cell = 0; cell < state_.owner.size(); ++cell)
    state_.owner[cell] = evidence_.group[cell] == 1;
  state_.blobs.find(evidence_, true, false);
  state_.tasks.resize(1);
  state_.tasks[0].track = 1;
  state_.tasks[0].fitted = {4, 4, 8, 12};
  state_.blobs.findOwners(evidence_, state_.tasks, state_.owner, 1);
  newcomers_.find(evidence_, 1, state_);
  ASSERT_EQ(newcomers_.list().size(), 1u);
  EXPECT_EQ(newcomers_.list()[0].cells > 0, GetParam());
  EXPECT_EQ(state_.sightings[0].box, (GetParam() ? Box{4, 4, 8, 12} : Box{4, 4, 8, 15}));
  EXPECT_EQ(state_.owner[evidence_.at(6, 17)], GetParam() ? 0 : 1);
}

INSTANTIATE_TEST_SUITE_P(BeforeAStillAndAMovingCamera, OfTwoGroups, ::testing::Bool());

}  // namespace
}  // namespace rg
