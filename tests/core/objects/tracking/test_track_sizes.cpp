// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/tracking/steps/track_sizes.hpp"

#include <gtest/gtest.h>

namespace rg {
namespace {

constexpr int kUnit = objects::kPositionUnit;
constexpr Size kFrame{768, 576};

/// The size of a track of 30x80 px after it was seen in a box of `seen` px for eight seconds.
Size sizeAfterSeeing(Size seen, objects::TrackerState state) {
  objects::GroupGrid evidence;
  evidence.frame = state.frame = kFrame;
  objects::Track track;
  track.id = state.nextId++;
  track.x = 300 * kUnit;
  track.foot = 300 * kUnit;
  track.size = {30 * kUnit, 80 * kUnit};
  track.sizeSamples = 20;
  track.isSeen = true;
  state.tracks.push_back(track);
  objects::Sighting& s = state.sightings.emplace_back();
  s.isWhole = s.isSole = true;
  s.box = {300 - seen.width / 2, 300 - seen.height, seen.width, seen.height};
  for (int i = 0; i < 200; ++i) learnSize(0, 40'000'000, evidence, state);
  const objects::Extent& size = state.tracks[0].size;
  return {(size.width + kUnit / 2) / kUnit, (size.height + kUnit / 2) / kUnit};
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

}  // namespace
}  // namespace rg
