// SPDX-License-Identifier: LGPL-2.1-or-later
#include "core/background/ghosts/mask_contour.hpp"
#include "tests/support/text_picture.hpp"

#include <gtest/gtest.h>

#include <functional>

namespace rg {
namespace {

using background::BorderLayer;
using test::makePicture;
using test::Rgb;

constexpr Size kSize{70, 30};
constexpr Box kPart{20, 8, 12, 12};  ///< What is sure.
constexpr int kWall = 100;

/// A grey wall, and a model that knows it, with the least radius 10 everywhere.
class MaskContour : public ::testing::Test {
 protected:
  using LevelAt = std::function<int(int, int)>;

  MaskContour() {
    show([](int, int) { return kWall; });
    background::prepare(kSize, 3, model_);
    background::fillFrom(smooth_, Executor(1), model_);
    model_.noise.fill(0);
    draw(mask_, kPart);
  }
  void show(const LevelAt& levelAt) {
    picture_ = makePicture(kSize, [&](int x, int y) {
      const auto level = static_cast<uint8_t>(levelAt(x, y));
      return Rgb{level, level, level};
    });
    background::smooth(*picture_, Executor(1), smooth_);
  }
  static void draw(BitMask& mask, const Box& box) {
    mask.resize(kSize);
    mask.clear();
    for (int y = box.y; y < box.bottom(); ++y) setColumns(mask.row(y), box.x, box.right(), true);
  }
  void grow(const Box& faint) {
    BitMask bits;
    draw(bits, faint);
    background::growFaint({smooth_, model_, bits, shown_}, Executor(2), cleaning_, scratch_, mask_);
  }
  void trim(BorderLayer layer = BorderLayer::DrawnIn) {
    background::paintModel(model_, Executor(2), shown_);
    background::trimBorder({*picture_, smooth_, model_, shown_, {10, 0}}, layer, Executor(2),
                           scratch_, mask_);
  }

  std::shared_ptr<const Picture> picture_;
  background::SmoothPicture smooth_;
  background::ConsensusBackground model_;
  std::array<Image<uint8_t>, 3> shown_;
  BitMask mask_;
  background::CleaningScratch cleaning_;
  background::ContourScratch scratch_;
};

TEST_F(MaskContour, FaintPixelsBesideASurePartBelongToIt) {
  show([](int x, int) { return x >= 20 && x < 60 ? 112 : kWall; });
  grow({32, 8, 20, 12});
  EXPECT_TRUE(mask_.at(34, 13));
  EXPECT_TRUE(mask_.at(37, 13));
  EXPECT_FALSE(mask_.at(38, 13));  // The seventh pixel.
}

TEST_F(MaskContour, AWeakShadowDoesNot) {
  show([](int x, int) { return x >= 32 && x < 60 ? 90 : kWall; });
  grow({32, 8, 20, 12});
  EXPECT_FALSE(mask_.at(34, 13));
}

TEST_F(MaskContour, LonelyFaintPixelsDoNot) {
  show([](int x, int) { return x >= 20 && x < 60 ? 112 : kWall; });
  grow({34, 13, 2, 1});
  EXPECT_FALSE(mask_.at(34, 13));
}

TEST_F(MaskContour, ABorderPixelThatLooksLikeOutsideGoes) {
  // The thing ends one column before the mask does on the right, with it on the left.
  show([](int x, int y) {
    return Box{20, 8, 11, 12}.contains({x, y}) ? 220 : x == 31 && y >= 8 && y < 20 ? 130 : kWall;
  });
  trim();
  EXPECT_FALSE(mask_.at(31, 13));
  EXPECT_TRUE(mask_.at(30, 13));
  EXPECT_TRUE(mask_.at(20, 13));
}

TEST_F(MaskContour, ABorderPixelThatOnlyLooksLikeWhatStandsBesideItStays) {
  // What stands beside it, outside of the mask, is not what is behind it.
  show([](int x, int y) {
    return Box{20, 8, 11, 12}.contains({x, y}) ? 130 : x > 30 ? 200 : kWall;
  });
  trim();
  EXPECT_TRUE(mask_.at(31, 13));
}

TEST_F(MaskContour, ASlopeFromTheBackgroundGoesUpToItsMiddle) {
  // The slope ends where the mask does, and its middle is at 29.
  show([](int x, int y) {
    return kPart.contains({x, y}) ? std::min(250, kWall + 25 * (32 - x)) : kWall;
  });
  trim(BorderLayer::Blurred);
  trim(BorderLayer::Blurred);
  EXPECT_FALSE(mask_.at(31, 13));
  EXPECT_FALSE(mask_.at(30, 13));
  trim(BorderLayer::Blurred);
  EXPECT_TRUE(mask_.at(29, 13));
}

TEST_F(MaskContour, NoSlopeNothingGoes) {
  show([](int x, int y) {
    return Box{20, 8, 11, 12}.contains({x, y}) ? 220 : x == 31 && y >= 8 && y < 20 ? 130 : kWall;
  });
  trim(BorderLayer::Blurred);
  EXPECT_TRUE(mask_.at(31, 13));
}

TEST_F(MaskContour, AWeakBorderStays) {
  // Within one and a half radii nothing says which side a pixel belongs to.
  show([](int x, int y) { return Box{20, 8, 11, 12}.contains({x, y}) ? 114 : kWall; });
  trim();
  EXPECT_TRUE(mask_.at(31, 13));
}

TEST_F(MaskContour, ThinPartsStay) {
  draw(mask_, {20, 8, 4, 4});
  show([](int x, int y) { return Box{21, 9, 2, 2}.contains({x, y}) ? 220 : kWall; });
  trim();
  EXPECT_EQ(countSet(mask_), 16u);
}

TEST_F(MaskContour, TheSmallestMasksWork) {
  for (const Size size : {Size{1, 1}, Size{1, 9}, Size{130, 1}}) {
    const auto picture = makePicture(size, [](int x, int) {
      return Rgb{static_cast<uint8_t>(x % 2 * 200), 0, 0};
    });
    background::smooth(*picture, Executor(1), smooth_);
    background::prepare(size, 3, model_);
    background::fillFrom(smooth_, Executor(1), model_);
    BitMask mask(size);
    mask.clear();
    for (int y = 0; y < size.height; ++y) setColumns(mask.row(y), 0, size.width, true);
    background::growFaint({smooth_, model_, mask, shown_}, Executor(1), cleaning_, scratch_, mask);
    background::paintModel(model_, Executor(1), shown_);
    for (const BorderLayer layer : {BorderLayer::DrawnIn, BorderLayer::Blurred})
      background::trimBorder({*picture, smooth_, model_, shown_, {10, 0}}, layer, Executor(1),
                             scratch_, mask);
    EXPECT_EQ(countSet(mask), static_cast<uint32_t>(size.area()));
  }
}

}  // namespace
}  // namespace rg
