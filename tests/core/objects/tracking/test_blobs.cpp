// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/tracking/steps/sightings.hpp"

#include <gtest/gtest.h>

namespace rg {
namespace {

/// Two tracks whose bodies of 6 x 12 cells, each of a group of its own, touch.
class TwoWhoTouch : public ::testing::Test {
 protected:
  TwoWhoTouch() {
    evidence_.frame = evidence_.grid = state_.frame = {24, 24};
    const auto cells = static_cast<size_t>(evidence_.grid.area());
    evidence_.group.assign(cells, 0);
    evidence_.isStill.assign(2, 0);
    state_.owner.assign(cells, 0);
    for (const uint16_t track : {uint16_t{1}, uint16_t{2}}) {
      const Box body{6 * track, 6, 6, 12};
      for (int y = body.y; y < body.bottom(); ++y)
        for (int x = body.x; x < body.right(); ++x)
          evidence_.group[evidence_.at(x, y)] = state_.owner[evidence_.at(x, y)] = track;
      state_.tracks.emplace_back().id = state_.nextId++;
      objects::FitTask& task = state_.tasks.emplace_back();
      task.track = track;
      task.fitted = body;
      objects::Sighting& s = state_.sightings.emplace_back();
      s.task = track - 1;
      s.box = body;
    }
    evidence_.listRuns();
  }

  void sight() {
    state_.blobs.find(evidence_, true, false);
    state_.crowds.find(evidence_, evidence_.showsMovers, false);
    state_.findBlobsOfTracks(evidence_);
    objects::sight(evidence_, state_);
  }

  objects::GroupGrid evidence_;
  objects::TrackerState state_;
};

TEST_F(TwoWhoTouch, AreACrowdBeforeAStillCameraHoweverTheEnergyPartsThem) {
  sight();
  EXPECT_FALSE(state_.blobs.areTogether(0, 1));
  EXPECT_TRUE(state_.crowds.areTogether(0, 1));
  EXPECT_EQ(state_.crowds.of(0).box, (Box{6, 6, 12, 12}));
  EXPECT_FALSE(state_.sightings[0].isSole || state_.sightings[1].isSole);
}

TEST_F(TwoWhoTouch, AreAloneBeforeAMovingCameraIfTheEnergyPartsThem) {
  evidence_.showsMovers = true;
  sight();
  EXPECT_FALSE(state_.crowds.areTogether(0, 1));
  EXPECT_TRUE(state_.sightings[0].isSole && state_.sightings[1].isSole);
}

TEST_F(TwoWhoTouch, ExchangeWhatIsSeenOfThem) {
  sight();
  state_.exchangeSightings(0, 1);
  EXPECT_EQ(state_.sightings[0].box, (Box{12, 6, 6, 12}));
  EXPECT_EQ(state_.blobs.of(0).box, (Box{12, 6, 6, 12}));
  EXPECT_EQ(state_.blobs.of(1).box, (Box{6, 6, 6, 12}));
}

}  // namespace
}  // namespace rg
