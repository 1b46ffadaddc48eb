// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/ghosts/swaying_parts.hpp"
#include "tests/support/text_picture.hpp"

#include <gtest/gtest.h>

namespace rg {
namespace {

constexpr Size kSize{200, 160};
constexpr Box kPart{60, 40, 12, 12};
constexpr Box kLeaves{76, 40, 30, 12};  ///< Four pixels beside the part.
constexpr int kSky = 200, kLeaf = 60, kCar = 130;

/// Sky and leaves that the model knows, and a part of another colour beside the leaves.
class SwayingParts : public ::testing::Test {
 protected:
  SwayingParts() {
    show(kSky);
    background::prepare(kSize, 3, model_);
    background::fillFrom(smooth_, Executor(1), model_);
  }
  void show(int level) {
    const auto picture = test::makePicture(kSize, [&](int x, int y) {
      const int shown = kPart.contains({x, y}) ? level : kLeaves.contains({x, y}) ? kLeaf : kSky;
      const auto grey = static_cast<uint8_t>(shown);
      return test::Rgb{grey, grey, grey};
    });
    background::smooth(*picture, Executor(1), smooth_);
  }
  void unsettle(int unrest, int columns = kPart.width) {
    for (int y = kPart.y; y < kPart.bottom(); ++y)
      for (int x = kPart.x; x < kPart.x + columns; ++x)
        model_.unrest.at(x, y) = static_cast<uint8_t>(unrest);
  }
  bool isDropped(int level) {
    show(level);
    mask_.resize(kSize);
    mask_.clear();
    for (int y = kPart.y; y < kPart.bottom(); ++y)
      setColumns(mask_.row(y), kPart.x, kPart.right(), true);
    background::dropSwaying(smooth_, model_, {10, 0}, scratch_, mask_);
    const uint32_t left = countSet(mask_);
    EXPECT_TRUE(left == 0 || left == kPart.area());
    return left == 0;
  }

  background::SmoothPicture smooth_;
  background::ConsensusBackground model_;
  background::SwayScratch scratch_;
  BitMask mask_;
};

TEST_F(SwayingParts, AreDroppedWhereTheBackgroundIsRestlessAndKnownCloseBy) {
  show(kSky);
  unsettle(64);
  for (int y = kPart.y; y < kPart.bottom(); ++y)
    for (int x = kPart.x; x < kPart.right(); ++x)
      for (int k = 0; k < background::kSamples; ++k)
        for (int c = 0; c < 3; ++c)
          model_.sample({x, y}, k, c) = static_cast<uint8_t>(x % 4 < 2 ? kLeaf : kSky);
  EXPECT_TRUE(isDropped(kLeaf));
}

TEST_F(SwayingParts, StayWhereNothingHasFlippedLately) {
  unsettle(0);
  EXPECT_FALSE(isDropped(kSky));
}

TEST_F(SwayingParts, StayWhereTheirColourIsNotCloseBy) {
  unsettle(64);
  EXPECT_FALSE(isDropped(kCar));
  EXPECT_TRUE(isDropped(kSky));
}

TEST_F(SwayingParts, GoIfAQuarterOfThemIsRestless) {
  unsettle(24, 2);
  EXPECT_FALSE(isDropped(kSky));
  unsettle(24, 4);
  EXPECT_TRUE(isDropped(kSky));
  unsettle(23);
  EXPECT_FALSE(isDropped(kSky));
}

/// The radius is 13, with two levels for noise and one for unrest.
TEST_F(SwayingParts, StayWhereTheirColourIsCloseByOnlyRoughly) {
  unsettle(24);
  EXPECT_TRUE(isDropped(kSky + 8));
  EXPECT_FALSE(isDropped(kSky + 9));
}

TEST_F(SwayingParts, AThinOneThatIsNotLookedAtStays) {
  unsettle(64);
  show(kSky);
  mask_.resize(kSize);
  mask_.clear();
  setColumns(mask_.row(kPart.y + 1), kPart.x, kPart.right(), true);
  background::dropSwaying(smooth_, model_, {10, 0}, scratch_, mask_);
  EXPECT_EQ(countSet(mask_), static_cast<uint32_t>(kPart.width));
}

}  // namespace
}  // namespace rg
