// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/tracking/region_owners.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace rg {
namespace {

using testing::ElementsAre;

/// One row of labels and of owners, '.' = none. Returns the numbers of the regions' owners.
std::vector<uint32_t> owners(const std::string& labels, const std::string& owner,
                             const std::vector<Point>& shifts) {
  segmentation::Labels regions;
  regions.ids.resize({static_cast<int>(labels.size()), 1});
  objects::GroupGrid grid;
  grid.frame = grid.grid = regions.ids.size();
  uint32_t count = 0;
  std::vector<uint16_t> ownerOfCell;
  for (size_t x = 0; x < labels.size(); ++x) {
    const auto digit = [](char c) { return static_cast<uint16_t>(c == '.' ? 0 : c - '0'); };
    regions.ids.at(static_cast<int>(x), 0) = digit(labels[x]);
    count = std::max<uint32_t>(count, digit(labels[x]));
    ownerOfCell.push_back(digit(owner[x]));
  }
  grid.group.assign(owner.size(), 1);
  grid.listRuns();
  objects::RegionOwnerScratch scratch;
  std::vector<objects::TrackIndex> result(count);
  objects::findRegionOwners(regions, grid, ownerOfCell, shifts, scratch, result);
  std::vector<uint32_t> numbers;
  for (const objects::TrackIndex track : result) numbers.push_back(track.number());
  return numbers;
}

TEST(RegionOwners, ARegionIsOfTheTrackThatHasMostOfIt) {
  EXPECT_THAT(owners("1112223.", "11222.22", {{}, {}}), ElementsAre(1, 2, 2));
}

TEST(RegionOwners, TheSmallerTrackWinsTies) {
  EXPECT_THAT(owners("1111", "2211", {{}, {}}), ElementsAre(1));
}

TEST(RegionOwners, WhatNoTrackTouchesHasNoOwner) {
  EXPECT_THAT(owners("11..22", "11....", {{}}), ElementsAre(1, 0));
  EXPECT_THAT(owners("11", "..", {}), ElementsAre(0));
}

TEST(RegionOwners, TracksAreMovedBeforeTheyAreCompared) {
  EXPECT_THAT(owners("..11.22.", "111222..", {{2, 0}, {2, 0}}), ElementsAre(1, 2));
  EXPECT_THAT(owners("..11.22.", "111222..", {{}, {}}), ElementsAre(1, 2));
  EXPECT_THAT(owners("11..22", "..11..", {{-2, 0}}), ElementsAre(1, 0));
}

TEST(RegionOwners, CellsThatLeaveTheFrameDoNotCount) {
  EXPECT_THAT(owners("11", "11", {{-5, 0}}), ElementsAre(0));
  EXPECT_THAT(owners("11", "11", {{0, 1}}), ElementsAre(0));
}

}  // namespace
}  // namespace rg
