// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/tracking/steps/doubles.hpp"

#include <gtest/gtest.h>

namespace rg {
namespace {

constexpr int kUnit = objects::kPositionUnit;

/// A track that has been seen with this box, and that owns so many cells.
void add(objects::TrackerState& state, const Box& box, uint32_t cells) {
  objects::Track track;
  track.id = state.nextId++;
  track.x = (2 * box.x + box.width) * kUnit / 2;
  track.foot = box.bottom() * kUnit;
  track.size = {box.width * kUnit, box.height * kUnit};
  track.look.frames = track.portrait.frames = static_cast<uint32_t>(track.id);
  track.fill = static_cast<uint16_t>(100 * track.id);
  track.isSeen = true;
  state.tracks.push_back(track);
  state.sightings.emplace_back().cells = cells;
}

class Doubles : public ::testing::Test {
 protected:
  void join() {
    state_.blobs.findOwners(evidence_, {}, state_.owner, state_.tracks.size());
    objects::joinDoubles(40'000'000, state_);
  }
  objects::GroupGrid evidence_;
  objects::TrackerState state_;
};

TEST_F(Doubles, TheOlderKeepsItsNumberAndTakesTheLooksOfWhoIsMoreOfTheBody) {
  add(state_, {100, 200, 20, 16}, 10);
  add(state_, {95, 100, 40, 100}, 200);
  join();
  EXPECT_FALSE(state_.tracks[0].isOver);
  EXPECT_TRUE(state_.tracks[1].isOver);
  EXPECT_EQ(state_.tracks[0].box(), (Box{95, 100, 40, 116}));
  EXPECT_EQ(state_.tracks[0].look.frames, 2u);
  EXPECT_EQ(state_.tracks[0].portrait.frames, 2u);
  EXPECT_EQ(state_.tracks[0].fill, 200);
}

TEST_F(Doubles, TheOlderKeepsItsLooksWhenAFootOfItJoinsIt) {
  add(state_, {95, 100, 40, 100}, 200);
  add(state_, {100, 200, 20, 16}, 10);
  join();
  EXPECT_TRUE(state_.tracks[1].isOver);
  EXPECT_EQ(state_.tracks[0].box(), (Box{95, 100, 40, 116}));
  EXPECT_EQ(state_.tracks[0].look.frames, 1u);
  EXPECT_EQ(state_.tracks[0].portrait.frames, 1u);
}

TEST_F(Doubles, WhoStandBesideEachOtherStayTwo) {
  add(state_, {95, 100, 40, 100}, 200);
  add(state_, {140, 100, 40, 100}, 200);
  join();
  EXPECT_FALSE(state_.tracks[0].isOver || state_.tracks[1].isOver);
}

TEST_F(Doubles, WhoWereBothSeenApartStayTwoHoweverLongTheyLookLikeOneBody) {
  add(state_, {95, 100, 40, 100}, 200);
  add(state_, {100, 200, 20, 16}, 10);
  for (objects::Track& track : state_.tracks) track.apartNs = 500'000'000;
  for (int frame = 0; frame < 50; ++frame) join();
  EXPECT_FALSE(state_.tracks[0].isOver || state_.tracks[1].isOver);
  state_.tracks[1].apartNs = 400'000'000;
  for (int frame = 0; frame < 50; ++frame) join();
  EXPECT_FALSE(state_.tracks[0].isOver);
  EXPECT_TRUE(state_.tracks[1].isOver);
}

/// A body and its lower part, which touch and are of the same group or not.
class HalvesOfABody : public Doubles {
 protected:
  /// Whether they are joined in the end.
  bool areJoined(bool showsMovers, uint16_t groupBelow, uint32_t sizeSamples) {
    evidence_.frame = evidence_.grid = {8, 4};
    evidence_.group.assign(24, 1);
    evidence_.group.resize(32, groupBelow);
    evidence_.listRuns();
    state_ = {};
    state_.showsMovers = showsMovers;
    state_.blobs.find(evidence_, true, false);
    add(state_, {95, 100, 40, 60}, 200);
    add(state_, {100, 160, 20, 40}, 100);
    for (objects::Track& track : state_.tracks) track.sizeSamples = sizeSamples;
    std::vector<uint16_t> owner(24, 1);
    owner.resize(32, 2);
    state_.tasks.resize(2);
    state_.tasks[0].track = 1;
    state_.tasks[0].fitted = {0, 0, 8, 3};
    state_.tasks[1].track = 2;
    state_.tasks[1].fitted = {0, 3, 8, 1};
    state_.blobs.findOwners(evidence_, state_.tasks, owner, 2);
    for (int frame = 0; frame < 20; ++frame) objects::joinDoubles(40'000'000, state_);
    return state_.tracks[1].isOver;
  }
};

TEST_F(HalvesOfABody, AreTwoThingsBeforeAMovingCameraIfTheEnergyPartsThem) {
  EXPECT_FALSE(areJoined(true, 2, 0));
  EXPECT_TRUE(areJoined(false, 2, 0));
}

TEST_F(HalvesOfABody, AreOneBeforeAMovingCameraHoweverWellTheirSizesSeemKnown) {
  EXPECT_TRUE(areJoined(true, 1, 100));
  EXPECT_FALSE(areJoined(false, 1, 100));
}

}  // namespace
}  // namespace rg
