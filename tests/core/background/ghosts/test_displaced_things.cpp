// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/ghosts/displaced_things.hpp"
#include "tests/support/text_picture.hpp"

#include <gtest/gtest.h>

namespace rg {
namespace {

using test::makePicture;
using test::Rgb;

constexpr Size kSize{80, 60};
constexpr Box kBefore{30, 10, 10, 30}, kAfter{32, 20, 26, 20};
constexpr Rgb kWall{120, 125, 118}, kRed{180, 40, 30}, kBlue{30, 50, 170}, kGrey{80, 82, 84};

background::SmoothPicture shoot(const Box& box, Rgb colour) {
  background::SmoothPicture out;
  const auto picture = makePicture(kSize, [&](int x, int y) {
    return box.contains({x, y}) ? colour : kWall;
  });
  background::smooth(*picture, Executor(1), out);
  return out;
}

/// Something stood, something stands, and what differs has been still for some frames; in the rest
/// of it there is motion. Returns how many pixels are taken for moved.
uint32_t moved(Rgb before, Rgb after, int stillPercent = 100) {
  const background::SmoothPicture then = shoot(kBefore, before), now = shoot(kAfter, after);
  background::ConsensusBackground model;
  background::prepare(kSize, 3, model);
  background::fillFrom(then, Executor(1), model);
  background::StillPixels still;
  background::prepare(kSize, 3, still);
  background::clear(still);
  BitMask foreground(kSize), out(kSize);
  foreground.clear();
  out.clear();
  for (int y = 0; y < kSize.height; ++y)
    for (int x = 0; x < kSize.width; ++x)
      if (kBefore.contains({x, y}) || kAfter.contains({x, y})) {
        foreground.set(x, y);
        if ((x * 7 + y * 13) % 100 < stillPercent) still.ages.at(x, y) = 45;
      }
  background::DisplacedScratch scratch;
  background::addDisplaced(now, model, foreground, still, 45, scratch, out);
  background::addDisplaced(now, model, foreground, still, 46, scratch,
                           out);  // Nothing is as old as that.
  return countSet(out);
}

TEST(MovedThings, AThingThatWasTurnedBelongsToTheScene) {
  EXPECT_GT(moved(kRed, kRed), 600u);
}

TEST(MovedThings, AnotherThingDoesNot) {
  EXPECT_EQ(moved(kRed, kBlue), 0u);
  EXPECT_EQ(moved(kWall, kRed), 0u);
}

TEST(MovedThings, GreyOnGreyIsNoEvidence) {
  EXPECT_EQ(moved(kGrey, kGrey), 0u);
}

TEST(MovedThings, WhatMovesHasNotBeenMoved) {
  EXPECT_EQ(moved(kRed, kRed, 60), 0u);
}

}  // namespace
}  // namespace rg
