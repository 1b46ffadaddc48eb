// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/tracking/steps/track_sizes.hpp"

#include <gtest/gtest.h>

#include <utility>

namespace rg {
namespace {

constexpr int kUnit = objects::kPositionUnit;
constexpr Size kFrame{768, 576};

/// A track of 30x80 px that is seen in boxes of its own.
class SeenTrack {
 public:
  explicit SeenTrack(objects::TrackerState state = {}, uint32_t sizeSamples = 20)
      : state_(std::move(state)) {
    evidence_.frame = state_.frame = kFrame;
    objects::Track track;
    track.id = state_.nextId++;
    track.x = 300 * kUnit;
    track.foot = 300 * kUnit;
    track.size = {30 * kUnit, 80 * kUnit};
    track.sizeSamples = sizeSamples;
    track.isSeen = true;
    state_.tracks.push_back(track);
    objects::Sighting& s = state_.sightings.emplace_back();
    s.isWhole = s.isSole = true;
  }

  void see(Size size) {
    state_.sightings[0].box = {300 - size.width / 2, 300 - size.height, size.width, size.height};
    learnSize(0, 40'000'000, evidence_, state_);
  }
  objects::Track& track() { return state_.tracks[0]; }
  [[nodiscard]] bool isSizeKnown() const { return state_.isSizeKnown(state_.tracks[0]); }
  [[nodiscard]] Size size() const {
    const objects::Extent& size = state_.tracks[0].size;
    return {(size.width + kUnit / 2) / kUnit, (size.height + kUnit / 2) / kUnit};
  }

 private:
  objects::TrackerState state_;
  objects::GroupGrid evidence_;
};

/// The size after eight seconds.
Size sizeAfterSeeing(Size seen, const objects::TrackerState& state) {
  SeenTrack track(state);
  for (int i = 0; i < 200; ++i) track.see(seen);
  return track.size();
}

TEST(TrackSizes, WhereAllAreOfOneSizeWhoIsSeenLargerIsHalfwayBetween) {
  objects::TrackerState state;
  state.scale.reset(kFrame);
  for (uint64_t thing = 1; thing <= 20; ++thing)
    state.scale.learn(thing, 300, {30 * kUnit, 80 * kUnit});
  ASSERT_TRUE(state.scale.isUniform());
  const Size pair = sizeAfterSeeing({60, 80}, state);
  EXPECT_NEAR(pair.width, 45, 1);
  EXPECT_EQ(pair.height, 80);
  const Size small = sizeAfterSeeing({20, 60}, state);
  EXPECT_NEAR(small.width, 25, 1);
  EXPECT_NEAR(small.height, 70, 1);
}

TEST(TrackSizes, WhereTheSceneSaysNothingWhatIsSeenCounts) {
  const Size wide = sizeAfterSeeing({60, 80}, {});
  EXPECT_NEAR(wide.width, 60, 1);
  EXPECT_EQ(wide.height, 80);
}

TEST(TrackSizes, WhatTurnsOutLargerHasNoPortraitOfBefore) {
  for (const bool showsMovers : {false, true}) {
    objects::TrackerState state;
    state.showsMovers = showsMovers;
    SeenTrack track(state, 0);
    track.see({30, 80});
    track.track().portrait.frames = 9;
    track.see({30, 82});
    EXPECT_EQ(track.track().portrait.frames, 9u);
    track.see({60, 160});
    EXPECT_EQ(track.track().portrait.frames, showsMovers ? 9u : 0u);
  }
}

TEST(TrackSizes, AreKnownOnceTheyAgreeFrameAfterFrame) {
  SeenTrack track({}, 0);
  for (int i = 0; i < 40; ++i) {
    track.see({i % 8 < 4 ? 30 : 60, 80});
    EXPECT_FALSE(track.isSizeKnown()) << i;
  }
  for (int i = 0; i < 9; ++i) track.see({30, 80});  // The first is off the one before.
  EXPECT_TRUE(track.isSizeKnown());
  EXPECT_EQ(track.size().width, 30);
}

TEST(TrackSizes, StridesAddLessThanTheyTakeAway) {
  SeenTrack track;
  for (int i = 0; i < 200; ++i) track.see({i % 4 < 2 ? 30 : 50, 80});
  EXPECT_GT(track.size().width, 31);
  EXPECT_LT(track.size().width, 38);
}

}  // namespace
}  // namespace rg
