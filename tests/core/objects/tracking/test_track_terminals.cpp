// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/objects/tracking/ownership/track_terminals.hpp"
#include "tests/core/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <random>
#include <vector>

namespace rg {
namespace {

constexpr int kUnit = objects::kPositionUnit;
constexpr int64_t kStepNs = 40'000'000;
constexpr Size kFrame{96, 64};
constexpr graph::Colour kRed{200, 40, 40}, kBlue{40, 40, 200};

/// Regions and tracks in a frame of which a cell is a pixel. Region 0 is the background.
class TrackTerminals : public ::testing::Test {
 protected:
  TrackTerminals() { clear(); }

  void clear() {
    labels_ = std::make_shared<segmentation::Labels>();
    labels_->size = kFrame;
    labels_->ids.resize(kFrame);
    labels_->ids.fill(1);
    labels_->count = 1;
    labels_->status = Status::Ok;
    colours_.assign(1, {90, 90, 90});
    motions_.assign(1, {});
    expected_.assign(1, {});
    partedFrom_.assign(static_cast<size_t>(kFrame.area()), 0);
    state_ = {};
    state_.frame = kFrame;
    evidence_.showsMovers = false;
  }

  size_t paint(const Box& box, graph::Colour colour = kRed) {
    ++labels_->count;
    forCells(box,
             [&](int x, int y) { labels_->ids.at(x, y) = static_cast<uint16_t>(labels_->count); });
    colours_.push_back(colour);
    motions_.emplace_back();
    expected_.emplace_back();
    return labels_->count - 1;
  }

  /// A region that surely moves by so many pixels to the right in a frame.
  void paintMoving(const Box& box, int px) {
    const size_t region = paint(box);
    motions_[region].dx = px * motion::kMotionUnit;
    motions_[region].reliability = motion::kFullReliability;
  }

  /// One of known size that stands and is expected in `box`.
  objects::Track& add(const Box& box) {
    objects::Track track;
    track.id = state_.nextId++;
    track.x = (2 * box.x + box.width) * kUnit / 2;
    track.foot = box.bottom() * kUnit;
    track.size = {box.width * kUnit, box.height * kUnit};
    track.hits = 20;
    track.sizeSamples = 20;
    track.sway = 20;
    state_.tracks.push_back(track);
    objects::FitTask task;
    task.track = static_cast<uint16_t>(state_.tracks.size());
    task.expected = task.fitted = box;
    state_.tasks.push_back(task);
    state_.sightings.emplace_back().task = static_cast<int>(state_.tasks.size()) - 1;
    return state_.tracks.back();
  }

  /// Tracks claim what is in their boxes, the first ones first.
  void decide(objects::TrackTerminals& terminals) {
    labels_->picture = scenes::paint(kFrame, [&](int x, int y) {
      const graph::Colour& colour = colours_[labels_->ids.at(x, y) - 1u];
      return scenes::Rgb{colour.red, colour.green, colour.blue};
    });
    motion_.graph = *graph::makeStage(scenes::contextWith(1))->process(labels_, {});
    motion_.regions = motions_;
    std::vector<objects::GroupIndex> groupOf;
    for (size_t r = 0; r < labels_->count; ++r) groupOf.push_back(objects::GroupIndex::ofIndex(r));
    std::vector<uint8_t> isBackground(labels_->count, 0);
    isBackground[0] = 1;
    objects::gather(*motion_.graph, groupOf, isBackground, expected_, evidence_);
    state_.owner.assign(evidence_.group.size(), 0);
    for (const objects::FitTask& task : state_.tasks) {
      const bool isLookedFor = state_.sightings[task.trackIndex()].task >= 0;
      forCells(task.fitted, [&](int x, int y) {
        const size_t cell = evidence_.at(x, y);
        if (isLookedFor && evidence_.group[cell] != 0 && state_.owner[cell] == 0)
          state_.owner[cell] = task.track;
      });
    }
    state_.blobs.find(evidence_, true, false);
    state_.blobs.findOwners(evidence_, state_.tasks, state_.owner, state_.tracks.size());
    terminals.decide(evidence_, {motion_, weights_, kStepNs}, partedFrom_, state_);
  }
  void decide() { decide(terminals_); }

  template <class Visit>
  static void forCells(const Box& box, const Visit& visit) {
    const Box inside = intersect(box, boundsOf(kFrame));
    for (int y = inside.y; y < inside.bottom(); ++y)
      for (int x = inside.x; x < inside.right(); ++x) visit(x, y);
  }
  /// Of all cells of a box: the track, from 1; 0 = none; −1 = several.
  [[nodiscard]] int ownerOf(const Box& box) const {
    const int first = state_.owner[evidence_.at(box.x, box.y)];
    bool isAll = true;
    forCells(box, [&](int x, int y) { isAll &= state_.owner[evidence_.at(x, y)] == first; });
    return isAll ? first : -1;
  }

  std::shared_ptr<segmentation::Labels> labels_;
  std::vector<graph::Colour> colours_;
  std::vector<motion::RegionMotion> motions_;
  std::vector<objects::TrackIndex> expected_;
  std::vector<uint16_t> partedFrom_;
  motion::Motion motion_;
  objects::MergeWeights weights_;
  objects::GroupGrid evidence_;
  objects::TrackerState state_;
  objects::TrackTerminals terminals_;
};

constexpr Box kBody{30, 10, 16, 40};

TEST_F(TrackTerminals, WhatFillsAnOutlineIsTheTracks) {
  paint(kBody);
  add(kBody);
  decide();
  EXPECT_EQ(ownerOf(kBody), 1);
  EXPECT_EQ(state_.sightings[0].box, kBody);
  EXPECT_EQ(state_.sightings[0].areaPx, 640u);
  EXPECT_EQ(state_.sightings[0].sumX, 640 * (2 * 30 + 15) * 128);
}

TEST_F(TrackTerminals, AnArmGoesWithItsBody) {
  expected_[paint(kBody)] = objects::TrackIndex::ofIndex(0);
  const Box arm{46, 20, 1, 5};
  forCells(arm, [&](int x, int y) { labels_->ids.at(x, y) = 2; });
  add(kBody);
  decide();
  EXPECT_EQ(ownerOf(arm), 1);
  EXPECT_EQ(state_.sightings[0].box, unite(kBody, arm));
}

TEST_F(TrackTerminals, WhatIsFarFromAnOutlineIsNobodys) {
  paint({30, 10, 60, 40});
  add(kBody);
  decide();
  EXPECT_EQ(ownerOf(kBody), 1);
  EXPECT_EQ(ownerOf({46, 10, 44, 40}), 0);
  EXPECT_EQ(state_.sightings[0].box, kBody);
}

TEST_F(TrackTerminals, TwoShareARegionThatTheyFill) {
  paint({30, 10, 32, 40});
  add(kBody);
  add({46, 10, 16, 40});
  decide();
  EXPECT_EQ(ownerOf(kBody), 1);
  EXPECT_EQ(ownerOf({46, 10, 16, 40}), 2);
  EXPECT_EQ(state_.sightings[1].box, (Box{46, 10, 16, 40}));
  EXPECT_EQ(state_.sightings[1].areaPx, 640u);
}

TEST_F(TrackTerminals, WhoIsExpectedThereGetsWhatTwoOutlinesCover) {
  const size_t region = paint(kBody);
  expected_[region] = objects::TrackIndex::ofIndex(1);
  add(kBody);
  add(kBody);
  decide();
  EXPECT_EQ(ownerOf(kBody), 2);
}

TEST_F(TrackTerminals, ColoursTellWhoseItIs) {
  paint(kBody, kBlue);
  add(kBody);
  add(kBody);
  const size_t blue = objects::colourBin(kBlue.red, kBlue.green, kBlue.blue);
  state_.tasks[0].bonus.fill(-1);
  state_.tasks[1].bonus.fill(-1);
  state_.tasks[1].bonus[blue] = 2;
  decide();
  EXPECT_EQ(ownerOf(kBody), 2);
}

TEST_F(TrackTerminals, MotionTellsWhoseItIs) {
  paintMoving(kBody, 4);
  add(kBody);
  add(kBody).speedX = 4 * kUnit * 25;
  decide();
  EXPECT_EQ(ownerOf(kBody), 2);
}

TEST_F(TrackTerminals, OfOneThatIsNewNoMotionIsKnown) {
  paintMoving(kBody, 40);
  add(kBody).hits = 1;
  decide();
  EXPECT_EQ(ownerOf(kBody), 1);
}

TEST_F(TrackTerminals, PortraitsTellWhoseItIs) {
  paint(kBody, kBlue);
  for (const graph::Colour colour : {kRed, kBlue}) {
    objects::Portrait& portrait = add(kBody).portrait;
    portrait.sizePx = portrait.grid = {kBody.width, kBody.height};
    portrait.samples.assign(static_cast<size_t>(kBody.area()),
                            {colour.red, colour.green, colour.blue, 8, 0});
    portrait.frames = 8;
    state_.sightings.back().isMatched = true;
    state_.sightings.back().corner = {kBody.x, kBody.y};
  }
  decide();
  EXPECT_EQ(ownerOf(kBody), 2);
}

TEST_F(TrackTerminals, OneOfUnknownSizeIsAllOfItsBlobAndNothingElse) {
  const Box blob{30, 10, 40, 40}, other{30, 54, 16, 4};
  paint(blob);
  paint(other);
  add(kBody).sizeSamples = 0;
  decide();
  EXPECT_EQ(ownerOf(blob), 1);
  EXPECT_EQ(ownerOf(other), 0);
}

TEST_F(TrackTerminals, BeforeAMovingCameraATrackIsWhatItsBlobIs) {
  const Box blob{30, 10, 40, 40};
  paint(blob);
  add(kBody);
  evidence_.showsMovers = true;
  decide();
  EXPECT_EQ(ownerOf(blob), 1);
}

TEST_F(TrackTerminals, WhatATrackGaveUpIsNotItsOwn) {
  const Box head{30, 10, 16, 10}, rest{30, 22, 16, 28};
  paint(head);
  paint(rest);
  add(kBody);
  forCells(head, [&](int x, int y) { partedFrom_[static_cast<size_t>(y * kFrame.width + x)] = 1; });
  decide();
  EXPECT_EQ(ownerOf(head), 0);
  EXPECT_EQ(ownerOf(rest), 1);
}

TEST_F(TrackTerminals, WhoIsNotLookedForGetsNothing) {
  paint(kBody);
  add(kBody);
  state_.sightings[0].task = -1;
  decide();
  EXPECT_EQ(ownerOf(kBody), 0);
  EXPECT_TRUE(state_.sightings[0].box.isEmpty());
}

/// Random frames, each by what served the ones before and by what is new.
TEST_F(TrackTerminals, NothingIsLeftOfTheFramesBefore) {
  std::mt19937 dice(5);
  const auto any = [&](int from, int to) {
    return from + static_cast<int>(dice() % static_cast<unsigned>(to - from));
  };
  const auto anyBox = [&] { return Box{any(0, 90), any(0, 60), any(4, 30), any(4, 30)}; };
  objects::TrackTerminals used;
  size_t owned = 0;
  for (int round = 0; round < 60; ++round) {
    clear();
    for (int i = any(1, 12); i > 0; --i)
      paint(intersect(anyBox(), boundsOf(kFrame)), any(0, 2) == 0 ? kRed : kBlue);
    // Of what others hide a pixel is left, as no region is empty.
    for (int label = 2; label <= static_cast<int>(labels_->count); ++label)
      labels_->ids.at(label, 0) = static_cast<uint16_t>(label);
    for (int i = any(0, 8); i > 0; --i) add(anyBox()).sizeSamples = any(0, 2) == 0 ? 0 : 20;
    const objects::TrackerState before = state_;
    decide(used);
    const objects::TrackerState after = state_;
    state_ = before;
    objects::TrackTerminals fresh;
    decide(fresh);
    EXPECT_EQ(state_.owner, after.owner);
    for (size_t i = 0; i < state_.sightings.size(); ++i) {
      EXPECT_EQ(state_.sightings[i].box, after.sightings[i].box);
      owned += state_.sightings[i].areaPx > 0;
    }
    for (size_t cell = 0; cell < state_.owner.size(); ++cell)
      EXPECT_TRUE(state_.owner[cell] == 0 || evidence_.group[cell] != 0);
  }
  EXPECT_GT(owned, 60u);
}

}  // namespace
}  // namespace rg
