// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/tracking/steps/returns.hpp"

#include <gtest/gtest.h>

namespace rg {
namespace {

constexpr int kUnit = objects::kPositionUnit;
constexpr uint8_t kDark = 24, kBright = 31;  // Colour bins.

/// A track of one colour that stands there and owns a cell, the first or the second one.
objects::Track& add(objects::TrackerState& state, const Box& box, uint8_t bin) {
  objects::Track track;
  track.id = state.nextId++;
  track.x = (2 * box.x + box.width) * kUnit / 2;
  track.foot = box.bottom() * kUnit;
  track.size = {box.width * kUnit, box.height * kUnit};
  objects::LookCounts counts;
  for (auto& bins : counts.bins) bins[bin] = 10;
  learn(track.look, counts);
  state.tracks.push_back(track);
  state.sightings.emplace_back().cells = static_cast<uint32_t>(track.id);
  state.owner.push_back(static_cast<uint16_t>(state.tracks.size()));
  return state.tracks.back();
}

/// One that is known goes missing where a young one has begun beside it.
class Returns : public ::testing::Test {
 protected:
  Returns() {
    objects::Track& missing = add(state_, {100, 100, 24, 60}, kDark);
    missing.isConfirmed = true;
    missing.speedX = 40 * kUnit;
  }
  void begin(const Box& box, uint8_t bin) {
    objects::Track& young = add(state_, box, bin);
    young.isSeen = true;
    young.speedX = -30 * kUnit;
  }
  void settle() {
    state_.findBlobsOfTracks(evidence_);
    returns_.settle(evidence_, encounters_, newcomers_, state_);
  }
  void expectNoSuccessor() {
    settle();
    EXPECT_FALSE(state_.tracks[0].isSeen);
    EXPECT_FALSE(state_.tracks[1].isOver);
  }
  objects::GroupGrid evidence_;
  objects::TrackerState state_;
  objects::Encounters encounters_;
  objects::Newcomers newcomers_;
  objects::Returns returns_;
};

TEST_F(Returns, AMissingTrackTakesThePlaceOfItsSuccessor) {
  begin({80, 102, 24, 60}, kDark);
  settle();
  const objects::Track &known = state_.tracks[0], &young = state_.tracks[1];
  EXPECT_TRUE(known.isSeen);
  EXPECT_EQ(known.id, 1u);
  EXPECT_EQ(known.box(), (Box{80, 102, 24, 60}));
  EXPECT_EQ(known.speedX, -30 * kUnit);
  EXPECT_EQ(state_.sightings[0].cells, 2u);
  EXPECT_EQ(state_.owner, (std::vector<uint16_t>{1, 1}));
  EXPECT_TRUE(young.isOver);
  EXPECT_FALSE(young.isSeen);
  EXPECT_FALSE(young.isConfirmed);  // Its end is not told.
}

TEST_F(Returns, WhoLooksOtherwiseIsSomebodyElse) {
  begin({80, 102, 24, 60}, kBright);
  expectNoSuccessor();
}

TEST_F(Returns, WhoIsFarAwayIsSomebodyElse) {
  begin({40, 102, 24, 60}, kDark);
  expectNoSuccessor();
}

TEST_F(Returns, WhoWasToldOfStays) {
  begin({80, 102, 24, 60}, kDark);
  state_.tracks[1].isConfirmed = true;
  expectNoSuccessor();
}

TEST_F(Returns, WhomNobodyWasToldOfTakesNobodysPlace) {
  begin({80, 102, 24, 60}, kDark);
  state_.tracks[0].isConfirmed = false;
  expectNoSuccessor();
}

TEST_F(Returns, TheNearerOfTwoIsTheSuccessor) {
  begin({82, 102, 24, 60}, kDark);
  begin({90, 102, 24, 60}, kDark);
  settle();
  EXPECT_EQ(state_.tracks[0].box(), (Box{90, 102, 24, 60}));
  EXPECT_FALSE(state_.tracks[1].isOver);
  EXPECT_TRUE(state_.tracks[2].isOver);
}

}  // namespace
}  // namespace rg
