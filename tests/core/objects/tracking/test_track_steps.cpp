// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/tracking/steps/track_steps.hpp"
#include "tests/core/body_scene.hpp"
#include "tests/core/scenes.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace rg {
namespace {

using testing::ElementsAre;
using testing::Optional;

/// One row of labels, and of owners in the frame before, '.' = none; regions move by whole pixels
/// to the right. Returns the pixels that each of `tracks` goes over the ground in a frame.
std::vector<std::optional<int>> steps(const std::string& labels, const std::string& owner,
                                      const std::vector<int>& moved, size_t tracks = 1,
                                      int camera = 0) {
  const auto digit = [](char c) { return static_cast<uint16_t>(c == '.' ? 0 : c - '0'); };
  const Size size{static_cast<int>(labels.size()), 1};
  auto regions = std::make_shared<segmentation::Labels>();
  regions->size = size;
  regions->status = Status::Ok;
  regions->count = static_cast<uint32_t>(moved.size());
  regions->ids.resize(size);
  std::vector<uint16_t> ownerOfCell;
  for (size_t x = 0; x < labels.size(); ++x) {
    regions->ids.at(static_cast<int>(x), 0) = digit(labels[x]);
    ownerOfCell.push_back(digit(owner[x]));
  }
  regions->picture = scenes::paintGrey(size, [](int, int) { return 9; });
  motion::Motion motion;
  motion.graph = *graph::makeStage(scenes::contextWith(1))->process(regions, {});
  for (const int dx : moved) motion.regions.push_back({dx * motion::kMotionUnit, 0, 0, 60});
  objects::GroupGrid grid;
  objects::gather(*motion.graph, std::vector(moved.size(), objects::GroupIndex::ofIndex(0)),
                  std::vector<uint8_t>{0}, std::vector<objects::TrackIndex>(moved.size()), grid);
  std::vector<objects::Track> found(tracks);
  objects::TrackStepScratch scratch;
  objects::measureSteps(motion, CameraMotion(Point{camera * motion::kMotionUnit, 0}), 1'000'000'000,
                        grid, ownerOfCell, scratch, found);
  std::vector<std::optional<int>> pixels;
  for (const objects::Track& track : found) {
    pixels.emplace_back();
    if (track.stepSpeed) pixels.back() = track.stepSpeed->x / objects::kPositionUnit;
  }
  return pixels;
}

TEST(TrackSteps, AreThoseOfTheRegionsThatCameFromTheTrack) {
  EXPECT_THAT(steps("222211112222", "1111........", {4, 0}), ElementsAre(Optional(4)));
  EXPECT_THAT(steps("222211112222", "........1111", {-4, 0}), ElementsAre(Optional(-4)));
  EXPECT_THAT(steps("111133332222", "1111....2222", {0, 0, 0}, 2),
              ElementsAre(Optional(0), Optional(0)));
}

TEST(TrackSteps, OfWhatTheTrackUncoveredSayNothing) {
  // The ground lies where the track was, but most of it did not come from there.
  EXPECT_THAT(steps("2222221111222", "1111.........", {6, 0}), ElementsAre(Optional(6)));
  EXPECT_THAT(steps("111111111", "1111.....", {0}), ElementsAre(std::nullopt));
}

TEST(TrackSteps, AreOverTheGround) {
  EXPECT_THAT(steps("222211112222", "1111........", {4, 3}, 1, 3), ElementsAre(Optional(1)));
}

TEST(TrackSteps, NeedHalfOfWhatTheTrackWas) {
  EXPECT_THAT(steps("222211222222", "1111........", {4, 0}), ElementsAre(Optional(4)));
  EXPECT_THAT(steps("222212222222", "1111........", {4, 0}), ElementsAre(std::nullopt));
}

TEST(TrackSteps, AreTheMedianOfWhatTheRegionsSay) {
  EXPECT_THAT(steps("444.12233444", "11111.......", {4, 4, 7, 0}), ElementsAre(Optional(4)));
}

TEST(TrackSteps, OfWhatCameFromBeyondTheFrameSayNothing) {
  EXPECT_THAT(steps("11112222", "11112222", {9, -9}, 2), ElementsAre(std::nullopt, std::nullopt));
}

TEST(TrackSteps, OfNoTrackAreNone) {
  EXPECT_THAT(steps("1122", "....", {1, 2}, 0), ElementsAre());
}

/// Somebody in two colours goes 20 px a frame before a camera that pans, and turns back in between
/// two frames, every eight.
TEST(TurningBack, LeavesTheBoxOnTheBody) {
  const Size frame{320, 240};
  BodyScene scene(frame, segmentation::Scope::Frame);
  int x = 40;
  for (int i = 0; i < 40; ++i) {
    const int walked = i == 0 ? 0 : i % 16 < 8 ? 20 : -20, pan = i % 2 == 0 ? 2 : -2;
    x += walked + pan;
    const motion::RegionMotion ground{pan * motion::kMotionUnit, 0, 0, motion::kFullReliability};
    const motion::RegionMotion walk{(pan + walked) * motion::kMotionUnit, 0, 0,
                                    motion::kFullReliability};
    const Box body{x, 90, 24, 60};
    const auto objects = scene.show({{boundsOf(frame), {30, 180, 40}},
                                     {{x, 90, 24, 30}, {200, 30, 30}},
                                     {{x, 120, 24, 30}, {30, 40, 200}}},
                                    {ground, walk, walk});
    if (i < 4) continue;
    ASSERT_EQ(objects->objects.size(), 1u) << i;
    EXPECT_EQ(objects->objects[0].id, 1u) << i;
    EXPECT_GE(intersect(objects->objects[0].box, body).area(), body.area() * 9 / 10) << i;
    EXPECT_LE(objects->objects[0].box.area(), body.area() * 11 / 10) << i;
  }
}

}  // namespace
}  // namespace rg
